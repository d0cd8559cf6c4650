#include "display/panels/edid.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>

namespace dubsar {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBlockBytes = 128, kMaxEdidBytes = 256 * kBlockBytes;
constexpr std::array<std::uint8_t, 8> kHeader{0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00};
constexpr std::array<std::size_t, 4> kDescriptors{54, 72, 90, 108};
constexpr std::uint8_t kSerialDescriptor = 0xFF, kNameDescriptor = 0xFC;

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
  return std::to_integer<std::uint8_t>(bytes[i]);
}

/// Thirteen characters, ended by a line feed, filled up with spaces.
std::string descriptor_text(std::span<const std::byte> bytes, std::size_t at) {
  std::string text;
  for (std::size_t i = at + 5; i < at + 18 && byte_at(bytes, i) != '\n'; ++i) {
    const char c = static_cast<char>(byte_at(bytes, i));
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

void read_timing(std::span<const std::byte> bytes, std::size_t at, Edid& edid) {
  const auto twelve_bits = [&](std::size_t low, std::size_t high, int shift) {
    return byte_at(bytes, at + low) | (byte_at(bytes, at + high) >> shift & 0x0F) << 8;
  };
  edid.width_px = twelve_bits(2, 4, 4);
  edid.height_px = twelve_bits(5, 7, 4);
  if (const int width = twelve_bits(12, 14, 4), height = twelve_bits(13, 14, 0); width > 0 && height > 0) {
    edid.width_mm = width;
    edid.height_mm = height;
  }
}

/// "HDMI-1" and "HDMI-A-1" are one; cards of the same kind of connector are told apart by number.
std::string plain_connector(std::string_view name) {
  std::string out(name);
  if (const std::size_t at = out.find("HDMI-A-"); at == 0) out.erase(4, 2);
  return out;
}

bool sizes_fit(const Monitor& monitor, const Edid& edid) {
  const auto same = [](int a, int b, int c, int d) {
    return (a == c && b == d) || (a == d && b == c);
  };  // may be turned
  return same(monitor.width_px, monitor.height_px, edid.width_px, edid.height_px);
}

}  // namespace

Result<Edid> parse_edid(std::span<const std::byte> bytes) {
  if (bytes.size() < kBlockBytes)
    return fail(ErrorKind::kBadData, "edid: {} bytes found, expected at least {}", bytes.size(), kBlockBytes);
  for (std::size_t i = 0; i < kHeader.size(); ++i)
    if (byte_at(bytes, i) != kHeader[i])
      return fail(ErrorKind::kBadData, "edid: the bytes do not start with the EDID header");
  unsigned sum = 0;
  for (std::size_t i = 0; i < kBlockBytes; ++i) sum += byte_at(bytes, i);
  if (sum % 256 != 0) return fail(ErrorKind::kBadData, "edid: the checksum is {} off, expected 0", sum % 256);
  Edid edid;
  const unsigned maker = 256u * byte_at(bytes, 8) + byte_at(bytes, 9);
  for (const int shift : {10, 5, 0}) {
    const unsigned letter = maker >> shift & 31u;
    if (letter < 1 || letter > 26)
      return fail(ErrorKind::kBadData, "edid: the manufacturer 0x{:04x} is not three letters", maker);
    edid.manufacturer += static_cast<char>('A' + letter - 1);
  }
  edid.product = static_cast<std::uint16_t>(byte_at(bytes, 10) | byte_at(bytes, 11) << 8);
  for (std::size_t i = 4; i-- > 0;) edid.serial_number = edid.serial_number << 8 | byte_at(bytes, 12 + i);
  edid.year = 1990 + byte_at(bytes, 17);
  edid.width_mm = 10 * byte_at(bytes, 21);
  edid.height_mm = 10 * byte_at(bytes, 22);
  if (edid.width_mm == 0 || edid.height_mm == 0) edid.width_mm = edid.height_mm = 0;  // one alone is an aspect ratio
  for (const std::size_t at : kDescriptors) {
    const bool is_timing = byte_at(bytes, at) != 0 || byte_at(bytes, at + 1) != 0;
    if (is_timing && edid.width_px == 0) read_timing(bytes, at, edid);
    if (is_timing) continue;
    if (byte_at(bytes, at + 3) == kNameDescriptor) edid.name = descriptor_text(bytes, at);
    if (byte_at(bytes, at + 3) == kSerialDescriptor) edid.serial = descriptor_text(bytes, at);
  }
  return edid;
}

std::vector<ConnectedEdid> read_connected_edids(const fs::path& folder) {
  std::vector<fs::path> connectors;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("card") && name.find('-') != std::string::npos) connectors.push_back(entry.path());
  }
  std::sort(connectors.begin(), connectors.end());
  std::vector<ConnectedEdid> found;
  for (const fs::path& path : connectors) {
    std::ifstream file(path / "edid", std::ios::binary);
    std::string bytes(kMaxEdidBytes, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    if (bytes.empty()) continue;  // nothing is connected
    const std::string name = path.filename().string();
    found.push_back(
        {name.substr(name.find('-') + 1), parse_edid(std::as_bytes(std::span(bytes.data(), bytes.size())))});
  }
  return found;
}

const Edid* edid_of(const Monitor& monitor, std::span<const ConnectedEdid> connected) {
  const Edid *by_size = nullptr, *by_name = nullptr;
  int fitting = 0;
  for (const ConnectedEdid& each : connected) {
    if (!each.edid) continue;
    const bool fits = sizes_fit(monitor, *each.edid),
               named = plain_connector(each.connector) == plain_connector(monitor.name);
    if (fits && named) return &*each.edid;
    if (fits) by_size = &*each.edid, ++fitting;
    if (named) by_name = &*each.edid;
  }
  return fitting == 1 ? by_size : fitting == 0 ? by_name : nullptr;
}

}  // namespace dubsar
