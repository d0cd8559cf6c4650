#pragma once
// A script as a person before a simulated device (devices/simulated_device.h).

#include <memory>

#include "devices/drivers.h"
#include "input/navigation/seen_view.h"
#include "input/simulated/script.h"

namespace dubsar {

struct PersonOptions {
  Script script{};
  Pose screen_from_device{};               ///< where the device stands
  std::shared_ptr<const SeenView> seen{};  ///< a visitor of the script needs it
};

/// A SpaceMouse is held by the first hand: while it grabs, 50 mm from where it took hold are full deflection; a visitor
/// steers until the view stands as wished. The script's latency is that of the device, except for pictures, which have
/// their own way to go. kUsage: a visitor who sees nothing, a device for heads and a script without one, and the like.
Result<std::shared_ptr<SimulatedPerson>> make_scripted_person(const DriverEntry& driver, PersonOptions options);

/// A person for tries without a script: looks about, takes hold and turns. Other seeds, other people.
Script somebody(std::uint64_t seed, double seconds);

}  // namespace dubsar
