#pragma once
// All slices of a source in memory.

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/volume/slab_source.h"

namespace dubsar::testing {

/// In slabs of `slab` slices, the last one shorter.
inline Result<Volume<float>> read_all(SlabSource& source, std::int64_t slab = 32) {
  const Dims dims = source.dims();
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; z += slab) {
    const std::int64_t end = std::min(dims.z, z + slab);
    const auto count = static_cast<std::size_t>((end - z) * dims.slice());
    DUBSAR_TRY(source.read(z, end, std::span(volume.row(0, z), count)));
  }
  return volume;
}

}  // namespace dubsar::testing
