#include "devices/device_spec.h"

#include <algorithm>

namespace dubsar {

Result<std::array<bool, 6>> parse_axes(std::string_view text) {
  static constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "yaw", "pitch", "roll"};
  std::array<bool, 6> out{};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find('+'));
    const auto found = std::find(kAxes.begin(), kAxes.end(), word);
    if (found == kAxes.end())
      return fail(ErrorKind::kUsage, "axes: \"{}\" found, expected x, y, z, yaw, pitch and roll joined by +", word);
    out[static_cast<std::size_t>(found - kAxes.begin())] = true;
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return out;
}

}  // namespace dubsar
