#pragma once
// Where does an edge cross the surface, given its surroundings? A small network per axis with fixed integer weights
// gives mean and spread of a logistic distribution (docs/exa.md, "Offsets"). Fitted as those of the signs, scan on
// crossings of 4 bits, smooth on settled ones of 4 and 5 bits.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exa/coding/probability.h"
#include "core/exa/coding/range_coder.h"
#include "core/exa/offsets/offset_layout.h"
#include "core/exa/offsets/offset_window.h"

namespace dubsar {

inline constexpr std::size_t kOffsetModels = 2;  ///< 0: crossings of a scan, 1: of a smoothed surface
inline constexpr std::size_t kOffsetUnits = 24;
inline constexpr int kModelledBits = 6;  ///< of an offset; the lower ones are noise

/// Mean in 1 / 128 grid step from the middle of the edge, -128..127; spread 0..31.
struct OffsetEstimate {
  int mean = 0, spread = 0;
};

/// Probabilities of the 2^bits symbols of one edge, as intervals of 65536.
class OffsetDistribution {
 public:
  OffsetDistribution(const OffsetEstimate& estimate, int bits) noexcept : estimate_(estimate), bits_(bits) {}
  /// Start of the interval of symbol k, 0..2^bits; rises by 32 at least with each k.
  std::uint32_t start(std::uint32_t k) const noexcept;
  /// The symbol whose interval holds `place`, 0..65535.
  std::uint32_t find(std::uint32_t place) const noexcept {
    std::uint32_t low = 0;
    for (std::uint32_t step = 1u << (bits_ - 1); step != 0; step >>= 1)
      if (start(low + step) <= place) low += step;
    return low;
  }

 private:
  OffsetEstimate estimate_;
  int bits_;
};

/// The same for 4 bits, all of them in a table.
class OffsetTable {
 public:
  static constexpr int kBits = 4;
  using Starts = std::array<std::uint16_t, 16>;
  static const OffsetTable& instance();
  OffsetTable();
  const Starts& starts(const OffsetEstimate& e) const noexcept {
    return rows_[static_cast<std::size_t>(e.spread) * 256 + static_cast<std::size_t>(e.mean + 128)];
  }
  static std::uint32_t end(const Starts& starts, std::uint32_t symbol) noexcept {
    return symbol == 15 ? 65536u : starts[symbol + 1];
  }
  static std::uint32_t find(const Starts& starts, std::uint32_t place) noexcept {
    const auto sought = static_cast<std::uint16_t>(place);
    std::uint16_t below = 0;
    for (const std::uint16_t start : starts) below = static_cast<std::uint16_t>(below + (start <= sought ? 1 : 0));
    return below - 1u;
  }

 private:
  std::vector<Starts> rows_;
};

/// The network of one axis. Its inputs are in the order of kOffsetLayouts.
struct alignas(64) OffsetNetwork {
  static constexpr std::size_t kPadded = 32;                       ///< units in whole vectors; the last ones are 0
  using Pairs = std::array<std::array<std::int16_t, 2>, kPadded>;  ///< weights of two inputs for all units
  /// Of the units, before they are clamped.
  struct alignas(64) Sums : std::array<std::int32_t, kPadded> {};
  std::array<Pairs, kMostOffsetInputs / 2> in{};
  std::array<Pairs, 2>
      near{};  ///< value and flag of the columns one and two steps before along the row; not for axis 0
  Sums bias{};
  std::array<Pairs, 2> out{};  ///< the second of a pair is 0
  std::array<std::int32_t, 2> out_bias{};
};

/// Value and flag of the columns one and two steps before an edge along its row.
using OffsetNear = std::array<std::array<std::int16_t, 2>, 2>;

/// A row of edges, as far as all of it is known before the first of them is coded.
struct OffsetRow {
  static constexpr std::size_t kMost = 129;
  std::array<OffsetNetwork::Sums, kMost> sums;
  std::array<OffsetEstimate, kMost> estimates;  ///< of those without an edge before beside them in the row
  std::array<std::uint8_t, kMost> own;          ///< signs of the points that the edges start at
};

class OffsetModel {
 public:
  static const OffsetModel& instance(std::size_t which);
  explicit OffsetModel(const std::int16_t* weights);
  /// `xs`: rising, at most OffsetRow::kMost.
  void begin(int axis, const OffsetPlace& place, std::span<const std::uint8_t> xs, OffsetRow& row) const noexcept;
  /// With the two edges before: value and 64 if one crosses beside this one, else two zeros.
  OffsetEstimate finish(int axis, const OffsetNetwork::Sums& sums, const OffsetNear& near) const noexcept;
  /// The offsets of a row that was begun, of OffsetTable::kBits bits; `known` as OffsetWindow::open_row().
  void decode(int axis, std::span<const std::uint8_t> xs, const OffsetRow& row, RangeDecoder& in, std::uint8_t* known,
              std::uint16_t* offsets) const noexcept;

 private:
  std::array<OffsetNetwork, 3> axes_;
};

}  // namespace dubsar
