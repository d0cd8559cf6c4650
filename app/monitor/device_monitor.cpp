#include "app/monitor/device_monitor.h"

#include <chrono>
#include <thread>

#include "devices/head_tracker/head_tracker.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "input/input_source.h"

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
  return out;
}

template <class Protocol>
class LiveDriver final : public DeviceMonitor {
 public:
  LiveDriver(OpenTransport open, const Clock& clock) : driver_(std::move(open), Protocol(), &clock) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto sample = driver_.poll(now, timeout);
    if (!sample) return std::nullopt;
    newest_ = sample->time;
    return to_json(*sample);
  }
  bool connected() const override { return driver_.connected(); }
  std::string reason() const override { return driver_.reason(); }
  std::string note() const override { return driver_.note(); }
  DriverCounts counts() const override { return driver_.counts(); }
  TimestampNs newest() const override { return newest_; }

 private:
  Driver<Protocol> driver_;
  TimestampNs newest_ = 0;
};

class LiveHeadTracker final : public DeviceMonitor {
 public:
  explicit LiveHeadTracker(std::unique_ptr<HeadTracker> tracker) : tracker_(std::move(tracker)) {}
  std::optional<json> poll(TimestampNs now, milliseconds timeout) override {
    const auto sample = tracker_->poll(now, timeout);
    if (!sample) return std::nullopt;
    newest_ = sample->time;
    return to_json(*sample);
  }
  bool connected() const override { return tracker_->connected(); }
  std::string reason() const override { return tracker_->reason(); }
  std::string note() const override { return tracker_->note(); }
  DriverCounts counts() const override { return tracker_->counts(); }
  TimestampNs newest() const override { return newest_; }

 private:
  std::unique_ptr<HeadTracker> tracker_;
  TimestampNs newest_ = 0;
};

/// Hands in the device's own frame.
class LiveHands final : public DeviceMonitor {
 public:
  LiveHands(std::unique_ptr<InputSource> source, bool threaded) : source_(std::move(source)), threaded_(threaded) {}
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

Result<std::unique_ptr<DeviceMonitor>> make_live_device(const DeviceSpec& choice, OpenTransport open,
                                                        const Clock& clock, bool threaded) {
  if (choice.driver == "spacemouse") return std::make_unique<LiveDriver<SpaceMouseProtocol>>(std::move(open), clock);
  if (choice.driver == "spacenav") return std::make_unique<LiveDriver<SpacenavProtocol>>(std::move(open), clock);
  if (choice.driver == "leap") {
    InputConfig config;
    config.clock = &clock;
    config.simulated_time = !threaded;
    config.reach_device = [open = std::move(open)](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
      return open;
    };
    DUBSAR_ASSIGN(auto source, make_input("leap:at=0/0/0", config));
    return std::make_unique<LiveHands>(std::move(source), threaded);
  }
  if (choice.driver == "leapc") {
    InputConfig config;
    config.clock = &clock;
    if (!choice.library.empty()) config.options.emplace_back("library", choice.library);
    DUBSAR_ASSIGN(auto source, make_input("leapc:at=0/0/0", config));
    return std::make_unique<LiveHands>(std::move(source), true);
  }
  DUBSAR_ASSIGN(const auto* const backend, find_backend(head_tracker_backends(), choice.driver, "device driver"));
  HeadTrackerConfig config;
  config.open = std::move(open);
  config.sender = choice.sender;
  config.tracker = choice.tracker;
  config.sensor = choice.sensor;
  config.invert = choice.invert;
  config.stamps = &clock;
  DUBSAR_ASSIGN(auto tracker, backend->create(config));
  return std::make_unique<LiveHeadTracker>(std::move(tracker));
}

}  // namespace dubsar::app
