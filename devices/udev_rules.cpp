#include "devices/udev_rules.h"

#include <fmt/format.h>

#include <map>

#include "devices/udev_rule.h"

namespace dubsar {

std::string udev_rules(DriverTable drivers) {
  std::string text =
      "# Lets the person who sits at the machine open the devices that dubsar knows.\n"
      "# Install: copy to /etc/udev/rules.d (packages: /usr/lib/udev/rules.d), udevadm control --reload, plug in "
      "again.\n";
  for (const DriverEntry& driver : drivers) {
    if (driver.bus == Bus::kInput) text += fmt::format("\n# {}\n{}\n", driver.summary, kTouchRule);
    if (driver.bus != Bus::kHid && driver.bus != Bus::kUsb) continue;
    std::map<std::uint16_t, std::string> products;
    for (const DeviceId& id : driver.ids) {
      if (!id.ignored.empty()) continue;
      std::string& list = products[id.vendor];
      if (id.product != 0) list += fmt::format("{}{:04x}", list.empty() ? "" : "|", id.product);
    }
    if (!products.empty()) text += fmt::format("\n# {}\n", driver.summary);
    const std::string_view subsystem = driver.bus == Bus::kHid ? "hidraw" : "usb";
    for (const auto& [vendor, list] : products) {
      const std::string product = list.empty() ? "" : fmt::format(" ATTRS{{idProduct}}==\"{}\",", list);
      text += fmt::format("SUBSYSTEM==\"{}\", ATTRS{{idVendor}}==\"{:04x}\",{} TAG+=\"uaccess\"\n", subsystem, vendor,
                          product);
    }
    if (driver.bluetooth_vendor != 0)
      text +=
          fmt::format("SUBSYSTEM==\"hidraw\", KERNELS==\"0005:{:04X}:*\", TAG+=\"uaccess\"\n", driver.bluetooth_vendor);
  }
  return text;
}

}  // namespace dubsar
