#include "core/script/marks/side_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dubsar {
namespace {

constexpr float kRasterUnknown = std::numeric_limits<float>::quiet_NaN();

/// Least of what lies around plus a parabola (mm; `lift` a cell squared), one axis; `sign` -1: greatest minus it.
std::vector<float> along_axis(const std::vector<float>& in, int width, int height, bool rows, int reach, double lift,
                              float sign) {
  std::vector<float> out(in.size(), kRasterUnknown);
  const int count = rows ? width : height;
  const auto stride = rows ? std::size_t{1} : static_cast<std::size_t>(width);
  for (int line = 0; line < (rows ? height : width); ++line) {
    const std::size_t begin = static_cast<std::size_t>(line) * (rows ? static_cast<std::size_t>(width) : 1);
    for (int i = 0; i < count; ++i) {
      float best = std::numeric_limits<float>::infinity();
      for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k) {
        const float v = sign * in[begin + static_cast<std::size_t>(k) * stride];
        if (std::isnan(v)) continue;
        best = std::min(best, v + static_cast<float>(lift * (k - i) * (k - i)));
      }
      if (std::isfinite(best)) out[begin + static_cast<std::size_t>(i) * stride] = sign * best;
    }
  }
  return out;
}

}  // namespace

std::vector<float> square_means(const std::vector<float>& values, int width, int height, int reach, double least) {
  const auto w = static_cast<std::size_t>(width) + 1;
  std::vector<double> sums(w * (static_cast<std::size_t>(height) + 1), 0.0), counts(sums.size(), 0.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y + 1) * w + static_cast<std::size_t>(x + 1);
      const float v =
          values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      const bool known = !std::isnan(v);
      sums[at] = (known ? static_cast<double>(v) : 0.0) + sums[at - 1] + sums[at - w] - sums[at - w - 1];
      counts[at] = (known ? 1.0 : 0.0) + counts[at - 1] + counts[at - w] - counts[at - w - 1];
    }
  std::vector<float> out(values.size(), kRasterUnknown);
  const double wanted = least * (2.0 * reach + 1.0) * (2.0 * reach + 1.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto x0 = static_cast<std::size_t>(std::max(0, x - reach)),
                 y0 = static_cast<std::size_t>(std::max(0, y - reach)),
                 x1 = static_cast<std::size_t>(std::min(width, x + reach + 1)),
                 y1 = static_cast<std::size_t>(std::min(height, y + reach + 1));
      const auto over = [&](const std::vector<double>& s) {
        return s[y1 * w + x1] - s[y0 * w + x1] - s[y1 * w + x0] + s[y0 * w + x0];
      };
      const double known = over(counts);
      if (known > 0.0 && known >= wanted)
        out[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
            static_cast<float>(over(sums) / known);
    }
  return out;
}

std::vector<float> stands_out(const HeightMap& map, double radius_mm, double reach_mm) {
  const int reach = std::max(1, static_cast<int>(std::lround(reach_mm / map.step_mm)));
  const double lift = map.step_mm * map.step_mm / (2.0 * radius_mm);
  std::vector<float> low = map.mm;
  for (const float sign : {1.0f, -1.0f})
    for (const bool rows : {true, false}) low = along_axis(low, map.width, map.height, rows, reach, lift, sign);
  for (std::size_t i = 0; i < low.size(); ++i) low[i] = map.mm[i] - low[i];
  return low;
}

}  // namespace dubsar
