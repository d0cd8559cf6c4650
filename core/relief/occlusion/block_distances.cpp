#include "core/relief/occlusion/block_distances.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr double kMostCells = 1e9;  // beyond, blocks of 2^3 cells

/// One bit a block, rows padded to whole words.
struct Bits {
  glm::ivec3 size;
  std::int64_t row_words;
  std::vector<std::uint64_t> words;

  explicit Bits(glm::ivec3 blocks)
      : size(blocks),
        row_words((blocks.x + 63) / 64),
        words(static_cast<std::size_t>(row_words) * static_cast<std::size_t>(blocks.y) *
              static_cast<std::size_t>(blocks.z)) {}
  std::uint64_t* row(std::size_t y, std::size_t z) {
    return words.data() + (static_cast<std::int64_t>(z) * size.y + static_cast<std::int64_t>(y)) * row_words;
  }
  const std::uint64_t* row(std::size_t y, std::size_t z) const {
    return words.data() + (static_cast<std::int64_t>(z) * size.y + static_cast<std::int64_t>(y)) * row_words;
  }
};

/// The blocks that the surface passes. Whole lines of bricks are written by one thread each: rows are not shared.
Bits blocks_with_surface(const SurfaceBricks& bricks) {
  constexpr int kEdge = SurfaceBricks::kEdge;
  Bits out((bricks.size * kEdge) >> bricks.block_bits);
  parallel_for(std::int64_t{bricks.size.y} * bricks.size.z, 4, [&](std::int64_t line) {
    const int by = static_cast<int>(line % bricks.size.y), bz = static_cast<int>(line / bricks.size.y);
    for (int bx = 0; bx < bricks.size.x; ++bx) {
      const std::int32_t brick = bricks.table[static_cast<std::size_t>(line * bricks.size.x + bx)];
      if (brick < 0) continue;
      const auto& cells = bricks.bricks[static_cast<std::size_t>(brick)].cells;
      for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
        if (cells[static_cast<std::size_t>(i)] == SurfaceBricks::kNone) continue;
        const glm::ivec3 at =
            (glm::ivec3(bx, by, bz) * kEdge + glm::ivec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge))) >>
            bricks.block_bits;
        out.row(static_cast<std::size_t>(at.y), static_cast<std::size_t>(at.z))[at.x / 64] |= std::uint64_t{1}
                                                                                              << at.x % 64;
      }
    }
  });
  return out;
}

/// The rows of slice z of `from`, each with those of the slices before and behind it.
void join_slices(const Bits& from, int z, std::vector<std::uint64_t>& joined) {
  const auto words = static_cast<std::size_t>(from.row_words * from.size.y);
  joined.assign(words, 0);
  for (int k = std::max(z - 1, 0); k <= std::min(z + 1, from.size.z - 1); ++k) {
    const std::uint64_t* slice = from.row(0, static_cast<std::size_t>(k));
    for (std::size_t w = 0; w < words; ++w) joined[w] |= slice[w];
  }
}

/// Row y of such a slice, grown by one block on all sides, into `grown`.
void grow_row(const Bits& from, const std::vector<std::uint64_t>& joined, int y, std::uint64_t* grown,
              std::uint64_t* both) {
  const auto words = static_cast<std::size_t>(from.row_words);
  std::fill_n(both, words, 0);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, from.size.y - 1); ++j) {
    const std::uint64_t* row = joined.data() + from.row_words * j;
    for (std::size_t w = 0; w < words; ++w) both[w] |= row[w];
  }
  for (std::size_t w = 0; w < words; ++w) {
    const std::uint64_t left = w > 0 ? both[w - 1] >> 63 : 0, right = w + 1 < words ? both[w + 1] << 63 : 0;
    grown[w] = both[w] | both[w] << 1 | left | both[w] >> 1 | right;
  }
}

}  // namespace

Result<void> measure_away(SurfaceBricks& bricks, Progress& progress) {
  const glm::dvec3 cells = glm::dvec3(bricks.size) * static_cast<double>(SurfaceBricks::kEdge);
  bricks.block_bits = cells.x * cells.y * cells.z > kMostCells ? 1 : 0;
  Bits now = blocks_with_surface(bricks);
  const double blocks = static_cast<double>(now.size.x) * now.size.y * now.size.z;
  if (blocks > 2e9)
    return fail(ErrorKind::kTryAgain, "occlusion: a surface of {} x {} x {} voxels is too large to march", cells.x,
                cells.y, cells.z);
  constexpr std::size_t kEdge = SurfaceBricks::kEdge, kLine = kEdge * kEdge * kEdge;
  const auto nx = static_cast<std::size_t>(now.size.x);
  const auto bricks_x = (nx + kEdge - 1) / kEdge, bricks_y = (static_cast<std::size_t>(now.size.y) + kEdge - 1) / kEdge,
             bricks_z = (static_cast<std::size_t>(now.size.z) + kEdge - 1) / kEdge;
  bricks.away.assign(bricks_x * bricks_y * bricks_z * kLine + 3, SurfaceBricks::kMostAway);
  // Step k marks the blocks at distance k: those that the blocks nearer than k reach when they grow by one.
  Bits next = now;
  for (int k = 0; k < SurfaceBricks::kMostAway; ++k) {
    if (progress.cancelled()) return cancelled_error();
    parallel_for(now.size.z, 1, [&](std::int64_t slice) {
      const auto z = static_cast<std::size_t>(slice);
      std::vector<std::uint64_t> grown(static_cast<std::size_t>(now.row_words)), both = grown, joined;
      if (k > 0) join_slices(now, static_cast<int>(z), joined);
      for (std::size_t y = 0; y < static_cast<std::size_t>(now.size.y); ++y) {
        const std::uint64_t* old = now.row(y, z);
        std::uint64_t* out = next.row(y, z);
        std::uint8_t* away = bricks.away.data() + (z / kEdge * bricks_y + y / kEdge) * bricks_x * kLine +
                             (z % kEdge * kEdge + y % kEdge) * kEdge;
        if (k == 0)
          std::copy_n(old, now.row_words, grown.begin());
        else
          grow_row(now, joined, static_cast<int>(y), grown.data(), both.data());
        for (std::size_t w = 0; w < grown.size(); ++w) {
          out[w] = grown[w];
          std::uint64_t fresh = k == 0 ? grown[w] : grown[w] & ~old[w];
          if (w + 1 == grown.size() && nx % 64 != 0) fresh &= (std::uint64_t{1} << nx % 64) - 1;
          for (; fresh != 0; fresh &= fresh - 1) {
            const std::size_t x = 64 * w + static_cast<std::size_t>(std::countr_zero(fresh));
            away[x / kEdge * kLine + x % kEdge] = static_cast<std::uint8_t>(k);
          }
        }
      }
    });
    std::swap(now, next);
  }
  return {};
}

}  // namespace dubsar
