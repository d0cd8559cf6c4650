#include "core/refine/near_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/filter/slice_ring.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBrickEdge = BrickMask::kEdge;
constexpr std::int64_t kLeastPoints = 2 * kBrickEdge;  ///< along each axis, for half of them to say anything
constexpr std::int64_t kBatchBytes = 8 << 20;

/// The bricks that lie within reach of point i of an axis of `half`.
struct Bricks {
  std::int64_t first, last;
};
Bricks bricks_near(std::int64_t i, std::int64_t reach, std::int64_t bricks) {
  const std::int64_t centre = 2 * i + 1;
  return {std::max<std::int64_t>(centre - reach, 0) / kBrickEdge, std::min((centre + reach) / kBrickEdge, bricks - 1)};
}

/// The point of `half` that speaks for a whole brick.
std::int64_t speaker(std::int64_t brick, std::int64_t points) {
  return std::min(brick * kBrickEdge / 2 + 1, points - 1);
}

/// A row of `half` and the four beside it.
using Rows = std::array<const float*, 5>;

void mark_row(const Rows& rows, std::int64_t points, const NearSurfaceOptions& options, std::int64_t bricks,
              std::vector<std::uint8_t>& hit, std::uint64_t* bits) {
  const float* const own = rows[0];
  const float threshold = options.threshold, margin = options.margin;
  for (std::int64_t x = 0; x < points; ++x) {
    const bool inside = own[x] >= threshold;
    bool near = std::abs(own[x] - threshold) <= margin;
    for (std::size_t k = 1; k < 5; ++k) near |= (rows[k][x] >= threshold) != inside;
    hit[static_cast<std::size_t>(x)] = near ? 1 : 0;
  }
  for (std::int64_t x = 0; x + 1 < points; ++x)
    if ((own[x] >= threshold) != (own[x + 1] >= threshold))
      hit[static_cast<std::size_t>(x)] = hit[static_cast<std::size_t>(x) + 1] = 1;
  for (std::int64_t x = 0; x < points; ++x) {
    if (hit[static_cast<std::size_t>(x)] == 0) continue;
    const Bricks near = bricks_near(x, options.reach, bricks);
    for (std::int64_t bx = near.first; bx <= near.last; ++bx) bits[bx >> 6] |= std::uint64_t{1} << (bx & 63);
  }
}

}  // namespace

Result<NearSurface> mark_near_surface(SlabSource& half, const Dims& scan, const NearSurfaceOptions& options,
                                      Progress& progress) {
  NearSurface result{BrickMask(scan), BrickMask(scan)};
  const Dims d = half.dims(), bricks = result.near.bricks();
  progress.begin("band", d.count(), "voxel");
  if (std::min({scan.x, scan.y, scan.z}) < kLeastPoints) {
    result.near.set_all();
    return result;
  }
  const std::int64_t words = result.near.words_per_row();
  const std::int64_t batch = std::clamp<std::int64_t>(kBatchBytes / (d.slice() * std::int64_t{sizeof(float)}), 1, 32);
  SliceRing ring(d, batch + 2, SliceRing::Rows::kContiguous);
  std::vector<std::uint64_t> row_bits;
  for (std::int64_t z0 = 0; z0 < d.z; z0 += batch) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t z1 = std::min(z0 + batch, d.z);
    DUBSAR_TRY(ring.load(half, {z0 - 1, z1 + 1}));
    row_bits.assign(static_cast<std::size_t>((z1 - z0) * d.y * words), 0);
    parallel_chunks((z1 - z0) * d.y, 16, [&](std::int64_t begin, std::int64_t end) {
      std::vector<std::uint8_t> hit(static_cast<std::size_t>(d.x));
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t y = i % d.y, z = z0 + i / d.y;
        const Rows rows{ring.row(y, z), ring.row(y - 1, z), ring.row(y + 1, z), ring.row(y, z - 1), ring.row(y, z + 1)};
        mark_row(rows, d.x, options, bricks.x, hit, row_bits.data() + i * words);
      }
    });
    parallel_for(bricks.y, 4, [&](std::int64_t by) {
      for (std::int64_t z = z0; z < z1; ++z) {
        const Bricks layers = bricks_near(z, options.reach, bricks.z);
        const std::int64_t y_first = std::max<std::int64_t>((by * kBrickEdge - options.reach) / 2 - 1, 0);
        const std::int64_t y_last = std::min((by * kBrickEdge + kBrickEdge + options.reach) / 2, d.y - 1);
        for (std::int64_t y = y_first; y <= y_last; ++y) {
          const Bricks near = bricks_near(y, options.reach, bricks.y);
          if (by < near.first || by > near.last) continue;
          const std::uint64_t* from = row_bits.data() + ((z - z0) * d.y + y) * words;
          for (std::int64_t bz = layers.first; bz <= layers.last; ++bz)
            for (std::int64_t w = 0; w < words; ++w) result.near.row(by, bz)[w] |= from[w];
        }
        const std::int64_t bz = z * 2 / kBrickEdge;
        if (bz >= bricks.z) continue;
        // The last bricks of an axis may have the speaker of the one before.
        for (std::int64_t layer = bz; layer < std::min(bz + 2, bricks.z); ++layer) {
          if (speaker(layer, d.z) != z) continue;
          const float* const row = ring.row(speaker(by, d.y), z);
          for (std::int64_t bx = 0; bx < bricks.x; ++bx)
            if (row[speaker(bx, d.x)] >= options.threshold) result.inside.set(bx, by, layer);
        }
      }
    });
    progress.advance((z1 - z0) * d.slice());
  }
  return result;
}

}  // namespace dubsar
