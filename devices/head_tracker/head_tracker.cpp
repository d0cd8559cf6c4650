#include "devices/head_tracker/head_tracker.h"

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/head_tracker/xreal_protocol.h"

namespace dubsar {
namespace {

template <class Protocol>
class DrivenTracker final : public HeadTracker {
 public:
  DrivenTracker(OpenTransport open, Protocol protocol, const Clock* stamps)
      : driver_(std::move(open), std::move(protocol), stamps) {}
  std::optional<HeadSample> poll(TimestampNs now, milliseconds timeout) override { return driver_.poll(now, timeout); }
  bool connected() const noexcept override { return driver_.connected(); }
  const std::string& reason() const noexcept override { return driver_.reason(); }
  std::string note() const override { return driver_.note(); }
  const DriverCounts& counts() const noexcept override { return driver_.counts(); }
  void wake() noexcept override { driver_.wake(); }
  void recentre() noexcept override {
    if constexpr (requires(Protocol p) { p.recentre(); }) driver_.protocol().recentre();
  }

 private:
  Driver<Protocol> driver_;
};

template <class Protocol>
Result<std::unique_ptr<HeadTracker>> make(const HeadTrackerConfig& config, Protocol protocol) {
  if (!config.open) return fail(ErrorKind::kUsage, "head tracker: no device to open was given");
  return std::make_unique<DrivenTracker<Protocol>>(config.open, std::move(protocol), config.stamps);
}

constexpr HeadTrackerBackend kBackends[] = {
    {"opentrack", "opentrack, AITrack and others by UDP", false,
     [](const HeadTrackerConfig& config) -> Result<std::unique_ptr<HeadTracker>> {
       DUBSAR_ASSIGN(const auto sender, parse_opentrack_sender(config.sender));
       return make(config, OpentrackProtocol(config.invert, sender));
     }},
    {"vrpn", "a VRPN server by TCP", false,
     [](const HeadTrackerConfig& config) {
       return make(config, VrpnProtocol({config.tracker, config.sensor}));
     }},
    {"rift", "Oculus Rift DK1 and DK2, orientation only", true,
     [](const HeadTrackerConfig& config) { return make(config, RiftProtocol()); }},
    {"xreal", "XREAL Air glasses, orientation only", true,
     [](const HeadTrackerConfig& config) { return make(config, XrealProtocol()); }},
};

}  // namespace

std::span<const HeadTrackerBackend> head_tracker_backends() noexcept { return kBackends; }

}  // namespace dubsar
