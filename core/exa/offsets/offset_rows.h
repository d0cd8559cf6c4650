#pragma once
// The edges of a row one after the other, each with the distribution of its offset (docs/exa.md, "Offsets"). Nearly all
// of it is worked out for the whole row at once: only the two edges before an edge are not known before the row is
// begun.

#include <array>
#include <cstdint>
#include <span>

#include "core/exa/offsets/offset_model.h"

namespace dubsar {

/// The two edges before an edge in its row.
class OffsetsBefore {
 public:
  /// Does one of them cross beside the edge from x, in the same direction? Whether is known early, so that a wrong
  /// guess costs a processor little. `near` must be 0.
  bool near(int x, bool own, OffsetNear& near) const noexcept {
    const bool one = x - last_.x == 1 && last_.own == own, two = x - last_.x == 2 && last_.own == own,
               far = x - other_.x == 2 && other_.own == own;
    if (!(one | two | far)) return false;
    if (one) near[0] = {static_cast<std::int16_t>(last_.middle - 32), 64};
    if (two | far) near[1] = {static_cast<std::int16_t>((two ? last_.middle : other_.middle) - 32), 64};
    return true;
  }
  /// The same question alone.
  bool beside(int x, bool own) const noexcept {
    return (x - last_.x <= 2 && last_.own == own) || (x - other_.x == 2 && other_.own == own);
  }
  void note(int x, bool own, int middle) noexcept {
    other_ = last_;
    last_ = {x, middle, own};
  }

 private:
  struct Edge {
    int x = -10, middle = 0;
    bool own = false;
  };
  Edge last_, other_;
};

class OffsetRows {
 public:
  /// Both must outlive this.
  OffsetRows(const OffsetModel& model, OffsetWindow& window) : model_(model), window_(window) {}

  /// For every edge code(i, estimate) gives the middle of its offset in 1 / 64 of a grid step, 0..63.
  template <class Code>
  void row(int axis, int y, int z, std::span<const std::uint8_t> xs, const Code& code) {
    model_.begin(axis, window_.place(y, z), xs, row_);
    std::uint8_t* const known = window_.open_row(axis, y, z);
    OffsetsBefore before;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const bool own = row_.own[i] != 0;
      OffsetNear near{};
      const bool beside = axis != 0 && before.near(xs[i], own, near);
      const int middle = code(i, beside ? model_.finish(axis, row_.sums[i], near) : row_.estimates[i]);
      known[xs[i]] = static_cast<std::uint8_t>(1 + middle);
      before.note(xs[i], own, middle);
    }
  }
  /// The same for offsets of OffsetTable::kBits bits, decoded.
  void decode(int axis, int y, int z, std::span<const std::uint8_t> xs, RangeDecoder& in, std::uint16_t* offsets) {
    model_.begin(axis, window_.place(y, z), xs, row_);
    model_.decode(axis, xs, row_, in, window_.open_row(axis, y, z), offsets);
  }

 private:
  const OffsetModel& model_;
  OffsetWindow& window_;
  OffsetRow row_;
};

}  // namespace dubsar
