#include "core/rays/ring_field.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar {

std::int64_t radii_of(const Dims& dims, const glm::dvec2& centre) {
  const double x = std::max(centre.x, static_cast<double>(dims.x - 1) - centre.x),
               y = std::max(centre.y, static_cast<double>(dims.y - 1) - centre.y);
  return static_cast<std::int64_t>(std::hypot(x, y)) + 2;
}

void RingField::subtract(std::int64_t y, std::int64_t z, std::span<float> row) const {
  const float* const of_arcs = of_slice.data() + z * arcs() * radii;
  const double line_x = half ? std::cos(half->angle) : 0.0, line_y = half ? std::sin(half->angle) : 0.0;
  const double across = static_cast<double>(y) - centre.y;
  for (std::size_t x = 0; x < row.size(); ++x) {
    const double along = static_cast<double>(x) - centre.x;
    const auto radius = static_cast<float>(std::sqrt(along * along + across * across));
    const auto ring = static_cast<std::int64_t>(radius);
    if (ring + 1 >= radii) continue;
    const float* const rings = of_arcs + (line_x * across - line_y * along < 0.0 ? radii : 0);
    const float t = radius - static_cast<float>(ring);
    row[x] -= rings[ring] + t * (rings[ring + 1] - rings[ring]);
  }
}

Result<void> RinglessSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_TRY(source_->read(z_begin, z_end, out));
  const Dims d = dims();
  parallel_for((z_end - z_begin) * d.y, 64, [&](std::int64_t i) {
    field_.subtract(i % d.y, z_begin + i / d.y,
                    out.subspan(static_cast<std::size_t>(i * d.x), static_cast<std::size_t>(d.x)));
  });
  return {};
}

}  // namespace dubsar
