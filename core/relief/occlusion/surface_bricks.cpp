#include "core/relief/occlusion/surface_bricks.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "core/base/system/parallel.h"
#include "core/relief/occlusion/ahead_distances.h"

namespace dubsar {
namespace {

constexpr int kBlock = 16;  // cells: what one thread fills at a time
constexpr int kBlockBricks = kBlock / SurfaceBricks::kEdge;
constexpr int kCorners = kBlock + 1;  // of a block, each way
constexpr float kReach = 2.0f;        // voxels from a piece of surface to the furthest corner that it tells
constexpr float kPiece = 1.3f;        // voxels: longer edges are split
/// How much nearer a piece is that lies face-on: beside sharp edges the planes of pieces just around the corner would
/// tell the wrong side. Chosen on lumps with dents (difference of the light from that of the triangles .015 instead of
/// .023).
constexpr float kFaceOn = 0.7f;
constexpr int kMargin = 4;  // cells around the surface
constexpr float kFar = std::numeric_limits<float>::max();

struct Box {
  glm::vec3 low{INFINITY}, high{-INFINITY};
};

bool usable(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const float sum = a.x + a.y + a.z + b.x + b.y + b.z + c.x + c.y + c.z;
  return std::isfinite(sum) && glm::cross(b - a, c - a) != glm::vec3(0.0f);
}

/// The blocks that a triangle can tell something about: first and last, clamped to the grid.
struct BlockRange {
  glm::ivec3 first, last;
};
BlockRange blocks_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, glm::ivec3 blocks) {
  const glm::vec3 low = glm::min(glm::min(a, b), c) - kReach, high = glm::max(glm::max(a, b), c) + kReach;
  // A corner on the border of two blocks belongs to both.
  return {glm::clamp(glm::ivec3(glm::floor((low - 1.0f) / float{kBlock})), glm::ivec3(0), blocks - 1),
          glm::clamp(glm::ivec3(glm::floor(high / float{kBlock})), glm::ivec3(0), blocks - 1)};
}

/// The distances at the corners of a block: each from the plane of the piece of surface that is nearest and most
/// face-on.
class BlockCorners {
 public:
  void clear() { nearest2_.fill(kFar); }

  /// A piece of a triangle about `middle` with unit normal `normal`, relative to the block.
  void add(glm::vec3 middle, glm::vec3 normal) {
    const glm::ivec3 cell(glm::floor(middle));
    if (cell.x < -2 || cell.x > kCorners) return;
    const glm::ivec3 first = glm::max(cell - 1, glm::ivec3(0)), last = glm::min(cell + 2, glm::ivec3(kCorners - 1));
    const int x = cell.x - 1;  // four corners at once, of which some may lie in the room beside the row
    const Float4 dx = Float4{0.0f, 1.0f, 2.0f, 3.0f} + static_cast<float>(x) - middle.x;
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y) {
        const float dy = static_cast<float>(y) - middle.y, dz = static_cast<float>(z) - middle.z;
        const float square = dy * dy + dz * dz, height = dy * normal.y + dz * normal.z;
        const Float4 distance = height + dx * normal.x;
        const Float4 far2 = square + dx * dx - kFaceOn * distance * distance;
        const std::size_t i = index(x, y, z);
        Float4 nearest2, known;
        std::memcpy(&nearest2, &nearest2_[i], sizeof nearest2);
        std::memcpy(&known, &distance_[i], sizeof known);
        // Of pieces as near as each other the smaller distance counts, so that their order does not.
        const auto nearer = (far2 < nearest2) | ((far2 == nearest2) & (distance < known));
        nearest2 = nearer ? far2 : nearest2;
        known = nearer ? distance : known;
        std::memcpy(&nearest2_[i], &nearest2, sizeof nearest2);
        std::memcpy(&distance_[i], &known, sizeof known);
      }
  }

  /// A triangle in pieces with edges of at most kPiece; those that cannot reach the block are left out.
  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& normal) {
    const glm::vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    for (int axis = 0; axis < 3; ++axis)
      if (high[axis] < -kReach || low[axis] > kBlock + kReach) return;
    const float ab = glm::dot(b - a, b - a), bc = glm::dot(c - b, c - b), ca = glm::dot(a - c, a - c);
    const float longest = std::max({ab, bc, ca});
    if (longest <= kPiece * kPiece) return add((a + b + c) / 3.0f, normal);
    if (longest == ab) {
      add(a, (a + b) * 0.5f, c, normal);
      add((a + b) * 0.5f, b, c, normal);
    } else if (longest == bc) {
      add(a, b, (b + c) * 0.5f, normal);
      add(a, (b + c) * 0.5f, c, normal);
    } else {
      add(a, b, (c + a) * 0.5f, normal);
      add(b, c, (c + a) * 0.5f, normal);
    }
  }

  /// Turns what was added into steps.
  void finish() {
    for (int z = 0; z < kCorners; ++z)
      for (int y = 0; y < kCorners; ++y)
        for (std::size_t i = index(0, y, z), end = i + kCorners; i < end; ++i)
          steps_[i] = nearest2_[i] < kFar ? static_cast<std::int8_t>(std::lround(
                                                std::clamp(distance_[i] * SurfaceBricks::kSteps, -127.0f, 127.0f)))
                                          : kUnknown;
  }
  static constexpr std::int8_t kUnknown = -128;
  /// Of corners x and x + 1, once finished; in steps, or kUnknown.
  const std::int8_t* steps(int x, int y, int z) const { return &steps_[index(x, y, z)]; }

 private:
  typedef float Float4 __attribute__((vector_size(16)));
  static constexpr int kRoom = 4, kRow = 24;  // numbers before a row, and from row to row
  static_assert(kRoom >= 3 && kRoom + kCorners + 3 <= kRow);
  static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>((z * kCorners + y) * kRow + x + kRoom);
  }
  static constexpr std::size_t kNumbers = std::size_t{kCorners} * kCorners * kRow;
  std::array<float, kNumbers> nearest2_{}, distance_{};
  std::array<std::int8_t, kNumbers> steps_{};
};

/// What a block gives: of its bricks with surface the places (x first) and cells, and the corners of all.
struct BlockOut {
  struct Found {
    std::uint16_t place;
    std::uint8_t cells;  ///< a bit each
  };
  std::vector<Found> bricks;
  std::vector<SurfaceBricks::Corners> corners;
};

/// Empty when the surface does not pass.
bool corners_of_cell(const BlockCorners& block, int x, int y, int z, SurfaceBricks::Corners& out) {
  for (int edge = 0; edge < 4; ++edge)
    std::memcpy(&out[static_cast<std::size_t>(2 * edge)], block.steps(x, y + (edge & 1), z + (edge >> 1)), 2);
  int below = 0;
  for (const std::int8_t steps : out) {
    if (steps == BlockCorners::kUnknown) return false;
    below += steps < 0 ? 1 : 0;
  }
  return below != 0 && below != 8;
}

void find_bricks(const BlockCorners& block, BlockOut& out) {
  constexpr int kEdge = SurfaceBricks::kEdge;
  SurfaceBricks::Corners corners;
  for (int place = 0; place < kBlockBricks * kBlockBricks * kBlockBricks; ++place) {
    const glm::ivec3 at = kEdge * glm::ivec3(place % kBlockBricks, place / kBlockBricks % kBlockBricks,
                                             place / (kBlockBricks * kBlockBricks));
    if (*block.steps(at.x + 1, at.y + 1, at.z + 1) == BlockCorners::kUnknown) continue;  // a corner of all its cells
    unsigned cells = 0;
    for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
      if (!corners_of_cell(block, at.x + (i & 1), at.y + (i >> 1 & 1), at.z + (i >> 2), corners)) continue;
      out.corners.push_back(corners);
      cells |= 1u << i;
    }
    if (cells != 0) out.bricks.push_back({static_cast<std::uint16_t>(place), static_cast<std::uint8_t>(cells)});
  }
}

/// Which triangles reach each block.
struct BlockLists {
  std::vector<std::int64_t> first;  ///< of each block, one more
  std::vector<std::uint32_t> triangles;
};

/// The steps from triangles to bricks.
class Builder {
 public:
  Builder(std::span<const glm::vec3> positions, std::span<const Triangle> triangles, Progress& progress)
      : positions_(positions), triangles_(triangles), progress_(progress) {}

  Result<SurfaceBricks> run() {
    SurfaceBricks out;
    const Box box = bounds();
    if (!(box.low.x <= box.high.x)) return out;
    out.origin = origin_ = glm::floor(box.low) - float{kMargin};
    const glm::vec3 extent = (glm::floor(box.high) - origin_ + float{kMargin + 1}) / float{kBlock};
    if (extent.x * extent.y * extent.z * float{kBlock * kBlock * kBlock} > 2e9f)
      return fail(ErrorKind::kTryAgain, "occlusion: a surface of {:.0f} x {:.0f} x {:.0f} voxels is too large to march",
                  extent.x * kBlock, extent.y * kBlock, extent.z * kBlock);
    blocks_ = glm::ivec3(glm::ceil(extent));
    out.tiles = blocks_ * (kBlockBricks / 2);
    std::vector<BlockOut> found = fill_blocks(lists());
    if (progress_.cancelled()) return cancelled_error();
    DUBSAR_TRY(join(found, out));
    if (!measure_ahead(out, progress_)) return cancelled_error();
    return out;
  }

 private:
  const glm::vec3& corner(std::int64_t t, std::size_t k) const {
    return positions_[triangles_[static_cast<std::size_t>(t)][k]];
  }
  std::int64_t count() const { return static_cast<std::int64_t>(triangles_.size()); }
  std::size_t block_count() const {
    return static_cast<std::size_t>(blocks_.x) * static_cast<std::size_t>(blocks_.y) *
           static_cast<std::size_t>(blocks_.z);
  }
  glm::ivec3 place_of(std::size_t block) const {
    const auto n = static_cast<int>(block);
    return {n % blocks_.x, n / blocks_.x % blocks_.y, n / (blocks_.x * blocks_.y)};
  }

  Box bounds() const {
    return parallel_reduce(
        count(), 1 << 16, Box{},
        [&](std::int64_t begin, std::int64_t end) {
          Box part;
          for (std::int64_t t = begin; t < end; ++t) {
            const glm::vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
            if (!usable(a, b, c)) continue;
            part.low = glm::min(part.low, glm::min(glm::min(a, b), c));
            part.high = glm::max(part.high, glm::max(glm::max(a, b), c));
          }
          return part;
        },
        [](const Box& a, const Box& b) {
          return Box{glm::min(a.low, b.low), glm::max(a.high, b.high)};
        });
  }

  /// use(block) for each block that triangle t reaches.
  template <class Use>
  void each_block(std::int64_t t, const Use& use) const {
    const glm::vec3 a = corner(t, 0) - origin_, b = corner(t, 1) - origin_, c = corner(t, 2) - origin_;
    if (!usable(a, b, c)) return;
    const BlockRange range = blocks_of(a, b, c, blocks_);
    for (int z = range.first.z; z <= range.last.z; ++z)
      for (int y = range.first.y; y <= range.last.y; ++y)
        for (int x = range.first.x; x <= range.last.x; ++x)
          use(static_cast<std::size_t>((std::int64_t{z} * blocks_.y + y) * blocks_.x + x));
  }

  /// Counted, then filled; the order of a block's triangles is left open, and plays no part.
  BlockLists lists() const {
    BlockLists out;
    std::vector<std::atomic<std::int64_t>> fill(block_count());
    parallel_for(count(), 1 << 14, [&](std::int64_t t) {
      each_block(t, [&](std::size_t b) { fill[b].fetch_add(1, std::memory_order_relaxed); });
    });
    out.first.resize(fill.size() + 1);
    if (progress_.cancelled()) return out;
    for (std::size_t b = 0; b < fill.size(); ++b) {
      out.first[b + 1] = out.first[b] + fill[b].load();
      fill[b].store(out.first[b]);
    }
    out.triangles.resize(static_cast<std::size_t>(out.first.back()));
    parallel_for(count(), 1 << 14, [&](std::int64_t t) {
      each_block(t, [&](std::size_t b) {
        out.triangles[static_cast<std::size_t>(fill[b].fetch_add(1, std::memory_order_relaxed))] =
            static_cast<std::uint32_t>(t);
      });
    });
    return out;
  }

  std::vector<BlockOut> fill_blocks(const BlockLists& lists) const {
    std::vector<BlockOut> out(block_count());
    parallel_chunks(static_cast<std::int64_t>(out.size()), 16, [&](std::int64_t begin, std::int64_t end) {
      const auto work = std::make_unique<BlockCorners>();
      BlockOut found;
      for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
        if (lists.first[b] == lists.first[b + 1]) continue;
        if (progress_.cancelled()) return;
        const glm::vec3 low = origin_ + glm::vec3(kBlock * place_of(b));
        work->clear();
        for (std::int64_t i = lists.first[b]; i < lists.first[b + 1]; ++i) {
          const std::int64_t t = lists.triangles[static_cast<std::size_t>(i)];
          const glm::vec3 p = corner(t, 0) - low, q = corner(t, 1) - low, r = corner(t, 2) - low;
          work->add(p, q, r, glm::normalize(glm::cross(q - p, r - p)));
        }
        work->finish();
        found.bricks.clear();
        found.corners.clear();
        find_bricks(*work, found);
        out[b] = found;  // a copy has no room to spare
      }
    });
    return out;
  }

  /// Blocks in their order, each let go when it is copied.
  Result<void> join(std::vector<BlockOut>& found, SurfaceBricks& out) const {
    std::vector<std::size_t> first_corners(found.size() + 1);
    for (std::size_t b = 0; b < found.size(); ++b) first_corners[b + 1] = first_corners[b] + found[b].corners.size();
    constexpr auto kLargest = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (first_corners.back() > kLargest / sizeof(SurfaceBricks::Corners))
      return fail(ErrorKind::kTryAgain, "occlusion: a surface through {} cells is too large to march",
                  first_corners.back());
    out.corners.resize(first_corners.back() + 1);
    out.bricks.assign(found.size() * kBlockBricks * kBlockBricks * kBlockBricks, {});
    parallel_for(static_cast<std::int64_t>(found.size()), 64, [&](std::int64_t i) {
      const auto b = static_cast<std::size_t>(i);
      std::copy(found[b].corners.begin(), found[b].corners.end(),
                out.corners.begin() + static_cast<std::ptrdiff_t>(first_corners[b]));
      const glm::ivec3 low = place_of(b) * kBlockBricks;
      auto cell = static_cast<std::uint32_t>(first_corners[b]);
      for (const auto [place, cells] : found[b].bricks) {
        const glm::ivec3 at = low + glm::ivec3(place % kBlockBricks, place / kBlockBricks % kBlockBricks,
                                               place / (kBlockBricks * kBlockBricks));
        const std::uint32_t both = SurfaceBricks::kSurface | std::uint32_t{cells} << SurfaceBricks::kCellBits;
        constexpr std::uint32_t kLow = (1u << SurfaceBricks::kCellBits) - 1;
        out.bricks[out.index_of(at)] = {both | (cell & kLow), both | cell >> SurfaceBricks::kCellBits};
        cell += static_cast<std::uint32_t>(std::popcount(cells));
      }
      found[b] = {};
    });
    return {};
  }

  std::span<const glm::vec3> positions_;
  std::span<const Triangle> triangles_;
  Progress& progress_;
  glm::vec3 origin_{0.0f};
  glm::ivec3 blocks_{0};
};

}  // namespace

Result<SurfaceBricks> SurfaceBricks::build(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                                           Progress& progress) try {
  return Builder(positions, triangles, progress).run();
} catch (const std::bad_alloc&) {
  return fail(ErrorKind::kTryAgain,
              "occlusion: not enough memory for the cells of {} triangles: close programs or use a "
              "coarser volume",
              triangles.size());
}

}  // namespace dubsar
