#include "core/relief/occlusion/ahead_distances.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::uint8_t kMost = SurfaceBricks::kMostAhead;
constexpr int kSlab = 4 * SurfaceBricks::kMostAhead;  // slices that a thread does, behind kMostAhead others

/// A bit a brick: whether surface passes it. Rows begin with a word.
class Passed {
 public:
  explicit Passed(const SurfaceBricks& bricks)
      : size_(bricks.size()),
        words_((static_cast<std::size_t>(size_.x) + 63) / 64),
        bits_(words_ * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z)) {
    parallel_for(std::int64_t{size_.y} * size_.z, 64, [&](std::int64_t line) {
      const int y = static_cast<int>(line % size_.y), z = static_cast<int>(line / size_.y);
      std::uint64_t* bits = bits_.data() + words_ * static_cast<std::size_t>(line);
      for (int x = 0; x < size_.x; ++x)
        if (bricks.bricks[bricks.index_of({x, y, z})][0] & SurfaceBricks::kSurface)
          bits[x / 64] |= std::uint64_t{1} << x % 64;
    });
  }
  const std::uint64_t* row(int y, int z) const {
    return bits_.data() +
           words_ * (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(y));
  }

 private:
  glm::ivec3 size_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};
bool bit(const std::uint64_t* row, std::size_t x) { return (row[x / 64] >> x % 64 & 1) != 0; }

/// The four octants that rise, or fall, with z. The edge of the largest empty cube that begins with a brick is one more
/// than the least of its seven neighbours that way (as of the largest empty square in a matrix): slices are done from
/// the far end, and so are rows and bricks.
class Half {
 public:
  Half(SurfaceBricks& bricks, const Passed& passed, bool falling)
      : bricks_(bricks),
        passed_(passed),
        size_(bricks.size()),
        falling_(falling),
        row_(static_cast<std::size_t>(size_.x) + 1),
        least_(row_) {
    // One more row and one more number a row, all kMost, stand for what lies beyond the grid.
    for (auto* planes : {&now_, &behind_})
      planes->fill(std::vector<std::uint8_t>(row_ * (static_cast<std::size_t>(size_.y) + 1), kMost));
  }

  /// Slices [first, last) of the way, the last of which comes first; those from `kept` on are only looked at.
  void run(int first, int kept, int last) {
    for (int w = last - 1; w >= first; --w) {
      const int z = falling_ ? size_.z - 1 - w : w;
      std::swap(now_, behind_);
      for (unsigned octant = 0; octant < 4; ++octant)
        for (int v = size_.y - 1; v >= 0; --v) fill_row(octant, v, z);
      if (w < kept) keep(z);
    }
  }

 private:
  void fill_row(unsigned octant, int v, int z) {
    std::uint8_t* now = now_[octant].data() + row_ * static_cast<std::size_t>(v);
    const std::uint8_t* side = now + row_;
    const std::uint8_t* below = behind_[octant].data() + row_ * static_cast<std::size_t>(v);
    const std::uint8_t* corner = below + row_;
    for (std::size_t i = 0; i < row_; ++i) least_[i] = std::min(std::min(side[i], below[i]), corner[i]);
    const std::uint64_t* passed = passed_.row(octant & 2 ? size_.y - 1 - v : v, z);
    const std::size_t count = row_ - 1;
    std::uint8_t ahead = kMost;
    for (std::size_t u = count; u-- > 0;) {
      ahead = std::min({ahead, least_[u + 1], least_[u]});
      ahead = std::min(static_cast<std::uint8_t>(ahead + 1), kMost);
      if (bit(passed, octant & 1 ? count - 1 - u : u)) ahead = 0;
      now[u] = ahead;
    }
  }

  void keep(int z) {
    const std::size_t count = row_ - 1;
    for (int y = 0; y < size_.y; ++y) {
      const std::size_t up = row_ * static_cast<std::size_t>(y),
                        down = row_ * static_cast<std::size_t>(size_.y - 1 - y);
      const std::uint64_t* passed = passed_.row(y, z);
      SurfaceBricks::Brick* line = bricks_.bricks.data() + bricks_.index_of({0, y, z});
      for (std::size_t x = 0; x < count; ++x) {
        if (bit(passed, x)) continue;
        const std::uint32_t word = now_[0][up + x] | std::uint32_t{now_[1][up + count - 1 - x]} << 8 |
                                   std::uint32_t{now_[2][down + x]} << 16 |
                                   std::uint32_t{now_[3][down + count - 1 - x]} << 24;
        line[8 * (x >> 1) + (x & 1)][falling_ ? 1 : 0] = word;
      }
    }
  }

  SurfaceBricks& bricks_;
  const Passed& passed_;
  glm::ivec3 size_;
  bool falling_;
  std::size_t row_;
  std::vector<std::uint8_t> least_;
  std::array<std::vector<std::uint8_t>, 4> now_, behind_;  ///< rows and numbers in the order of each octant
};

}  // namespace

bool measure_ahead(SurfaceBricks& bricks, Progress& progress) {
  const Passed passed(bricks);
  const int slices = bricks.size().z, slabs = (slices + kSlab - 1) / kSlab;
  parallel_for(2 * slabs, 1, [&](std::int64_t task) {
    if (progress.cancelled()) return;
    const int first = static_cast<int>(task / 2) * kSlab, kept = std::min(first + kSlab, slices);
    Half(bricks, passed, task % 2 != 0).run(first, kept, std::min(kept + kMost, slices));
  });
  return !progress.cancelled();
}

}  // namespace dubsar
