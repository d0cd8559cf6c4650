#pragma once
// The devices of this machine, whatever bus they are on: what is here, and how each is opened by its driver's
// name.

#include <string>
#include <string_view>
#include <vector>

#include "devices/device_info.h"
#include "devices/device_spec.h"

namespace dubsar {

/// The way to a real device (a DeviceOpener): HID for spacemouse, rift and xreal, USB for leap, sockets for
/// the others. A remote address without allow_remote is kUsage here already.
Result<OpenTransport> reach_real_device(const DeviceSpec& choice, const Clock& clock);

/// All devices here that a driver knows, with the reason for those that cannot be used: HID, USB, cameras, and
/// spacenavd at `spacenav_socket` (empty: the usual path). Opens none; takes some milliseconds. Any thread.
std::vector<DeviceInfo> list_real_devices(const std::string& spacenav_socket = {});

/// Drivers that reach_real_device() knows, for error texts and help: "spacemouse, spacenav, ...".
inline constexpr std::string_view kDeviceDrivers = "spacemouse, spacenav, opentrack, vrpn, rift, xreal, leap";

}  // namespace dubsar
