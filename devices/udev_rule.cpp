#include "devices/udev_rule.h"

#include <fmt/format.h>

namespace dubsar {

std::string udev_rule(std::string_view subsystem, std::uint16_t vendor_id, std::uint16_t product_id) {
  return fmt::format(R"(SUBSYSTEM=="{}", ATTRS{{idVendor}}=="{:04x}", ATTRS{{idProduct}}=="{:04x}", TAG+="uaccess")",
                     subsystem, vendor_id, product_id);
}

}  // namespace dubsar
