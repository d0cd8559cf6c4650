#pragma once
// The one table of devices: a row says all that is known of a device, and what lists, opens, watches, records,
// simulates and documents devices reads it. A new device is its protocol, its simulator and one row (docs/devices.md).

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/numbers/pose.h"
#include "core/base/text/option_reader.h"
#include "devices/device_driver.h"
#include "devices/device_spec.h"
#include "devices/simulated_device.h"

namespace dubsar {

enum class Bus { kHid, kUsb, kInput, kVideo, kUnixSocket, kUdp, kTcp, kService };

/// What a device gives, and so which source reads it.
enum class Gives {
  kNothing,  ///< no input: calibrations
  kSpaceMouse,
  kHead,
  kStereoPictures,  ///< hands are found in them
  kPictures,        ///< faces are found in them
  kHands,
  kTouches,
};

/// One kind of device that a driver knows, by what USB says of it. The first of a row that fits counts.
struct DeviceId {
  std::uint16_t vendor = 0, product = 0;  ///< product 0: all of this vendor
  std::string_view name;
  int interface_number = -1;  ///< HID: this interface only; -1: any
  /// HID: only interfaces of this usage, where the kernel tells it (receivers have others).
  bool multi_axis_use = false;
  std::string_view product_name{};  ///< HID: only products whose own name begins so (shared numbers)
  std::string_view ignored{};       ///< why it is left alone; empty: it is used
  std::string_view instead{};       ///< what to do about one that is left alone
};

/// A device as a source of a session.
struct InputFacts {
  std::string_view source{};      ///< its word after --input; empty: none
  bool taken_unasked = false;     ///< a session without --input takes it where it can be used
  std::string_view instead_of{};  ///< this driver is not taken unasked beside it
  bool whole_screen = false;      ///< nobody else has it meanwhile: taken unasked only by who covers the screen
  std::string_view lacks{};       ///< a sentence on what its measurements lack
};

struct DriverEntry {
  std::string_view name;     ///< "spacemouse"
  std::string_view summary;  ///< for people: which devices these are
  Bus bus = Bus::kHid;
  std::span<const DeviceId> ids{};
  std::uint16_t bluetooth_vendor = 0;  ///< HID by Bluetooth, of a vendor who makes nothing else; 0: none
  Gives gives = Gives::kNothing;

  InputFacts input{};
  Pose usual_place{};      ///< of the device in the screen frame
  std::uint16_t port = 0;  ///< sockets: the protocol's own
  /// Simulated servers: the port in a datagram by which a client asks to be called back; null: none does.
  std::optional<std::uint16_t> (*calls)(std::span<const std::byte> datagram) = nullptr;

  /// How it is opened; takes its options. Opens nothing. Null: through its source only.
  Result<OpenTransport> (*open)(const DriverEntry& self, OptionReader& options, const Clock& clock) = nullptr;
  /// The protocol over any transport; takes its options. `stamps`: as of Driver.
  std::unique_ptr<DeviceDriver> (*drive)(OpenTransport open, OptionReader& options, const Clock* stamps) = nullptr;
  /// Null: cannot be simulated.
  std::unique_ptr<SimulatedDevice> (*simulate)(const Simulation& simulation) = nullptr;
  double longest_simulation_s = 3600.0;
};

using DriverTable = std::span<const DriverEntry>;

/// All drivers of this program.
DriverTable driver_table();

/// kUsage with the names there are; `whose` begins the sentence: "devices".
Result<const DriverEntry*> find_driver(std::string_view name, std::string_view whose, DriverTable drivers);

/// "spacemouse, spacenav, ...": those that pass.
std::string driver_names(DriverTable drivers, bool (*passes)(const DriverEntry&));
inline bool can_be_opened(const DriverEntry& driver) { return driver.open != nullptr && driver.drive != nullptr; }
inline bool can_be_simulated(const DriverEntry& driver) { return driver.simulate != nullptr; }

/// The way to the device of a spec. kUsage: no such driver, a wrong option for the way there, a remote address without
/// `remote`.
Result<OpenTransport> open_device(const DeviceSpec& spec, const Clock& clock, DriverTable drivers = driver_table());

/// The driver of a spec over any transport. kUsage: no such driver, an option that it does not have. `clock` stamps
/// what is read and outlives it.
Result<std::unique_ptr<DeviceDriver>> drive_device(const DeviceSpec& spec, OpenTransport open, const Clock& clock,
                                                   DriverTable drivers = driver_table());

}  // namespace dubsar
