#pragma once
// The labels of one brick of clay, coded point by point (docs/exa.md, "Labels"). `Coder` says what a bit is:
//   bool bit(AdaptiveBit& model, bool value)      a bit whose probability is learnt
//   bool bit(std::uint32_t p, bool value)         one of probability p / 65536

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exa/coding/bit_mixer.h"
#include "core/exa/coding/range_coder.h"

namespace dubsar {

/// Rows of the points of a brick, three words each, in order z, y: clay, and clay of the envelope.
struct LabelRows {
  static constexpr std::size_t kWords = 3;
  std::array<int, 3> points{};  ///< of the brick, at most 129 along each axis
  std::vector<std::array<std::uint64_t, kWords>> clay, envelope;
  std::size_t row(int y, int z) const noexcept {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(points[1]) + static_cast<std::size_t>(y);
  }
};

class LabelBrick {
 public:
  explicit LabelBrick(LabelRows& rows) : rows_(rows) {
    for (std::size_t a = 0; a < 3; ++a) tiles_[a] = (rows.points[a] + kTile - 1) / kTile;
    kinds_.assign(static_cast<std::size_t>(tiles_[0] * tiles_[1] * tiles_[2]), kNoClay);
  }

  /// Codes the brick, or fills rows.envelope. `room(points)`: may so many more be coded? If not, the rest is left.
  template <class Coder, class Room>
  bool code(Coder& coder, const Room& room) {
    std::uint64_t open = 0;
    each_tile([&](int tx, int ty, int tz) {
      const Clay clay = clay_of(tx, ty, tz);
      if (clay.points == 0) return;
      const std::size_t context =
          static_cast<std::size_t>(16 * kind(tx - 1, ty, tz) + 4 * kind(tx, ty - 1, tz) + kind(tx, ty, tz - 1));
      std::uint8_t& found = kinds_[tile(tx, ty, tz)];
      if (coder.bit(mixed_[context], clay.envelope != 0 && clay.envelope != clay.points)) {
        found = kMixed;
        open += static_cast<std::uint64_t>(clay.points);
      } else {
        found = coder.bit(whose_[context], clay.envelope != 0) ? kEnvelope : kTablet;
        if (!Coder::kWrites && found == kEnvelope) fill(tx, ty, tz);
      }
    });
    if (open == 0) return true;
    if (!room(open)) return false;
    code_points(coder);
    return true;
  }

 private:
  static constexpr int kTile = 4, kBorder = 3;
  enum Kind : std::uint8_t { kNoClay, kTablet, kEnvelope, kMixed };
  enum State : std::uint8_t { kUnknown, kIsTablet, kIsEnvelope, kAir };  // kIsTablet = kTablet and so on
  static constexpr std::size_t kInputs = 6, kSets = 27;

  struct Clay {
    int points = 0, envelope = 0;
  };
  template <class Visit>
  void each_tile(const Visit& visit) const {
    for (int tz = 0; tz < tiles_[2]; ++tz)
      for (int ty = 0; ty < tiles_[1]; ++ty)
        for (int tx = 0; tx < tiles_[0]; ++tx) visit(tx, ty, tz);
  }
  template <class Visit>
  void each_row(int ty, int tz, const Visit& visit) const {
    for (int z = kTile * tz; z < std::min(kTile * (tz + 1), rows_.points[2]); ++z)
      for (int y = kTile * ty; y < std::min(kTile * (ty + 1), rows_.points[1]); ++y) visit(rows_.row(y, z));
  }
  Clay clay_of(int tx, int ty, int tz) const {
    Clay clay;
    const auto w = static_cast<std::size_t>(tx / 16);
    const int shift = tx % 16 * kTile;
    each_row(ty, tz, [&](std::size_t row) {
      clay.points += std::popcount(rows_.clay[row][w] >> shift & 15u);
      clay.envelope += std::popcount(rows_.envelope[row][w] >> shift & 15u);
    });
    return clay;
  }
  void fill(int tx, int ty, int tz) {
    const auto w = static_cast<std::size_t>(tx / 16);
    each_row(ty, tz, [&](std::size_t row) {
      rows_.envelope[row][w] |= rows_.clay[row][w] & std::uint64_t{15} << tx % 16 * kTile;
    });
  }
  std::size_t tile(int tx, int ty, int tz) const {
    return static_cast<std::size_t>((tz * tiles_[1] + ty) * tiles_[0] + tx);
  }
  int kind(int tx, int ty, int tz) const { return tx < 0 || ty < 0 || tz < 0 ? 0 : kinds_[tile(tx, ty, tz)]; }

  /// States of all points with a border of unknown ones; those of mixed tiles are not known yet.
  void find_states() {
    for (std::size_t a = 0; a < 3; ++a) size_[a] = rows_.points[a] + 2 * kBorder;
    states_.assign(
        static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]),
        kUnknown);
    for (int z = 0; z < rows_.points[2]; ++z)
      for (int y = 0; y < rows_.points[1]; ++y) {
        std::uint8_t* const to = states_.data() + place(0, y, z);
        const auto& clay = rows_.clay[rows_.row(y, z)];
        const std::uint8_t* const kinds = kinds_.data() + tile(0, y / kTile, z / kTile);
        for (int x = 0; x < rows_.points[0]; ++x) {
          const bool is_clay = clay[static_cast<std::size_t>(x / 64)] >> (x % 64) & 1u;
          const std::uint8_t kind = kinds[x / kTile];
          to[x] = !is_clay ? std::uint8_t{kAir} : kind == kMixed ? std::uint8_t{kUnknown} : kind;
        }
      }
  }
  std::ptrdiff_t place(int x, int y, int z) const {
    return (std::ptrdiff_t{z + kBorder} * size_[1] + y + kBorder) * size_[0] + x + kBorder;
  }

  template <class Coder>
  void code_points(Coder& coder) {
    find_states();
    for (int z = 0; z < rows_.points[2]; ++z)
      for (int y = 0; y < rows_.points[1]; ++y) {
        const std::size_t row = rows_.row(y, z);
        const std::uint8_t* const kinds = kinds_.data() + tile(0, y / kTile, z / kTile);
        for (int tx = 0; tx < tiles_[0]; ++tx) {
          if (kinds[tx] != kMixed) continue;
          const auto w = static_cast<std::size_t>(tx / 16);
          for (std::uint64_t clay = rows_.clay[row][w] & std::uint64_t{15} << tx % 16 * kTile; clay != 0;
               clay &= clay - 1) {
            const int bit = std::countr_zero(clay);
            std::uint8_t* const at = states_.data() + place(static_cast<int>(64 * w) + bit, y, z);
            const bool envelope = code_point(coder, at, (rows_.envelope[row][w] >> bit & 1u) != 0);
            *at = envelope ? kIsEnvelope : kIsTablet;
            if (!Coder::kWrites && envelope) rows_.envelope[row][w] |= std::uint64_t{1} << bit;
          }
        }
      }
  }

  template <class Coder>
  bool code_point(Coder& coder, const std::uint8_t* at, bool value) {
    const std::ptrdiff_t sy = size_[0], sz = std::ptrdiff_t{size_[0]} * size_[1];
    // 0 not clay or not known, 1 tablet, 2 envelope.
    const auto clay = [&](std::ptrdiff_t there) {
      const unsigned s = at[there];
      return s == kAir ? 0u : s;
    };
    const auto code_of = [&](std::initializer_list<std::ptrdiff_t> places) {
      unsigned code = 0;
      for (const std::ptrdiff_t p : places) code = 3 * code + clay(p);
      return static_cast<std::size_t>(code);
    };
    std::array<AdaptiveBit*, kInputs> models;
    // The six beside it, those behind it as far as they are air or in a tile of one clay.
    models[0] = &beside_[static_cast<std::size_t>(at[-1]) | static_cast<std::size_t>(at[-sy]) << 2 |
                         static_cast<std::size_t>(at[-sz]) << 4 | static_cast<std::size_t>(at[1]) << 6 |
                         static_cast<std::size_t>(at[sy]) << 8 | static_cast<std::size_t>(at[sz]) << 10];
    models[1] = &near_[code_of({-1, -sy, -sz, -1 - sy, 1 - sy, -1 - sz, 1 - sz, -sy - sz, sy - sz})];
    models[2] = &far_[code_of({-1, -2, -sy, -2 * sy, -sz, -2 * sz, -1 - sy - sz, 1 + sy - sz, 2 - sz})];
    models[3] = &lines_[code_of({-1, -2, -3, -sy, -2 * sy, -3 * sy, -sz, -2 * sz, -3 * sz})];
    int sum = 0, known = 0;
    const auto add = [&](std::ptrdiff_t p) {
      const unsigned s = clay(p);
      sum += s == 0 ? 0 : s == 2 ? 1 : -1;
      known += s != 0;
    };
    for (std::ptrdiff_t dy = -1; dy <= 1; ++dy)
      for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
        add(dy * sy + dx - sz);
        add(dy * sy + dx + sz);
      }
    for (const std::ptrdiff_t p : {-1 - sy, -sy, 1 - sy, std::ptrdiff_t{-1}, std::ptrdiff_t{1}, sy - 1, sy, sy + 1,
                                   std::ptrdiff_t{-2}, -2 * sy, -2 * sz})
      add(p);
    models[4] = &sums_[static_cast<std::size_t>(sum + 32) * 8 + static_cast<std::size_t>(std::min(7, known / 4))];
    const auto air = [&](std::ptrdiff_t p) { return static_cast<std::size_t>(at[p] == kAir); };
    const std::size_t behind = code_of({-1, -sy, -sz});
    models[5] = &airs_[behind * 512 + (air(1) | air(sy) << 1 | air(sz) << 2 | air(-1) << 3 | air(-sy) << 4 |
                                       air(-sz) << 5 | air(2) << 6 | air(2 * sy) << 7 | air(2 * sz) << 8)];
    std::array<std::uint32_t, kInputs> p;
    for (std::size_t i = 0; i < kInputs; ++i) p[i] = models[i]->probability();
    const bool envelope = coder.bit(mixer_.predict(behind, p), value);
    mixer_.learn(envelope);
    for (AdaptiveBit* const model : models) model->learn(envelope);
    return envelope;
  }

  LabelRows& rows_;
  std::array<int, 3> tiles_{}, size_{};
  std::vector<std::uint8_t> kinds_, states_;
  std::array<AdaptiveBit, 64> mixed_, whose_;
  std::vector<AdaptiveBit> beside_{4096}, near_{19683}, far_{19683}, lines_{19683}, sums_{65 * 8}, airs_{27 * 512};
  BitMixer<kInputs, kSets> mixer_;
};

}  // namespace dubsar
