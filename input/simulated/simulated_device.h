#pragma once
// A scripted person before a simulated device: what the device's driver gets is bytes, below the transport
// seam. Named or never taken.

#include <atomic>
#include <memory>
#include <string_view>

#include "core/base/pose.h"
#include "devices/transport/transport.h"
#include "input/navigation/seen_view.h"
#include "input/simulated/script.h"

namespace dubsar {

struct WireOptions {
  Script script{};
  Pose screen_from_device{};               ///< leap, opentrack and vrpn: where the device stands
  std::shared_ptr<const SeenView> seen{};  ///< a visitor of the script needs it
};

/// What each wire carries: spacemouse and spacenav the deflection of a cap that the first hand holds (while
/// it grabs: 50 mm from where it took hold are full deflection; a visitor steers until the view stands as
/// wished); opentrack and vrpn the first head, not when an eye is lost; rift and xreal its looking at the
/// panel's centre; leap pictures of all hands, bystanders' too. The script's latency is that of the device,
/// except for leap, which has its own.
class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  /// Lets the person act up to `now` (from the first call on) and the device say what it has to say by then.
  virtual void advance(TimestampNs now) = 0;
  /// The host's end of the device. What is said while it is closed is lost.
  virtual Result<std::unique_ptr<Transport>> open() = 0;
  bool finished() const noexcept { return *ended_; }
  std::shared_ptr<const std::atomic<bool>> ended() const noexcept { return ended_; }

 protected:
  void end() noexcept { *ended_ = true; }

 private:
  std::shared_ptr<std::atomic<bool>> ended_ = std::make_shared<std::atomic<bool>>(false);
};

/// spacemouse, spacenav, opentrack, vrpn, rift, xreal, leap. kUsage: another driver, a visitor who sees
/// nothing, a device for heads and a script without one, and the like. `clock` outlives it and may be read in
/// any thread.
Result<std::unique_ptr<SimulatedDevice>> make_wire_person(std::string_view driver, WireOptions options,
                                                          const Clock& clock);

/// The simulated device as a way to open it: reading lets the person act up to the clock's time.
OpenTransport reach_wire_person(std::shared_ptr<SimulatedDevice> person, const Clock& clock);

/// A person for tries without a script: looks about, takes hold and turns. Other seeds, other people.
Script somebody(std::uint64_t seed, double seconds);

}  // namespace dubsar
