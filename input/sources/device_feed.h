#pragma once
// How a source gets its device: the real one, or by an option of the source a recording or a simulation of
// one.

#include <atomic>
#include <functional>
#include <memory>

#include "devices/drivers.h"
#include "input/input_source.h"

namespace dubsar {

struct DeviceFeed {
  OpenTransport open;
  std::shared_ptr<const std::atomic<bool>> ended{};  ///< a recording or script is over; null: never
  std::function<void()> before_poll{};               ///< as of ThreadedSourceTraits
};

/// Takes the driver's options for the way to it, and replay=FILE and speed=FACTOR (recordings of `dubsar devices
/// record`), simulate=SCRIPT and seed=N (a scripted person before a simulated device that stands at
/// `screen_from_device`); without these the device that config.reach_device reaches. kUsage, kNoInput, kConfig,
/// kBadData: also a recording of another driver.
Result<DeviceFeed> make_device_feed(const DriverEntry& driver, OptionReader& options, const InputConfig& config,
                                    const Pose& screen_from_device);

/// A recording behind an opener; it may be opened again after each loss that it holds.
Result<DeviceFeed> replayed_device(std::string_view driver, const std::string& file, double speed, const Clock& clock);

}  // namespace dubsar
