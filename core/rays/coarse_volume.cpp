#include "core/rays/coarse_volume.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {

Result<CoarseVolume> read_coarse_volume(SlabSource& source, std::int64_t widest, Progress& progress) {
  const Dims dims = source.dims();
  CoarseVolume coarse;
  while (std::max({dims.x, dims.y, dims.z}) > widest * coarse.cell) coarse.cell *= 2;
  const std::int64_t cell = coarse.cell;
  const auto cells = [&](std::int64_t n) { return std::max<std::int64_t>(1, n / cell); };
  coarse.volume = Volume<float>({cells(dims.x), cells(dims.y), cells(dims.z)});
  const std::int64_t across = std::min(cell, dims.x), down = std::min(cell, dims.y);
  const auto scale = 1.0F / static_cast<float>(across * down);
  Buffer<float> slice(dims.slice());
  for (std::int64_t z = 0; z < coarse.volume.dims.z; ++z) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t middle = std::min(dims.z - 1, z * cell + cell / 2);
    DUBSAR_TRY(source.read(middle, middle + 1, slice.span()));
    parallel_for(coarse.volume.dims.y, 8, [&](std::int64_t y) {
      for (std::int64_t x = 0; x < coarse.volume.dims.x; ++x) {
        float sum = 0.0F;
        for (std::int64_t j = 0; j < down; ++j)
          for (std::int64_t i = 0; i < across; ++i) sum += slice[(y * cell + j) * dims.x + x * cell + i];
        coarse.volume.at(x, y, z) = sum * scale;
      }
    });
    progress.advance(dims.slice());
  }
  return coarse;
}

}  // namespace dubsar
