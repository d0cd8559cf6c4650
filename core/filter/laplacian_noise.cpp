// Noise of a volume whose histogram says nothing about it, from how much its voxels differ from their neighbours.

#include <cmath>
#include <limits>
#include <vector>

#include "core/filter/estimate.h"

namespace dubsar {

Result<double> laplacian_noise(SlabSource& source, Progress& progress, std::optional<float> left_out) {
  const Dims dims = source.dims();
  if (dims.x < 3 || dims.y < 3) return 0.0;
  ValueCounts residuals;
  Buffer<float> slice(dims.slice());
  std::vector<float> line(static_cast<std::size_t>(dims.x - 2));
  const std::int64_t stride = std::max<std::int64_t>(1, dims.z / 64);  // 64 slices say enough
  for (std::int64_t z = stride / 2; z < dims.z; z += stride) {
    if (progress.cancelled()) return cancelled_error();
    DUBSAR_TRY(source.read(z, z + 1, slice.span()));
    for (std::int64_t y = 1; y + 1 < dims.y; ++y) {
      const float* row = slice.data() + y * dims.x;
      for (std::int64_t x = 1; x + 1 < dims.x; ++x)
        line[static_cast<std::size_t>(x - 1)] =
            std::abs(row[x - 1] + row[x + 1] + row[x - dims.x] + row[x + dims.x] - 4.0F * row[x]);
      if (left_out)
        for (std::int64_t x = 1; x + 1 < dims.x; ++x)
          if (row[x] == *left_out) line[static_cast<std::size_t>(x - 1)] = std::numeric_limits<float>::quiet_NaN();
      residuals.add(line);
    }
  }
  const std::vector<ValueCounts::Value> values = residuals.values();
  std::int64_t below = 0, count = residuals.count();
  for (const ValueCounts::Value& value : values) {
    if (value.centre <= 0.0 && 2 * value.count >= count) {  // a background masked with one value has no noise
      count -= value.count;
      continue;
    }
    below += value.count;
    if (2 * below >= count) return 1.4826 * value.centre / std::sqrt(20.0);
  }
  return 0.0;
}

}  // namespace dubsar
