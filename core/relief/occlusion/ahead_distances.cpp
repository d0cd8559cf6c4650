#include "core/relief/occlusion/ahead_distances.h"

#include <algorithm>
#include <array>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::uint8_t kMost = SurfaceBricks::kMostAhead;
constexpr int kSlab = 4 * SurfaceBricks::kMostAhead;  // slices that a thread does, behind kMostAhead others

/// A byte a brick: all bits where surface passes it.
class Passed {
 public:
  explicit Passed(const SurfaceBricks& bricks)
      : size_(bricks.size()),
        bytes_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
               static_cast<std::size_t>(size_.z)) {
    parallel_for(std::int64_t{size_.y} * size_.z, 64, [&](std::int64_t line) {
      const int y = static_cast<int>(line % size_.y), z = static_cast<int>(line / size_.y);
      std::uint8_t* bytes = bytes_.data() + static_cast<std::size_t>(line) * static_cast<std::size_t>(size_.x);
      const SurfaceBricks::Brick* from = bricks.bricks.data() + bricks.index_of({0, y, z});
      for (std::size_t x = 0; x < static_cast<std::size_t>(size_.x); ++x)
        bytes[x] = from[8 * (x >> 1) + (x & 1)][0] & SurfaceBricks::kSurface ? 0xff : 0;
    });
  }
  const std::uint8_t* row(int y, int z) const {
    return bytes_.data() +
           (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x);
  }

 private:
  glm::ivec3 size_;
  std::vector<std::uint8_t> bytes_;
};

// Rows of bytes that share none, for vectors.

void least_of(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, std::size_t count,
              std::uint8_t* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t less = a[i] < b[i] ? a[i] : b[i];
    to[i] = less < c[i] ? less : c[i];
  }
}

/// Than the lesser of `from` and what stands `kWay` numbers on in it, at most kMost; 0 where surface passes.
template <int kWay>
void one_more(const std::uint8_t* from, const std::uint8_t* passed, std::size_t count, std::uint8_t* __restrict to) {
  constexpr std::uint8_t kLast = kMost - 1;
  const std::uint8_t* on = from + kWay;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t less = from[i] < on[i] ? from[i] : on[i], most = less < kLast ? less : kLast;
    to[i] = static_cast<std::uint8_t>((most + 1) & ~passed[i]);
  }
}

/// The lesser of `from`, and what stands `kWay` numbers on in it and that many.
template <int kWay>
void look_on(const std::uint8_t* from, std::size_t count, std::uint8_t* __restrict to) {
  constexpr std::uint8_t kFar = kWay < 0 ? -kWay : kWay;
  const std::uint8_t* on = from + kWay;
  for (std::size_t i = 0; i < count; ++i) {
    const auto there = static_cast<std::uint8_t>(on[i] + kFar);
    to[i] = from[i] < there ? from[i] : there;
  }
}

/// The four octants that rise, or fall, with z. The edge of the largest empty cube that begins with a brick is one more
/// than the least of its seven neighbours that way (as of the largest empty square in a matrix): slices are done from
/// the far end, and so are rows.
class Half {
 public:
  Half(SurfaceBricks& bricks, const Passed& passed, bool falling)
      : bricks_(bricks),
        passed_(passed),
        size_(bricks.size()),
        falling_(falling),
        count_(static_cast<std::size_t>(size_.x)),
        row_(count_ + 2 * kRoom),
        least_(row_, kMost),
        work_(row_, kMost) {
    for (auto* planes : {&now_, &behind_})
      planes->fill(std::vector<std::uint8_t>(row_ * (static_cast<std::size_t>(size_.y) + 2), kMost));
  }

  /// Slices [first, last) of the way, the last of which comes first; those from `kept` on are only looked at.
  void run(int first, int kept, int last) {
    for (int w = last - 1; w >= first; --w) {
      const int z = falling_ ? size_.z - 1 - w : w;
      std::swap(now_, behind_);
      for (int v = size_.y - 1; v >= 0; --v) {
        fill_row<1>(0, v, v + 1, z);
        fill_row<-1>(1, v, v + 1, z);
        const int y = size_.y - 1 - v;
        fill_row<1>(2, y, y - 1, z);
        fill_row<-1>(3, y, y - 1, z);
      }
      if (w < kept) keep(z);
    }
  }

 private:
  /// Numbers beside each row that stand for what lies beyond the grid, all kMost; a row of them lies beside each plane.
  static constexpr std::size_t kRoom = 16;

  std::size_t place(int y) const { return row_ * static_cast<std::size_t>(y + 1) + kRoom; }

  /// Row `y`, where `before` is the one that lies that way.
  template <int kWay>
  void fill_row(std::size_t octant, int y, int before, int z) {
    static_assert(kMost == 32);
    std::uint8_t *now = now_[octant].data() + place(y), *least = least_.data() + kRoom, *work = work_.data() + kRoom;
    least_of(now_[octant].data() + place(before), behind_[octant].data() + place(y),
             behind_[octant].data() + place(before), count_, least);
    one_more<kWay>(least, passed_.row(y, z), count_, now);
    // Bricks of a row depend on the next one that way, too: one more for each step, so that the least over 1, 2, 4, 8
    // and 16 steps on is that over all up to kMost.
    look_on<kWay>(now, count_, work);
    look_on<2 * kWay>(work, count_, now);
    look_on<4 * kWay>(now, count_, work);
    look_on<8 * kWay>(work, count_, now);
    look_on<16 * kWay>(now, count_, work);
    std::copy(work, work + count_, now);
  }

  void keep(int z) {
    for (int y = 0; y < size_.y; ++y) {
      const std::size_t first = place(y);
      const std::uint8_t* passed = passed_.row(y, z);
      SurfaceBricks::Brick* line = bricks_.bricks.data() + bricks_.index_of({0, y, z});
      for (std::size_t x = 0; x < count_; ++x) {
        if (passed[x] != 0) continue;
        const std::uint32_t word = now_[0][first + x] | std::uint32_t{now_[1][first + x]} << 8 |
                                   std::uint32_t{now_[2][first + x]} << 16 | std::uint32_t{now_[3][first + x]} << 24;
        line[8 * (x >> 1) + (x & 1)][falling_ ? 1 : 0] = word;
      }
    }
  }

  SurfaceBricks& bricks_;
  const Passed& passed_;
  glm::ivec3 size_;
  bool falling_;
  std::size_t count_, row_;
  std::vector<std::uint8_t> least_, work_;                 ///< a row each
  std::array<std::vector<std::uint8_t>, 4> now_, behind_;  ///< planes, by octant
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
