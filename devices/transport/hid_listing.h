#pragma once
// HID devices as the kernel tells of them in /sys/class/hidraw. Nothing is opened: no permission is needed, and a
// device that vanishes while it is read is left out (hidapi 0.13.1 ends the program there).

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dubsar {

/// One HID interface.
struct HidNode {
  std::string path;  ///< "/dev/hidraw3"
  std::uint16_t vendor_id = 0, product_id = 0;
  std::uint16_t usage_page = 0, usage = 0;    ///< of the first collection; 0 where the kernel does not tell
  int interface_number = -1;                  ///< of USB; -1 on other buses
  std::string manufacturer, product, serial;  ///< printable ASCII, at most 256 characters
  bool operator==(const HidNode&) const = default;
};

/// What a device is for.
struct HidUsage {
  std::uint16_t page = 0, usage = 0;
  bool operator==(const HidUsage&) const = default;
};

/// Usage of the first collection of a report descriptor (Device Class Definition for HID 1.11, section 6.2.2); zeros
/// for bytes that end before one begins.
HidUsage first_usage(std::span<const std::byte> descriptor);

/// All HID interfaces of this machine, ordered by path. Takes a millisecond. Any thread. `folder`: for tests.
std::vector<HidNode> list_hid_nodes(const std::filesystem::path& folder = "/sys/class/hidraw");

}  // namespace dubsar
