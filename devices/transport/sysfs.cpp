#include "devices/transport/sysfs.h"

#include <algorithm>
#include <charconv>
#include <fstream>

namespace dubsar {

std::string sysfs_bytes(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = 8192;  // two pages; a report descriptor has at most 4096
  std::ifstream stream(file, std::ios::binary);
  std::string out(kMostBytes, '\0');
  stream.read(out.data(), static_cast<std::streamsize>(out.size()));
  out.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return out;
}

std::string printable_line(std::string_view text) {
  constexpr std::size_t kLongestLine = 256;
  std::string out(text.substr(0, std::min(text.find_first_of(std::string_view("\n\0", 2)), kLongestLine)));
  std::replace_if(
      out.begin(), out.end(), [](char letter) { return letter < 32 || letter >= 127; }, '?');
  return out;
}

std::string sysfs_line(const std::filesystem::path& file) { return printable_line(sysfs_bytes(file)); }

std::optional<std::uint32_t> hex_number(std::string_view digits) {
  std::uint32_t value = 0;
  const char* const end = digits.data() + digits.size();
  if (const auto read = std::from_chars(digits.data(), end, value, 16); read.ec != std::errc() || read.ptr != end)
    return std::nullopt;
  return value;
}

}  // namespace dubsar
