#include "core/mesh_io/vertex_colors.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr float kNoShare = 16.0f;  // colours of 0 to 1 may be a little too bright, not so much

}  // namespace

std::vector<std::array<std::uint8_t, 3>> color_bytes(std::span<const glm::vec3> colors, bool integers) {
  float most = 0.0f;
  bool whole = true;
  for (const glm::vec3& color : colors)
    for (int c = 0; c < 3; ++c)
      if (std::isfinite(color[c])) most = std::max(most, color[c]), whole = whole && color[c] == std::round(color[c]);
  const bool bytes = most > kNoShare || (most > 1.0f && whole);
  const double scale = integers ? (most > 255.0f ? 1.0 / 257.0 : 1.0) : bytes ? 1.0 : 255.0;
  std::vector<std::array<std::uint8_t, 3>> out(colors.size());
  for (std::size_t v = 0; v < colors.size(); ++v)
    for (int c = 0; c < 3; ++c) {
      const double value = scale * static_cast<double>(colors[v][c]);
      out[v][static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::lround(!std::isnan(value) ? std::clamp(value, 0.0, 255.0) : 0.0));
    }
  return out;
}

}  // namespace dubsar
