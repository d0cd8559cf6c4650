#include "core/exa/offsets/offset_kernels.h"

#include <algorithm>
#include <cstring>

#include "core/exa/offsets/offset_rows.h"
#include "core/exa/offsets/offset_tables.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/exa/offsets/offset_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/exa/offsets/offset_units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
namespace tables = offset_tables;

template <class T>
HWY_INLINE T load_as(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Sixteen bytes, for columns or sides.
#if HWY_TARGET == HWY_SCALAR
using Bytes = tables::Lanes;
Bytes load(const std::uint8_t* from) { return load_as<Bytes>(from); }
Bytes both(std::uint64_t low, std::uint64_t high) {
  Bytes bytes;
  std::memcpy(bytes.data(), &low, 8);
  std::memcpy(bytes.data() + 8, &high, 8);
  return bytes;
}
template <class Of>
Bytes lanes(const Of& of) {
  Bytes bytes;
  for (std::size_t i = 0; i < 16; ++i) bytes[i] = static_cast<std::uint8_t>(of(i));
  return bytes;
}
Bytes all(int value) {
  return lanes([&](std::size_t) { return value; });
}
Bytes either(const Bytes& a, const Bytes& b) {
  return lanes([&](std::size_t i) { return a[i] | b[i]; });
}
Bytes common(const Bytes& a, const Bytes& b) {
  return lanes([&](std::size_t i) { return a[i] & b[i]; });
}
Bytes without(const Bytes& mask, const Bytes& a) {
  return lanes([&](std::size_t i) { return a[i] & ~mask[i]; });
}
Bytes apart(const Bytes& a, const Bytes& b) {
  return lanes([&](std::size_t i) { return a[i] ^ b[i]; });
}
Bytes plus(const Bytes& a, const Bytes& b) {
  return lanes([&](std::size_t i) { return a[i] + b[i]; });
}
Bytes any(const Bytes& a) {
  return lanes([&](std::size_t i) { return a[i] != 0 ? 255 : 0; });
}
Bytes picked(const Bytes& from, const Bytes& at) {
  return lanes([&](std::size_t i) { return at[i] & 0x80 ? 0 : from[at[i] & 15]; });
}
template <std::size_t kCount>
void widen(const Bytes& a, std::int16_t* to) {
  for (std::size_t i = 0; i < kCount; ++i) to[i] = static_cast<std::int8_t>(a[i]);
}
#else
using D8 = hn::FixedTag<std::uint8_t, 16>;
using Bytes = hn::Vec<D8>;
HWY_INLINE Bytes load(const std::uint8_t* from) { return hn::LoadU(D8(), from); }
HWY_INLINE Bytes both(std::uint64_t low, std::uint64_t high) {
  const hn::Repartition<std::uint64_t, D8> d64;
  return hn::BitCast(D8(), hn::InterleaveLower(d64, hn::Set(d64, low), hn::Set(d64, high)));
}
HWY_INLINE Bytes all(int value) { return hn::Set(D8(), static_cast<std::uint8_t>(value)); }
HWY_INLINE Bytes either(Bytes a, Bytes b) { return hn::Or(a, b); }
HWY_INLINE Bytes common(Bytes a, Bytes b) { return hn::And(a, b); }
HWY_INLINE Bytes without(Bytes mask, Bytes a) { return hn::AndNot(mask, a); }
HWY_INLINE Bytes apart(Bytes a, Bytes b) { return hn::Xor(a, b); }
HWY_INLINE Bytes plus(Bytes a, Bytes b) { return hn::Add(a, b); }
HWY_INLINE Bytes any(Bytes a) { return hn::VecFromMask(D8(), hn::Ne(a, hn::Zero(D8()))); }
HWY_INLINE Bytes picked(Bytes from, Bytes at) { return hn::TableLookupBytesOr0(from, at); }
/// The first 8 or all 16 lanes, as signed numbers.
template <std::size_t kCount>
HWY_INLINE void widen(Bytes a, std::int16_t* to) {
  const hn::FixedTag<std::int16_t, 8> d16;
  const hn::Rebind<std::int8_t, decltype(d16)> half;
  const hn::Repartition<std::int8_t, D8> whole;
  const auto signs = hn::BitCast(whole, a);
  hn::StoreU(hn::PromoteTo(d16, hn::LowerHalf(half, signs)), d16, to);
  if constexpr (kCount == 16) hn::StoreU(hn::PromoteTo(d16, hn::UpperHalf(half, signs)), d16, to + 8);
}
#endif
HWY_INLINE Bytes lanes_of(const tables::Lanes& table) { return load(table.data()); }

constexpr std::size_t kSpread = 192;
/// For the five rows two before .. two behind a row of edges along y or z: of each point those of -1, 0, 1, 2 along the
/// edges that are inside, as bits 0..3 of a byte; x = 0 stands at 8.
struct SpreadRows {
  alignas(64) std::uint8_t row[5][kSpread];
};

/// Fills kWidth points from a multiple of kWidth on.
#if HWY_TARGET == HWY_SCALAR
constexpr std::size_t kWidth = 16;
#else
using DSpread = hn::CappedTag<std::uint8_t, 32>;
constexpr std::size_t kWidth = hn::MaxLanes(DSpread());
#endif
template <int kAxis>
HWY_INLINE void spread(const OffsetPlace& place, std::size_t from, SpreadRows& rows) {
  const std::ptrdiff_t across = kAxis == 1 ? place.sign_plane : BrickSigns::kRowBytes,
                       along = kAxis == 1 ? BrickSigns::kRowBytes : place.sign_plane;
  for (int r = -2; r <= 2; ++r) {
    const unsigned char* bits = place.signs + r * across + from / 8;
    std::uint8_t* to = rows.row[r + 2] + from;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < kWidth; ++i) {
      unsigned pattern = 0;
      for (int k = -1; k <= 2; ++k)
        pattern |= (bits[k * along + static_cast<std::ptrdiff_t>(i / 8)] >> i % 8 & 1u) << (k + 1);
      to[i] = static_cast<std::uint8_t>(pattern);
    }
#else
    const DSpread d;
    const hn::Repartition<std::uint32_t, DSpread> d32;
    HWY_ALIGN static constexpr std::uint8_t kByte[32] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1,
                                                         2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3};
    HWY_ALIGN static constexpr std::uint8_t kBit[32] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128,
                                                        1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const auto byte = hn::Load(d, kByte), bit = hn::Load(d, kBit);
    auto pattern = hn::Zero(d);
    for (int k = -1; k <= 2; ++k) {
      const auto four = hn::BitCast(d, hn::Set(d32, load_as<std::uint32_t>(bits + k * along)));
      const auto set = hn::Eq(hn::And(hn::TableLookupBytes(four, byte), bit), bit);
      pattern = hn::Or(pattern, hn::IfThenElseZero(set, hn::Set(d, static_cast<std::uint8_t>(1 << (k + 1)))));
    }
    hn::Store(pattern, d, to);
#endif
  }
}

/// What is known of an edge: patterns of its columns, and offsets, as 1 + middle or 0, of columns and sides.
struct Found {
  Bytes patterns, columns, sides;
};

/// Columns across x: twelve rows of signs.
HWY_INLINE Found gather_x(const OffsetPlace& place, std::size_t x, Bytes turned) {
  const std::size_t from = x + 7;  // the bit of x - 1
  const unsigned char* const here = place.signs + (from >> 3);
  const unsigned shift = from & 7;
  const auto bits = [&](std::size_t c) HWY_ATTR -> std::uint64_t {
    const OffsetColumn& column = kOffsetLayouts[0].columns[c];
    return load_as<std::uint16_t>(here + column.v * place.sign_plane + column.u * BrickSigns::kRowBytes);
  };
  const auto four = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) HWY_ATTR {
    return (bits(a) | bits(b) << 16 | bits(c) << 32 | bits(d) << 48) >> shift & 0x000F000F000F000Fu;
  };
  const auto two = [&](std::size_t a, std::size_t b)
                       HWY_ATTR { return (bits(a) | bits(b) << 16) >> shift & 0x000F000Fu; };
  const Bytes patterns = apart(both(four(0, 2, 4, 6) | four(1, 3, 5, 7) << 8, two(8, 10) | two(9, 11) << 8), turned);

  constexpr std::ptrdiff_t kRow = OffsetPlace::kKnownRow;
  const auto ix = static_cast<std::ptrdiff_t>(x);
  const auto known = [&](std::size_t slice, std::ptrdiff_t row) HWY_ATTR -> std::uint64_t {
    return load_as<std::uint32_t>(place.known[0][slice] + row * kRow + ix - 1);
  };
  const Bytes first = both(known(1, -1) | known(1, 0) << 32, known(1, 1) | known(0, 0) << 32),
              next = both(known(2, -1) | known(2, -2) << 32, 0);
  const Bytes cell = picked(lanes_of(tables::kCrossings.cell), patterns);
  const Bytes columns = either(picked(first, either(lanes_of(tables::kFirstFour), cell)),
                               picked(next, either(lanes_of(tables::kNextTwo), cell)));
  const std::uint64_t sides = load_as<std::uint16_t>(place.known[1][2] - kRow + ix) |
                              std::uint64_t{load_as<std::uint16_t>(place.known[2][1] + ix)} << 16;
  return {patterns, columns, both(sides, 0)};
}

/// Columns along x, in five rows.
template <int kAxis>
HWY_INLINE Found gather_rows(const OffsetPlace& place, const SpreadRows& rows, std::size_t x, Bytes turned) {
  const tables::Layout& layout = tables::kLayouts[kAxis];
  constexpr std::ptrdiff_t kRow = OffsetPlace::kKnownRow;
  const auto ix = static_cast<std::ptrdiff_t>(x);
  const auto pick = [&](std::size_t r, const std::uint8_t* from)
                        HWY_ATTR { return picked(load(from), lanes_of(layout.pick[r])); };
  Bytes patterns = turned;
  for (std::size_t r = 0; r < 5; ++r) patterns = apart(patterns, pick(r, rows.row[r] + x + 6));
  patterns = common(patterns, all(15));
  const auto known = [&](std::size_t r, std::size_t slice, std::ptrdiff_t row)
                         HWY_ATTR { return pick(r, place.known[kAxis][slice] + row * kRow + ix - 2); };
  const auto among = [&](std::size_t cell, Bytes offsets) HWY_ATTR {
    return common(offsets, picked(lanes_of(tables::kCrossings.among[cell]), patterns));
  };
  const auto one = [&](std::size_t axis, std::size_t slice, std::ptrdiff_t at)
                       HWY_ATTR -> std::uint64_t { return place.known[axis][slice][at]; };
  const std::uint64_t pair = load_as<std::uint16_t>(place.known[0][2] + ix - 1);
  if constexpr (kAxis == 1) {
    const Bytes before = either(either(known(0, 0, -1), known(1, 1, -1)), known(2, 2, -1)),
                beside = either(known(0, 0, 0), known(1, 1, 0)), behind = either(known(0, 0, 1), known(1, 1, 1));
    return {patterns, either(either(among(0, before), among(1, beside)), among(2, behind)),
            both(one(2, 1, ix) | one(2, 1, kRow + ix) << 8 | pair << 16, 0)};
  } else {
    const Bytes before =
                    either(either(either(known(0, 1, -2), known(1, 1, -1)), either(known(2, 1, 0), known(3, 1, 1))),
                           known(4, 1, 2)),
                beside = either(known(0, 2, -2), known(1, 2, -1));
    return {patterns, either(among(0, before), among(1, beside)),
            both(pair | one(1, 2, ix - kRow) << 16 | one(1, 2, ix) << 24, 0)};
  }
}

template <int kAxis>
HWY_INLINE void put_inputs(const Found& found, std::int16_t* inputs) {
  constexpr std::size_t kKnown = kOffsetLayouts[kAxis].known, kWide = kKnown > 8 ? 16 : 8;
  const tables::Layout& layout = tables::kLayouts[kAxis];
  const Bytes sixty_four = all(64), seen = any(found.columns);
  const Bytes bits = apart(picked(found.patterns, lanes_of(layout.side_column)), lanes_of(layout.side_flip));
  const Bytes active = any(common(bits, lanes_of(layout.side_bit))), side_seen = any(found.sides);
  const Bytes away = plus(apart(found.sides, lanes_of(layout.side_turn)), lanes_of(layout.side_add));
  widen<8>(common(without(side_seen, active), sixty_four), inputs);
  widen<8>(common(common(side_seen, active), away), inputs + 8);  // the first four
  widen<kWide>(common(seen, plus(found.columns, picked(lanes_of(tables::kCrossings.add), found.patterns))),
               inputs + 12);
  widen<kWide>(common(seen, sixty_four), inputs + 12 + kKnown);
  widen<16>(without(seen, picked(lanes_of(tables::kCrossings.missing), found.patterns)), inputs + 12 + 2 * kKnown);
}

template <int kAxis>
void begin_axis(const OffsetNetwork& network, const OffsetPlace& place, std::span<const std::uint8_t> xs,
                OffsetRow& row) {
  constexpr std::size_t kPairs = kOffsetLayouts[kAxis].inputs() / 2;
  SpreadRows rows;
  std::size_t filled = 0;
  OffsetsBefore before;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const std::size_t x = xs[i];
    const bool own = place.signs[(x + 8) >> 3] >> (x & 7) & 1;
    const Bytes turned = all(own ? 0 : 15);
    HWY_ALIGN std::int16_t inputs[kMostOffsetInputs + 8];
    if constexpr (kAxis == 0) {
      put_inputs<0>(gather_x(place, x, turned), inputs);
    } else {
      filled = std::max(filled, (x + 6) / kWidth * kWidth);
      for (; filled <= x + 10; filled += kWidth) spread<kAxis>(place, filled, rows);
      put_inputs<kAxis>(gather_rows<kAxis>(place, rows, x, turned), inputs);
    }
    Units units;
    load_units(network.bias, units);
#pragma GCC unroll 4
    for (std::size_t p = 0; p < kPairs; ++p) add_pair(network.in[p], inputs + 2 * p, units);
    if constexpr (kAxis != 0) store_units(units, row.sums[i]);
    row.own[i] = own ? 1 : 0;
    if (kAxis == 0 || !before.beside(static_cast<int>(x), own)) row.estimates[i] = estimate(network, units);
    before.note(static_cast<int>(x), own, 0);
  }
}

void begin(const OffsetNetwork& network, int axis, const OffsetPlace& place, std::span<const std::uint8_t> xs,
           OffsetRow& row) {
  if (axis == 0)
    begin_axis<0>(network, place, xs, row);
  else if (axis == 1)
    begin_axis<1>(network, place, xs, row);
  else
    begin_axis<2>(network, place, xs, row);
}

OffsetEstimate finish(const OffsetNetwork& network, const OffsetNetwork::Sums& sums, const OffsetNear& near) {
  return estimate_near(network, sums, near);
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(begin);
HWY_EXPORT(finish);
}  // namespace

void begin_offsets(const OffsetNetwork& network, int axis, const OffsetPlace& place, std::span<const std::uint8_t> xs,
                   OffsetRow& row) {
  HWY_DYNAMIC_DISPATCH(begin)(network, axis, place, xs, row);
}
OffsetEstimate finish_offset(const OffsetNetwork& network, const OffsetNetwork::Sums& sums, const OffsetNear& near) {
  return HWY_DYNAMIC_DISPATCH(finish)(network, sums, near);
}

}  // namespace dubsar
#endif
