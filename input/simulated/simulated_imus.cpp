// A person who wears glasses with inertial sensors and looks at the panel's centre.

#include <algorithm>
#include <cmath>

#include "devices/head_tracker/imu_sim.h"
#include "input/simulated/scripted_wire.h"

namespace dubsar {
namespace {

constexpr TimestampNs kSampleNs = 1'000'000, kMostBehindNs = 1'000'000'000;

/// Turns head axes so that -Z points from `at_m` to the panel's centre, without roll.
glm::dquat looking_at_centre(const glm::dvec3& at_m) {
  const double yaw = std::atan2(at_m.x, at_m.z), pitch = -std::atan2(at_m.y, std::hypot(at_m.x, at_m.z));
  return glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
}

/// `Sim` takes turn rates; `kSamples` readings make one report.
template <class Sim, int kSamples>
class ImuWire final : public SimulatedDevice {
 public:
  template <class... Args>
  explicit ImuWire(WireOptions options, Args... args) : script_(std::move(options.script)), sim_(args...) {}
  Result<std::unique_ptr<Transport>> open() override { return sim_.device().open(); }

  void advance(TimestampNs now) override {
    if (!start_) {
      start_ = next_ = now;
      last_ = turn_at(0.0);
    }
    next_ = std::max(next_, now - kMostBehindNs);
    for (; next_ <= now; next_ += kSamples * kSampleNs) {
      const double t_s = 1e-9 * static_cast<double>(next_ - *start_) - script_.latency_s;
      const glm::dquat turn = turn_at(std::max(t_s, 0.0));
      const glm::dvec3 rate = vector_of(glm::conjugate(last_) * turn) / (1e-9 * kSamples * kSampleNs);
      last_ = turn;
      if constexpr (kSamples == 1)
        sim_.step(rate, 1e-9 * kSampleNs);
      else
        sim_.step(rate, kSamples);
      if (t_s >= script_.duration_s) end();
    }
  }

 private:
  glm::dquat turn_at(double t_s) {
    if (const auto at = sample_head(script_.heads.front(), t_s)) return looking_at_centre(*at);
    return last_;
  }
  Script script_;
  Sim sim_;
  std::optional<TimestampNs> start_;
  TimestampNs next_ = 0;
  glm::dquat last_{1, 0, 0, 0};
};

}  // namespace

std::unique_ptr<SimulatedDevice> make_rift_wire(WireOptions options) {
  return std::make_unique<ImuWire<RiftSim, 2>>(std::move(options), RiftModel::kDk1);
}
std::unique_ptr<SimulatedDevice> make_xreal_wire(WireOptions options) {
  return std::make_unique<ImuWire<XrealSim, 1>>(std::move(options));
}

}  // namespace dubsar
