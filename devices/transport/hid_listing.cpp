#include "devices/transport/hid_listing.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "devices/transport/sysfs.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

// Items of a report descriptor, without the two bits that tell their length.
constexpr unsigned kUsagePage = 0x04, kUsage = 0x08, kCollection = 0xA0;
constexpr unsigned kLongItem = 0xFE;

/// "KEY=value" lines.
std::map<std::string, std::string, std::less<>> facts_of(std::string_view uevent) {
  std::map<std::string, std::string, std::less<>> out;
  while (!uevent.empty()) {
    const std::size_t end = std::min(uevent.find('\n'), uevent.size());
    const std::string_view line = uevent.substr(0, end);
    if (const std::size_t equals = line.find('='); equals != std::string_view::npos)
      out.emplace(line.substr(0, equals), line.substr(equals + 1));
    uevent.remove_prefix(std::min(end + 1, uevent.size()));
  }
  return out;
}

/// HID_ID=0003:0000256F:0000C635: bus, vendor and product.
bool read_id(std::string_view text, HidNode& node) {
  const std::size_t first = text.find(':'), second = text.rfind(':');
  if (first == std::string_view::npos || first == second) return false;
  const auto vendor = hex_number(text.substr(first + 1, second - first - 1)),
             product = hex_number(text.substr(second + 1));
  if (!vendor || !product) return false;
  node.vendor_id = static_cast<std::uint16_t>(*vendor);
  node.product_id = static_cast<std::uint16_t>(*product);
  return true;
}

/// Nothing where the device is gone, or is not yet told whole.
std::optional<HidNode> describe(const fs::path& folder) {
  HidNode node;
  node.path = "/dev/" + folder.filename().string();
  const fs::path device = folder / "device";
  const auto facts = facts_of(sysfs_bytes(device / "uevent"));
  const auto fact = [&](std::string_view key) {
    const auto found = facts.find(key);
    return found == facts.end() ? std::string() : printable_line(found->second);
  };
  if (!read_id(fact("HID_ID"), node)) return std::nullopt;
  const std::string descriptor = sysfs_bytes(device / "report_descriptor");
  const HidUsage usage = first_usage(std::as_bytes(std::span(descriptor)));
  node.usage_page = usage.page;
  node.usage = usage.usage;
  node.product = fact("HID_NAME");
  node.serial = fact("HID_UNIQ");
  // on USB the device hangs below its interface, and that below the plugged thing, which tells its names apart
  const fs::path interface = device / "..", plugged = interface / "..";
  if (const auto number = hex_number(sysfs_line(interface / "bInterfaceNumber"))) {
    node.interface_number = static_cast<int>(*number);
    node.manufacturer = sysfs_line(plugged / "manufacturer");
    if (std::string name = sysfs_line(plugged / "product"); !name.empty()) node.product = std::move(name);
    if (node.serial.empty()) node.serial = sysfs_line(plugged / "serial");
  }
  return node;
}

}  // namespace

HidUsage first_usage(std::span<const std::byte> descriptor) {
  HidUsage out;
  while (!descriptor.empty()) {
    const auto prefix = std::to_integer<unsigned>(descriptor[0]);
    if (prefix == kLongItem) {
      const std::size_t bytes = descriptor.size() < 2 ? 0 : 3 + std::to_integer<std::size_t>(descriptor[1]);
      if (bytes == 0 || bytes > descriptor.size()) return {};
      descriptor = descriptor.subspan(bytes);
      continue;
    }
    const unsigned item = prefix & ~3U;
    const std::size_t bytes = (prefix & 3U) == 3 ? 4 : prefix & 3U;
    if (item == kCollection) return out;
    if (bytes >= descriptor.size()) return {};
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i > 0; --i) value = value << 8 | std::to_integer<std::uint32_t>(descriptor[i]);
    if (item == kUsagePage) out.page = static_cast<std::uint16_t>(value);
    if (item == kUsage) {
      out.usage = static_cast<std::uint16_t>(value);
      if (bytes == 4) out.page = static_cast<std::uint16_t>(value >> 16);
    }
    descriptor = descriptor.subspan(1 + bytes);
  }
  return {};
}

std::vector<HidNode> list_hid_nodes(const fs::path& folder) {
  std::vector<HidNode> out;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (auto node = describe(entry->path())) out.push_back(std::move(*node));
  std::sort(out.begin(), out.end(), [](const HidNode& a, const HidNode& b) { return a.path < b.path; });
  return out;
}

}  // namespace dubsar
