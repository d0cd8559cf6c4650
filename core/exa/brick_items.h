#pragma once
// The active edges and ambiguous faces of one brick, row by row, and their numbers in canonical order.

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "core/exa/offset_window.h"
#include "core/extract/edge_index.h"

namespace dubsar {

class BrickItems {
 public:
  BrickItems(const SurfaceSamples& samples, const EdgeIndex& index, const std::array<std::int64_t, 3>& low)
      : samples_(samples), index_(index), low_(low), signs_(samples.signs, low) {}

  const BrickSigns& signs() const noexcept { return signs_; }

  /// Calls slice(z) before the rows of a slice, then row(axis, y, z, xs, number) for every row of active edges that
  /// start in the brick, in canonical order; number is that of the first. faces: face(number) for ambiguous faces.
  template <class Slice, class Row>
  void edges(const Slice& slice, const Row& row) const {
    std::array<std::uint8_t, 128> xs;
    for (int z = 0; z < owned(2); ++z) {
      slice(z);
      for (int y = 0; y < owned(1); ++y)
        for (int axis = 0; axis < 3; ++axis) {
          std::size_t count = 0;
          std::uint32_t first_number = 0;
          visit(y, z, axis, false, [&](int x, std::uint32_t number) {
            if (count == 0) first_number = number;
            xs[count++] = static_cast<std::uint8_t>(x);
          });
          if (count > 0) row(axis, y, z, std::span<const std::uint8_t>(xs.data(), count), first_number);
        }
    }
  }
  template <class Face>
  void faces(const Face& face) const {
    for (int z = 0; z < owned(2); ++z)
      for (int y = 0; y < owned(1); ++y)
        for (int axis = 0; axis < 3; ++axis) visit(y, z, axis, true, [&](int, std::uint32_t number) { face(number); });
  }

 private:
  int owned(std::size_t axis) const { return signs_.points()[axis] < 128 ? signs_.points()[axis] : 128; }

  /// Items among 64 points of four rows of words; next: the rows one point further.
  static std::uint64_t items(int axis, bool faces, const std::array<std::uint64_t, 4>& w,
                             const std::array<std::uint64_t, 4>& next) {
    const auto ambiguous = [](std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
      return (a ^ b) & (a ^ c) & ~(a ^ d);
    };
    if (!faces) return w[0] ^ (axis == 0 ? next[0] : w[static_cast<std::size_t>(axis)]);
    if (axis == 0) return ambiguous(w[0], w[1], w[2], w[3]);
    const std::size_t other = axis == 1 ? 2 : 1;
    return ambiguous(w[0], next[0], w[other], next[other]);
  }

  template <class Visit>
  void visit(int y, int z, int axis, bool faces, const Visit& visit_item) const {
    bool counted = false;
    std::uint32_t number = 0;
    for (int from = 0; from < owned(0); from += 64) {
      std::array<std::uint64_t, 4> w, next;
      for (int r = 0; r < 4; ++r) {
        const auto i = static_cast<std::size_t>(r);
        w[i] = signs_.word(y + r % 2, z + r / 2, from);
        next[i] = w[i] >> 1 | signs_.word(y + r % 2, z + r / 2, from + 64) << 63;
      }
      std::uint64_t found = items(axis, faces, w, next);
      if (owned(0) - from < 64) found &= (std::uint64_t{1} << (owned(0) - from)) - 1;
      if (found == 0) continue;
      if (!counted) number = first(y, z, axis, faces);
      counted = true;
      for (; found != 0; found &= found - 1) visit_item(from + std::countr_zero(found), number++);
    }
  }

  /// Number of the first item of a row at or behind the start of the brick.
  std::uint32_t first(int y, int z, int axis, bool faces) const {
    const std::int64_t gy = low_[1] + y, gz = low_[2] + z;
    const BitVolume& signs = samples_.signs;
    const RowStarts& starts = index_.starts(gy, gz);
    std::uint32_t number = (faces ? starts.faces : starts.edges)[static_cast<std::size_t>(axis)];
    const std::int64_t words = low_[0] / 64;
    for (std::int64_t i = 0; i < words; ++i) {
      std::array<std::uint64_t, 4> w{}, next{};
      for (int r = 0; r < 4; ++r) {
        const std::int64_t ry = gy + r % 2, rz = gz + r / 2;
        const std::uint64_t* row = signs.row(ry < signs.dims().y ? ry : gy, rz < signs.dims().z ? rz : gz);
        w[static_cast<std::size_t>(r)] = row[i];
        next[static_cast<std::size_t>(r)] = row[i] >> 1 | row[i + 1] << 63;
      }
      number += static_cast<std::uint32_t>(std::popcount(items(axis, faces, w, next)));
    }
    return number;
  }

  const SurfaceSamples& samples_;
  const EdgeIndex& index_;
  std::array<std::int64_t, 3> low_;
  BrickSigns signs_;
};

}  // namespace dubsar
