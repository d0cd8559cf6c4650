#include "core/volume/voxel_reader.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace dubsar {

bool can_be_nonfinite(ScalarType type, const ScalarMap& map) noexcept {
  const double largest =
      std::ldexp(std::abs(map.scale), static_cast<int>(8 * scalar_bytes(type))) + std::abs(map.offset);
  return is_float(type) || map.none.any() || !(largest < static_cast<double>(std::numeric_limits<float>::max()));
}

void copy_row(const std::byte* from, std::int64_t number_bytes, const AxisRange& x, std::byte* to) {
  const std::int64_t count = x.count();
  if (x.step == 1) {
    std::memcpy(to, from, static_cast<std::size_t>(count * number_bytes));
    return;
  }
  for (std::int64_t i = 0; i < count; ++i)
    std::memcpy(to + i * number_bytes, from + i * x.step * number_bytes, static_cast<std::size_t>(number_bytes));
}

}  // namespace dubsar
