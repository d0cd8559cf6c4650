#include "core/volume/slab_source.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {

Result<void> VolumeSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= volume_->dims.z);
  const std::int64_t count = (z_end - z_begin) * volume_->dims.slice();
  DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= count);
  const float* from = volume_->row(0, z_begin);
  parallel_chunks(count, 1 << 20, [&](std::int64_t begin, std::int64_t end) {
    std::copy(from + begin, from + end, out.begin() + begin);
  });
  return {};
}

}  // namespace dubsar
