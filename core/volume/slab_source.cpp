#include "core/volume/slab_source.h"

#include <algorithm>

#include "core/base/budget.h"
#include "core/base/parallel.h"

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

Result<Volume<float>> read_all(SlabSource& source, Progress& progress, std::int64_t slab) {
  const Dims dims = source.dims();
  DUBSAR_TRY(check_memory("volume", static_cast<std::uint64_t>(dims.count()) * sizeof(float)));
  Volume<float> volume(dims);
  const std::int64_t preferred = std::max<std::int64_t>(1, source.preferred_height());
  if (slab <= 0) slab = std::max<std::int64_t>(1, 32 / preferred) * preferred;
  for (std::int64_t z = 0; z < dims.z; z += slab) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t end = std::min(dims.z, z + slab);
    const std::int64_t count = (end - z) * dims.slice();
    DUBSAR_TRY(source.read(z, end, std::span(volume.row(0, z), static_cast<std::size_t>(count))));
    progress.advance(count);
  }
  return volume;
}

}  // namespace dubsar
