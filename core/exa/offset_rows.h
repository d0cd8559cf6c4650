#pragma once
// The edges of a row one after the other, each with the distribution of its offset (docs/exa.md, "Offsets"). Nearly all
// of it is worked out for the whole row at once: only the two edges before an edge are not known before the row is
// begun.

#include <array>
#include <cstdint>
#include <span>

#include "core/exa/offset_model.h"

namespace dubsar {

class OffsetRows {
 public:
  /// Both must outlive this.
  OffsetRows(const OffsetModel& model, OffsetWindow& window, const BrickSigns& signs)
      : model_(model), window_(window), signs_(signs) {}

  /// For every edge code(i, estimate) gives the middle of its offset, as OffsetWindow::store() takes it.
  template <class Code>
  void row(int axis, int y, int z, std::span<const std::uint8_t> xs, const Code& code) {
    for (std::size_t i = 0; i < xs.size(); ++i) window_.inputs(axis, xs[i], y, z, inputs_[i]);
    model_.begin(axis, {inputs_.data(), xs.size()}, sums_.data());
    std::array<Before, 2> before{};
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const int x = xs[i];
      OffsetNear near{};
      const bool own = axis != 0 && signs_.get(x, y, z);
      if (axis != 0) {
        // No branches: they would be guessed wrong.
        const auto mask = [&](const Before& b, int steps) {
          return -static_cast<int>((x - b.x == steps) & (b.sign == own));
        };
        const int one = mask(before[1], 1), last = mask(before[1], 2), other = mask(before[0], 2);
        near[0] = {static_cast<std::int16_t>((before[1].middle - 32) & one), static_cast<std::int16_t>(64 & one)};
        near[1] = {static_cast<std::int16_t>(((before[1].middle - 32) & last) | ((before[0].middle - 32) & other)),
                   static_cast<std::int16_t>(64 & (last | other))};
      }
      const int middle = code(i, model_.finish(axis, sums_[i], near));
      window_.store(axis, x, y, z, middle);
      before = {before[1], Before{x, middle, own}};
    }
  }

 private:
  struct Before {
    int x = -10, middle = 0;
    bool sign = false;
  };
  const OffsetModel& model_;
  OffsetWindow& window_;
  const BrickSigns& signs_;
  std::array<OffsetInputs, 128> inputs_;
  std::array<OffsetModel::Sums, 128> sums_;
};

}  // namespace dubsar
