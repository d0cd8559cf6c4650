#pragma once
// Permissions: the udev rule that lets the person at the machine open a device.

#include <cstdint>
#include <string>
#include <string_view>

namespace dubsar {

/// What to do when a device node may not be opened; the rule file is installed with the program.
inline constexpr std::string_view kUdevRemedy =
    "copy 70-dubsar.rules to /etc/udev/rules.d, run \"udevadm control --reload\" and plug the device in again";

/// The line for touch panels of any maker: udev has looked at what they can do (input_id).
inline constexpr std::string_view kTouchRule =
    R"(SUBSYSTEM=="input", KERNEL=="event*", ENV{ID_INPUT_TOUCHSCREEN}=="1", TAG+="uaccess")";

/// The line for one vendor, as it stands in 70-dubsar.rules. `subsystem`: "hidraw", "usb".
std::string udev_rule(std::string_view subsystem, std::uint16_t vendor_id, std::uint16_t product_id);

}  // namespace dubsar
