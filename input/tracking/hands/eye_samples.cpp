#include "input/tracking/hands/eye_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace dubsar {

EyeRays::EyeRays(const std::function<glm::dvec2(const glm::dvec2&)>& ray_from_pixel, int width, int height, int step) {
  constexpr int kColumns = 8, kRows = 2;
  for (int y0 = 0; y0 + kRows <= height; y0 += kRows)
    for (int x0 = 0; x0 + kColumns * step <= width; x0 += kColumns * step) {
      Tile tile;
      RayBox box{{1e9F, 1e9F}, {-1e9F, -1e9F}};
      bool seen = true;
      for (int i = 0; i < kColumns * kRows; ++i) {
        const int x = x0 + (i % kColumns) * step, y = y0 + i / kColumns;
        const glm::dvec2 ray = ray_from_pixel({x, y});
        seen = seen && std::isfinite(ray.x) && std::isfinite(ray.y) && std::abs(ray.x) < 2.5 && std::abs(ray.y) < 2.5;
        const double inverse_length = 1.0 / std::sqrt(1.0 + ray.x * ray.x + ray.y * ray.y);
        const auto lane = static_cast<std::size_t>(i);
        tile.x[lane] = static_cast<float>(ray.x * inverse_length);
        tile.y[lane] = static_cast<float>(ray.y * inverse_length);
        tile.z[lane] = static_cast<float>(inverse_length);
        tile.pixel[lane] = static_cast<std::uint32_t>(y * width + x);
        box.low = glm::min(box.low, glm::vec2(ray));
        box.high = glm::max(box.high, glm::vec2(ray));
      }
      if (!seen) continue;
      tiles_.push_back(tile);
      boxes_.push_back(box);
    }
}

}  // namespace dubsar
