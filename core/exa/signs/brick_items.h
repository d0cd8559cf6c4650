#pragma once
// The active edges and ambiguous faces of one brick, row by row, and their numbers in canonical order.

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "core/exa/offsets/offset_window.h"
#include "core/exa/signs/bit_spread.h"
#include "core/extract/edge_index.h"

namespace dubsar {

/// Of each axis.
using FarSides = std::array<bool, 3>;
inline constexpr FarSides kAllFarSides{true, true, true};

class BrickItems {
 public:
  /// `far_sides`: the last brick along an axis has the items of its far side, if it has 128 cells. They are nobody's in
  /// older files, and in a box (exa_partial.cpp) those of a brick that is not part of it.
  BrickItems(const SurfaceSamples& samples, const EdgeIndex& index, const std::array<std::int64_t, 3>& low,
             FarSides far_sides = kAllFarSides)
      : samples_(samples), index_(index), low_(low), far_sides_(far_sides), signs_(samples.signs, low) {}

  const BrickSigns& signs() const noexcept { return signs_; }

  /// Calls slice(z) before the rows of a slice, then row(axis, y, z, xs, number) for every row of active edges that
  /// start in the brick, in canonical order; number is that of the first. faces: face(number) for ambiguous faces.
  template <class Slice, class Row>
  void edges(const Slice& slice, const Row& row) const {
    std::array<std::uint8_t, kMostOwned> xs;
    for (int z = 0; z < owned(2); ++z) {
      slice(z);
      for (int y = 0; y < owned(1); ++y) {
        const RowEdges active = active_edges(y, z);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if ((active[axis][0] | active[axis][1] | active[axis][2]) == 0) continue;
          std::size_t count = 0;
          for (std::size_t w = 0; w < kOwnedWords; ++w)
            for (std::uint64_t rest = active[axis][w]; rest != 0; rest &= rest - 1)
              xs[count++] = static_cast<std::uint8_t>(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
          row(static_cast<int>(axis), y, z, std::span<const std::uint8_t>(xs.data(), count), first_edge(y, z, axis));
        }
      }
    }
  }
  template <class Face>
  void faces(const Face& face) const {
    for (int z = 0; z < owned(2); ++z)
      for (int y = 0; y < owned(1); ++y)
        for (int axis = 0; axis < 3; ++axis) visit_faces(y, z, axis, face);
  }

 private:
  static constexpr int kMostOwned = 129;
  static constexpr std::size_t kOwnedWords = 3;

  /// Points of the brick that are not of the next: the far side belongs to the last one along an axis.
  int owned(std::size_t axis) const {
    const Dims& d = samples_.signs.dims();
    const std::int64_t size = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
    const int points = signs_.points()[axis];
    return points < kMostOwned || (far_sides_[axis] && low_[axis] + points == size) ? points : kMostOwned - 1;
  }
  /// Signs from x on; 0 where nothing is asked beyond the brick.
  std::uint64_t word_behind(int y, int z, int from) const { return from <= 128 ? signs_.word(y, z, from) : 0; }

  /// Ambiguous faces among 64 points of four rows of words; next: the rows one point further.
  static std::uint64_t ambiguous(int axis, const std::array<std::uint64_t, 4>& w,
                                 const std::array<std::uint64_t, 4>& next) {
    const auto crossed = [](std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
      return (a ^ b) & (a ^ c) & ~(a ^ d);
    };
    if (axis == 0) return crossed(w[0], w[1], w[2], w[3]);
    const std::size_t other = axis == 1 ? 2 : 1;
    return crossed(w[0], next[0], w[other], next[other]);
  }

  /// By axis, a bit for each of 129 points that an active edge starts at.
  using RowEdges = std::array<std::array<std::uint64_t, kOwnedWords>, 3>;
  RowEdges active_edges(int y, int z) const {
    RowEdges active;
    for (int w = 0; w < static_cast<int>(kOwnedWords); ++w) {
      const int left = owned(0) - 64 * w;
      const std::uint64_t mask = left >= 64 ? ~std::uint64_t{0} : left <= 0 ? 0 : (std::uint64_t{1} << left) - 1;
      const std::uint64_t here = signs_.word(y, z, 64 * w);
      const auto i = static_cast<std::size_t>(w);
      active[0][i] = (here ^ (here >> 1 | word_behind(y, z, 64 * w + 64) << 63)) & mask;
      active[1][i] = (here ^ signs_.word(y + 1, z, 64 * w)) & mask;
      active[2][i] = (here ^ signs_.word(y, z + 1, 64 * w)) & mask;
    }
    return active;
  }

  template <class Face>
  void visit_faces(int y, int z, int axis, const Face& face) const {
    bool counted = false;
    std::uint32_t number = 0;
    for (int from = 0; from < owned(0); from += 64) {
      std::array<std::uint64_t, 4> w, next;
      for (int r = 0; r < 4; ++r) {
        const auto i = static_cast<std::size_t>(r);
        w[i] = signs_.word(y + r % 2, z + r / 2, from);
        next[i] = w[i] >> 1 | word_behind(y + r % 2, z + r / 2, from + 64) << 63;
      }
      std::uint64_t found = ambiguous(axis, w, next);
      if (owned(0) - from < 64) found &= (std::uint64_t{1} << (owned(0) - from)) - 1;
      if (found == 0) continue;
      if (!counted) number = first_face(y, z, axis);
      counted = true;
      for (; found != 0; found &= found - 1) face(number++);
    }
  }

  /// Number of the first active edge of a row at or behind the start of the brick; there is one.
  std::uint32_t first_edge(int y, int z, std::size_t axis) const {
    const std::int64_t gy = low_[1] + y, gz = low_[2] + z;
    const BitVolume& signs = samples_.signs;
    std::uint32_t number = index_.starts(gy, gz).edges[axis];
    if (low_[0] == 0) return number;
    const std::uint64_t* const row = signs.row(gy, gz);
    const std::uint64_t* const other = axis == 1 ? signs.row(gy + 1, gz) : axis == 2 ? signs.row(gy, gz + 1) : nullptr;
    for (std::int64_t i = 0; i < low_[0] / 64; ++i)
      number += count_ones_of(row[i] ^ (other ? other[i] : row[i] >> 1 | row[i + 1] << 63));
    return number;
  }
  /// The same for an ambiguous face.
  std::uint32_t first_face(int y, int z, int axis) const {
    const std::int64_t gy = low_[1] + y, gz = low_[2] + z;
    const BitVolume& signs = samples_.signs;
    std::uint32_t number = index_.starts(gy, gz).faces[static_cast<std::size_t>(axis)];
    for (std::int64_t i = 0; i < low_[0] / 64; ++i) {
      std::array<std::uint64_t, 4> w{}, next{};
      for (int r = 0; r < 4; ++r) {
        const std::int64_t ry = gy + r % 2, rz = gz + r / 2;
        const std::uint64_t* row = signs.row(ry < signs.dims().y ? ry : gy, rz < signs.dims().z ? rz : gz);
        w[static_cast<std::size_t>(r)] = row[i];
        next[static_cast<std::size_t>(r)] = row[i] >> 1 | row[i + 1] << 63;
      }
      number += count_ones_of(ambiguous(axis, w, next));
    }
    return number;
  }

  const SurfaceSamples& samples_;
  const EdgeIndex& index_;
  std::array<std::int64_t, 3> low_;
  FarSides far_sides_;
  BrickSigns signs_;
};

}  // namespace dubsar
