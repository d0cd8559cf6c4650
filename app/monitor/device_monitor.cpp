#include "app/monitor/device_monitor.h"

#include <chrono>
#include <thread>

#include "devices/drivers.h"
#include "input/input_source.h"
#include "input/source_spec.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json to_json(const SpaceMouseSample& sample) {
  return {{"time_s", 1e-9 * static_cast<double>(sample.time)},
          {"translation", numbers(sample.translation)},
          {"rotation", numbers(sample.rotation)},
          {"buttons", sample.buttons}};
}

json to_json(const HeadSample& sample) {
  json out = {{"time_s", 1e-9 * static_cast<double>(sample.time)}};
  if (sample.has_position) out["position_m"] = numbers(sample.pose.position_m);
  const glm::dquat& q = sample.pose.rotation;
  if (sample.has_orientation) out["rotation_wxyz"] = {q.w, q.x, q.y, q.z};
  return out;
}

json to_json(const StereoSample& sample) { return {{"time_s", 1e-9 * static_cast<double>(sample.time)}}; }

json to_json(const TouchSample& sample) {
  json out = {{"time_s", 1e-9 * static_cast<double>(sample.time)}, {"touches", json::array()}};
  for (const TouchContact& contact : sample.frames.back().contacts)
    out["touches"].push_back({{"id", contact.id}, {"at", {contact.at.x, contact.at.y}}});
  return out;
}

json to_json(const InputFrame& frame) {
  json out = {{"time_s", 1e-9 * static_cast<double>(frame.time)}, {"hands", json::array()}};
  for (const HandFrame& hand : frame.hands)
    out["hands"].push_back({{"id", hand.id},
                            {"side", hand.chirality == Chirality::kLeft    ? "left"
                                     : hand.chirality == Chirality::kRight ? "right"
                                                                           : "unknown"},
                            {"palm_m", numbers(hand.palm.position_m)},
                            {"grab", hand.grab_strength},
                            {"pinch_m", hand.pinch_distance_m},
                            {"confidence", hand.confidence}});
  for (const HeadFrame& head : frame.heads) {
    json one = {{"id", head.id}, {"confidence", head.confidence}};
    if (head.left_eye_m) one["left_eye_m"] = numbers(*head.left_eye_m);
    if (head.right_eye_m) one["right_eye_m"] = numbers(*head.right_eye_m);
    out["heads"].push_back(std::move(one));
  }
  if (frame.space_mouse)
    out["puck"] = {{"push", numbers(frame.space_mouse->push)}, {"twist", numbers(frame.space_mouse->twist)}};
  for (const InputEvent& event : frame.events)
    if (event.kind == EventKind::kKey) out["keys"].push_back({{"key", event.key}, {"down", event.down}});
  return out;
}

class DriverMonitor final : public DeviceMonitor {
 public:
  explicit DriverMonitor(std::unique_ptr<DeviceDriver> driver) : driver_(std::move(driver)) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto sample = driver_->next(now, timeout);
    if (!sample) return std::nullopt;
    newest_ = time_of(*sample);
    return std::visit([](const auto& s) { return to_json(s); }, *sample);
  }
  bool connected() const override { return driver_->connected(); }
  std::string reason() const override { return driver_->reason(); }
  std::string note() const override { return driver_->note(); }
  DriverCounts counts() const override { return driver_->counts(); }
  TimestampNs newest() const override { return newest_; }

 private:
  std::unique_ptr<DeviceDriver> driver_;
  TimestampNs newest_ = 0;
};

/// Hands in the device's own frame.
class HandsMonitor final : public DeviceMonitor {
 public:
  HandsMonitor(std::unique_ptr<InputSource> source, bool threaded) : source_(std::move(source)), threaded_(threaded) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto until = std::chrono::steady_clock::now() + timeout;
    for (;;) {
      freshness_ = source_->poll(now, frame_);
      if (freshness_ == Freshness::kNew) {
        ++counts_.accepted;
        return to_json(frame_);
      }
      if (std::chrono::steady_clock::now() >= until) return std::nullopt;
      std::this_thread::sleep_for(milliseconds(1));
      if (!threaded_) return std::nullopt;
    }
  }
  bool connected() const override { return freshness_ != Freshness::kLost; }
  std::string reason() const override { return connected() ? std::string() : source_->note(); }
  std::string note() const override { return connected() ? source_->note() : std::string(); }
  DriverCounts counts() const override { return counts_; }
  TimestampNs newest() const override { return frame_.time; }

 private:
  std::unique_ptr<InputSource> source_;
  const bool threaded_;
  Freshness freshness_ = Freshness::kLost;
  InputFrame frame_;
  DriverCounts counts_;
};

}  // namespace

Result<std::unique_ptr<DeviceMonitor>> monitor_device(const DeviceSpec& spec, OpenTransport open, const Clock& clock,
                                                      bool threaded) {
  if (is_plugin(spec.driver)) {
    InputConfig config;
    config.clock = &clock;
    DUBSAR_ASSIGN(auto made, make_input(spec.driver, config));
    return std::make_unique<HandsMonitor>(std::move(made), threaded);
  }
  DUBSAR_ASSIGN(const DriverEntry* driver, find_driver(spec.driver, "devices", driver_table()));
  if (driver->gives != Gives::kStereoPictures && driver->gives != Gives::kHands) {
    DUBSAR_ASSIGN(auto made, drive_device(spec, std::move(open), clock));
    return std::make_unique<DriverMonitor>(std::move(made));
  }
  InputConfig config;  // hands are what people want to see of pictures
  config.clock = &clock;
  config.simulated_time = !threaded;
  if (open) {
    config.reach_device = [open = std::move(open)](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
      return open;
    };
  }
  SourceSpec source{std::string(driver->input.source), spec.options};
  source.options.push_back({"at", "0/0/0"});
  DUBSAR_ASSIGN(auto made, make_input(source.text(), config));
  return std::make_unique<HandsMonitor>(std::move(made), threaded);
}

}  // namespace dubsar::app
