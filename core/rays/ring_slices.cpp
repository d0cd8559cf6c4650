#include "core/rays/ring_slices.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// Steps of half the resolution.
constexpr std::int64_t kRingsMargin = 1, kRingsThin = 2;

/// Sets what lies between pixels that are set and nearer than twice `reach`, in rows and columns.
void close_gaps(std::vector<std::uint8_t>& set, std::int64_t width, std::int64_t height, std::int64_t reach) {
  std::vector<std::uint8_t> other(set.size());
  for (const bool wanted : {true, false})  // grown, then shrunk
    for (const bool along_x : {true, false}) {
      parallel_for(height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < width; ++x) {
          const std::int64_t at = along_x ? x : y, end = along_x ? width : height;
          bool found = false;
          for (std::int64_t k = std::max<std::int64_t>(0, at - reach); k <= std::min(end - 1, at + reach); ++k)
            found |= (set[static_cast<std::size_t>(along_x ? y * width + k : k * width + x)] != 0) == wanted;
          other[static_cast<std::size_t>(y * width + x)] = found == wanted ? 1 : 0;
        }
      });
      set.swap(other);
    }
}

/// Away from the other side of `level` by the margin in all directions. `closed`: what is thin is no surface.
Result<std::vector<Material>> sure_in_slice(SlabSource& half, std::int64_t z, float level, bool closed) {
  const Dims d = half.dims();
  std::vector<float> slice(static_cast<std::size_t>(d.slice()));
  std::vector<std::uint8_t> clay(slice.size(), 1), air(slice.size(), 1);
  for (std::int64_t k = std::max<std::int64_t>(0, z - kRingsMargin); k <= std::min(d.z - 1, z + kRingsMargin); ++k) {
    DUBSAR_TRY(half.read(k, k + 1, slice));
    if (!closed) {
      for (std::size_t i = 0; i < slice.size(); ++i) (slice[i] >= level ? air : clay)[i] = 0;
      continue;
    }
    std::vector<std::uint8_t> here(slice.size());
    for (std::size_t i = 0; i < slice.size(); ++i) here[i] = slice[i] >= level;
    close_gaps(here, d.x, d.y, kRingsThin);
    for (std::size_t i = 0; i < slice.size(); ++i) clay[i] &= here[i];
    for (std::size_t i = 0; i < slice.size(); ++i) here[i] = slice[i] < level;
    close_gaps(here, d.x, d.y, kRingsThin);
    for (std::size_t i = 0; i < slice.size(); ++i) air[i] &= here[i];
  }
  std::vector<Material> sure(slice.size(), Material::kUnsure);
  parallel_for(d.y, 16, [&](std::int64_t y) {
    for (std::int64_t x = 0; x < d.x; ++x) {
      bool all_clay = true, all_air = true;
      for (std::int64_t v = std::max<std::int64_t>(0, y - kRingsMargin); v <= std::min(d.y - 1, y + kRingsMargin); ++v)
        for (std::int64_t u = std::max<std::int64_t>(0, x - kRingsMargin); u <= std::min(d.x - 1, x + kRingsMargin);
             ++u) {
          all_clay &= clay[static_cast<std::size_t>(v * d.x + u)] != 0;
          all_air &= air[static_cast<std::size_t>(v * d.x + u)] != 0;
        }
      sure[static_cast<std::size_t>(y * d.x + x)] = all_clay == all_air ? Material::kUnsure
                                                    : all_clay          ? Material::kClay
                                                                        : Material::kAir;
    }
  });
  return sure;
}

}  // namespace

Result<void> add_slice(SlabSource& scan, SlabSource& half, std::int64_t z, float level, RingSlices& slices) {
  std::vector<float>& values = slices.values.emplace_back(static_cast<std::size_t>(scan.dims().slice()));
  DUBSAR_TRY(scan.read(z, z + 1, values));
  DUBSAR_ASSIGN(std::vector<Material> sure, sure_in_slice(half, std::min(z / 2, half.dims().z - 1), level, false));
  slices.sure.push_back(std::move(sure));
  return {};
}

std::vector<PolarSums> sums_of(const PolarSlice& polar, const RingSlices& slices) {
  std::vector<PolarSums> sums(slices.values.size(), PolarSums(polar.radii()));
  parallel_for(static_cast<std::int64_t>(sums.size()), 1, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    polar.add(slices.values[k], slices.sure[k], sums[k]);
  });
  return sums;
}

PolarSums all_of(const std::vector<PolarSums>& sums) {
  PolarSums all(sums.front().radii);
  for (const PolarSums& one : sums) all.add(one);
  return all;
}

Result<void> take_thin_for_rings(SlabSource& half, float level, RingSlices& slices) {
  for (std::size_t k = 0; k < slices.sure.size(); ++k) {
    const std::int64_t z = slices.first + static_cast<std::int64_t>(k);
    DUBSAR_ASSIGN(slices.sure[k], sure_in_slice(half, std::min(z / 2, half.dims().z - 1), level, true));
  }
  return {};
}

}  // namespace dubsar
