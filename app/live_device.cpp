#include "app/live_device.h"

#include "devices/head_tracker/head_tracker.h"
#include "devices/spacemouse/spacenav_protocol.h"

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

template <class Protocol>
class LiveDriver final : public LiveDevice {
 public:
  LiveDriver(OpenTransport open, Protocol protocol) : driver_(std::move(open), std::move(protocol)) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto sample = driver_.poll(now, timeout);
    if (!sample) return std::nullopt;
    return to_json(*sample);
  }
  bool connected() const override { return driver_.connected(); }
  const std::string& reason() const override { return driver_.reason(); }
  const DriverCounts& counts() const override { return driver_.counts(); }

 private:
  Driver<Protocol> driver_;
};

class LiveHeadTracker final : public LiveDevice {
 public:
  explicit LiveHeadTracker(std::unique_ptr<HeadTracker> tracker) : tracker_(std::move(tracker)) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto sample = tracker_->poll(now, timeout);
    if (!sample) return std::nullopt;
    return to_json(*sample);
  }
  bool connected() const override { return tracker_->connected(); }
  const std::string& reason() const override { return tracker_->reason(); }
  const DriverCounts& counts() const override { return tracker_->counts(); }

 private:
  std::unique_ptr<HeadTracker> tracker_;
};

}  // namespace

Result<std::unique_ptr<LiveDevice>> make_live_device(const DeviceChoice& choice, OpenTransport open) {
  if (choice.driver == "spacemouse")
    return std::make_unique<LiveDriver<SpaceMouseProtocol>>(std::move(open), SpaceMouseProtocol());
  if (choice.driver == "spacenav")
    return std::make_unique<LiveDriver<SpacenavProtocol>>(std::move(open), SpacenavProtocol());
  DUBSAR_ASSIGN(const auto* const backend, find_backend(head_tracker_backends(), choice.driver, "device driver"));
  HeadTrackerConfig config;
  config.open = std::move(open);
  config.tracker = choice.tracker;
  config.sensor = choice.sensor;
  config.invert = choice.invert;
  DUBSAR_ASSIGN(auto tracker, backend->create(config));
  return std::make_unique<LiveHeadTracker>(std::move(tracker));
}

}  // namespace dubsar::app
