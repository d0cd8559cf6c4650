#include "core/volume/voxel_reader.h"

#include <cmath>
#include <limits>

namespace dubsar {

bool can_be_nonfinite(ScalarType type, const ScalarMap& map) noexcept {
  const double largest =
      std::ldexp(std::abs(map.scale), static_cast<int>(8 * scalar_bytes(type))) + std::abs(map.offset);
  return is_float(type) || !(largest < static_cast<double>(std::numeric_limits<float>::max()));
}

void store_row(const std::byte* from, ScalarType type, ByteOrder order, const ScalarMap& map, const AxisRange& x,
               std::span<float> out) {
  const auto count = static_cast<std::size_t>(x.count());
  if (x.step == 1) return scalars_to_float(from, type, order, map, out.first(count));
  const std::int64_t bytes = x.step * scalar_bytes(type);
  for (std::size_t i = 0; i < count; ++i)
    scalars_to_float(from + static_cast<std::int64_t>(i) * bytes, type, order, map, out.subspan(i, 1));
}

}  // namespace dubsar
