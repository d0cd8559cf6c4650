#include "devices/head_tracker/imu_sim.h"

#include <algorithm>

namespace dubsar {

ImuSample HeadMotion::turn(const glm::dvec3& rate_rad_s, double dt_s) noexcept {
  const double rate = glm::length(rate_rad_s);
  if (rate > 0.0) world_from_head_ = glm::normalize(world_from_head_ * glm::angleAxis(rate * dt_s, rate_rad_s / rate));
  return {glm::conjugate(world_from_head_) * glm::dvec3(0.0, 9.81, 0.0), rate_rad_s};
}

RiftSim::RiftSim(RiftModel model) : model_(model) {
  SimBehaviour behaviour;
  behaviour.on_set_feature = [power = power_](std::span<const std::byte> report) -> Result<void> {
    if (report.size() != 5 || report[0] != std::byte{8})
      return fail(ErrorKind::kIo, "simulated Rift: feature report of {} bytes refused", report.size());
    const int interval_ms = std::to_integer<int>(report[3]) | std::to_integer<int>(report[4]) << 8;
    power->asleep_at_ms = power->now_ms + interval_ms;
    return {};
  };
  device_.set_behaviour(std::move(behaviour));
}

bool RiftSim::silent() const noexcept { return power_->now_ms >= power_->asleep_at_ms; }

void RiftSim::step(const glm::dvec3& rate_rad_s, int count) {
  RiftReport report;
  report.model = model_;
  report.samples_since_last = count;
  const int held = std::min(count, model_ == RiftModel::kDk1 ? 3 : 2);
  for (int i = 0; i < count; ++i) {
    const ImuSample sample = motion_.turn(rate_rad_s, 1e-3);
    if (i >= count - held) report.samples[static_cast<std::size_t>(report.count++)] = sample;
  }
  power_->now_ms += count;
  report.ticks =
      static_cast<std::uint32_t>(model_ == RiftModel::kDk1 ? power_->now_ms & 0xFFFF : power_->now_ms * 1000);
  if (!silent()) device_.send(format_rift(report));
}

XrealSim::XrealSim() {
  SimBehaviour behaviour;
  behaviour.on_write = [streaming = streaming_,
                        device = device_.get()](std::span<const std::byte> report) -> Result<void> {
    const auto command = parse_xreal_command(report);
    if (!command) return fail(ErrorKind::kIo, "simulated XREAL: not a command");
    if (command->number == kXrealStream && command->data.size() == 1) *streaming = command->data[0] == std::byte{1};
    device->send(format_xreal_command({command->number, {std::byte{0}}}));
    return {};
  };
  device_->set_behaviour(std::move(behaviour));
}

void XrealSim::step(const glm::dvec3& rate_rad_s, double dt_s) {
  time_s_ += dt_s;
  const ImuSample sample = motion_.turn(rate_rad_s, dt_s);
  if (*streaming_) device_->send(format_xreal({static_cast<std::uint64_t>(time_s_ * 1e9 + 0.5), sample}));
}

}  // namespace dubsar
