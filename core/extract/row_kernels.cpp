#include "core/extract/row_kernels.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extract/row_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void pack_signs(const float* values, std::int64_t nx, float isovalue, std::uint64_t* words) {
  const hn::ScalableTag<float> d;
  const std::int64_t lanes = static_cast<std::int64_t>(hn::Lanes(d));
  const auto level = hn::Set(d, isovalue);
  std::int64_t x = 0;
  for (; x + 64 <= nx; x += 64) {
    std::uint64_t word = 0;
    for (std::int64_t i = 0; i < 64; i += lanes) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Ge(hn::LoadU(d, values + x + i), level), bits);
      if (lanes <= 8) {
        word |= static_cast<std::uint64_t>(bits[0]) << i;
      } else {
        word |= (static_cast<std::uint64_t>(bits[0]) | static_cast<std::uint64_t>(bits[1]) << 8) << i;
      }
    }
    words[x / 64] = word;
  }
  if (x < nx) {
    std::uint64_t word = 0;
    for (std::int64_t i = 0; x + i < nx; ++i) word |= static_cast<std::uint64_t>(values[x + i] >= isovalue) << i;
    words[x / 64] = word;
  }
}

// Set bits of word(0), word(1), .. at places below x.
template <class Word>
HWY_INLINE std::uint32_t count_below(std::int64_t x, const Word& word) {
  std::uint32_t count = 0;
  std::int64_t w = 0;
  for (; 64 * w + 64 <= x; ++w) count += static_cast<std::uint32_t>(__builtin_popcountll(word(w)));
  const std::uint64_t below = (std::uint64_t{1} << (x % 64)) - 1;
  return below == 0 ? count : count + static_cast<std::uint32_t>(__builtin_popcountll(word(w) & below));
}

std::uint32_t count_ones(const std::uint64_t* row, std::int64_t x) {
  return count_below(x, [&](std::int64_t w) HWY_ATTR { return row[w]; });
}

std::uint32_t count_differences(const std::uint64_t* a, const std::uint64_t* b, std::int64_t x) {
  return count_below(x, [&](std::int64_t w) HWY_ATTR { return a[w] ^ b[w]; });
}

std::uint32_t count_changes(const std::uint64_t* row, std::int64_t x) {
  // The next point of bit 63 is only needed, and only sure to exist, when the whole word counts.
  return count_below(
      x, [&](std::int64_t w) HWY_ATTR { return row[w] ^ (row[w] >> 1 | (64 * w + 64 <= x ? row[w + 1] << 63 : 0)); });
}

// Active edges and ambiguous faces of 64 points.
struct WordItems {
  std::uint64_t edges[3];
  std::uint64_t faces[3];
};

HWY_INLINE WordItems word_items(const SignRows& rows, std::int64_t w, std::int64_t words, std::int64_t nx) {
  // Points with a neighbour at x + 1.
  const std::int64_t left = nx - 1 - 64 * w;
  const std::uint64_t with_next = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
  const auto shifted = [&](const std::uint64_t* row)
                           HWY_ATTR { return row[w] >> 1 | (w + 1 < words ? row[w + 1] << 63 : 0); };
  WordItems items{};
  const std::uint64_t a = rows.here[w], ax = shifted(rows.here);
  items.edges[0] = (a ^ ax) & with_next;
  if (rows.next_y != nullptr) {
    const std::uint64_t b = rows.next_y[w];
    items.edges[1] = a ^ b;
    items.faces[2] = (a ^ ax) & (a ^ b) & ~(a ^ shifted(rows.next_y)) & with_next;
  }
  if (rows.next_z != nullptr) {
    const std::uint64_t c = rows.next_z[w];
    items.edges[2] = a ^ c;
    items.faces[1] = (a ^ ax) & (a ^ c) & ~(a ^ shifted(rows.next_z)) & with_next;
  }
  if (rows.next_yz != nullptr) items.faces[0] = items.edges[1] & items.edges[2] & ~(a ^ rows.next_yz[w]);
  return items;
}

// Are all rows alike and of one sign? Then nothing starts in them. Most rows of a volume are such.
HWY_INLINE bool is_uniform(const SignRows& rows, std::int64_t words, std::int64_t nx) {
  const std::uint64_t *a = rows.here, *b = rows.next_y != nullptr ? rows.next_y : a,
                      *c = rows.next_z != nullptr ? rows.next_z : a, *d = rows.next_yz != nullptr ? rows.next_yz : a;
  const std::uint64_t sign = a[0] & 1 ? ~std::uint64_t{0} : 0;
  std::uint64_t apart = 0;
  for (std::int64_t w = 0; w + 1 < words; ++w) apart |= (a[w] ^ sign) | (a[w] ^ b[w]) | (a[w] ^ c[w]) | (a[w] ^ d[w]);
  const std::int64_t w = words - 1;
  const std::uint64_t used = nx % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (nx % 64)) - 1;
  return (apart | (((a[w] ^ sign) | (a[w] ^ b[w]) | (a[w] ^ c[w]) | (a[w] ^ d[w])) & used)) == 0;
}

RowItems count_row(const SignRows& rows, std::int64_t nx) {
  RowItems counts;
  const std::int64_t words = (nx + 63) / 64;
  if (is_uniform(rows, words, nx)) return counts;
  for (std::int64_t w = 0; w < words; ++w) {
    const WordItems items = word_items(rows, w, words, nx);
    if ((items.edges[0] | items.edges[1] | items.edges[2]) == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      counts.edges[a] += static_cast<std::uint32_t>(__builtin_popcountll(items.edges[a]));
      counts.faces[a] += static_cast<std::uint32_t>(__builtin_popcountll(items.faces[a]));
    }
  }
  return counts;
}

HWY_INLINE std::uint16_t quantise(double v0, double v1, int bits) {
  double t = v0 / (v0 - v1);
  if (!std::isfinite(t)) t = 0.5;
  const int steps = 1 << bits;
  return static_cast<std::uint16_t>(std::clamp(static_cast<int>(t * steps), 0, steps - 1));
}

HWY_INLINE bool decide(double a, double b, double c, double d) {
  const double diagonal = a * d, other = b * c;
  return a >= 0 ? diagonal > other : other > diagonal;
}

// The row one voxel further; rows behind the last one do not exist.
HWY_INLINE const float* beside(const float* row) { return row != nullptr ? row + 1 : nullptr; }

void fill_row(const SignRows& rows, const ValueRows& values, std::int64_t nx, float isovalue, const RowItems& items,
              EdgeEnds* ends, std::uint8_t* joined) {
  const std::int64_t words = (nx + 63) / 64;
  const double level = isovalue;
  EdgeEnds* edge_out[3] = {ends, ends + items.edges[0], ends + items.edges[0] + items.edges[1]};
  std::uint8_t* face_out[3] = {joined, joined + items.faces[0], joined + items.faces[0] + items.faces[1]};
  const float* edge_ends[3] = {values.here + 1, values.next_y, values.next_z};
  const float* corners[3][4] = {{values.here, values.next_y, values.next_z, values.next_yz},
                                {values.here, values.here + 1, values.next_z, beside(values.next_z)},
                                {values.here, values.here + 1, values.next_y, beside(values.next_y)}};
  for (std::int64_t w = 0; w < words; ++w) {
    const WordItems word = word_items(rows, w, words, nx);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::uint64_t rest = word.edges[a]; rest != 0; rest &= rest - 1) {
        const std::int64_t x = 64 * w + __builtin_ctzll(rest);
        *edge_out[a]++ = {values.here[x], edge_ends[a][x]};
      }
    }
    if ((word.faces[0] | word.faces[1] | word.faces[2]) == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::uint64_t rest = word.faces[a]; rest != 0; rest &= rest - 1) {
        const std::int64_t x = 64 * w + __builtin_ctzll(rest);
        *face_out[a]++ = decide(corners[a][0][x] - level, corners[a][1][x] - level, corners[a][2][x] - level,
                                corners[a][3][x] - level);
      }
    }
  }
}

void quantise_crossings(const EdgeEnds* ends, std::size_t count, float isovalue, int bits, std::uint16_t* offsets) {
  const hn::CappedTag<double, 8> dd;
  const hn::Rebind<float, decltype(dd)> df;
  const hn::Rebind<std::int32_t, decltype(dd)> di;
  const hn::Rebind<std::uint16_t, decltype(dd)> du;
  const std::size_t lanes = hn::Lanes(dd);
  const int steps = 1 << bits;
  const auto level = hn::Set(dd, isovalue), scale = hn::Set(dd, steps), half = hn::Set(dd, 0.5);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {  // quantise(), several at a time
    hn::Vec<decltype(df)> value0, value1;
    hn::LoadInterleaved2(df, &ends[i].from, value0, value1);
    const auto v0 = hn::Sub(hn::PromoteTo(dd, value0), level), v1 = hn::Sub(hn::PromoteTo(dd, value1), level);
    const auto t = hn::Div(v0, hn::Sub(v0, v1));
    const auto step = hn::DemoteTo(di, hn::Mul(hn::IfThenElse(hn::IsFinite(t), t, half), scale));
    hn::StoreU(hn::DemoteTo(du, hn::Min(hn::Max(step, hn::Zero(di)), hn::Set(di, steps - 1))), du, offsets + i);
  }
  for (; i < count; ++i) offsets[i] = quantise(ends[i].from - double{isovalue}, ends[i].to - double{isovalue}, bits);
}

std::uint16_t quantise_crossing(float value0, float value1, float isovalue, int bits) {
  return quantise(value0 - static_cast<double>(isovalue), value1 - static_cast<double>(isovalue), bits);
}

bool joins_inside(float a, float b, float c, float d, float isovalue) {
  const double level = isovalue;
  return decide(a - level, b - level, c - level, d - level);
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(pack_signs);
HWY_EXPORT(count_ones);
HWY_EXPORT(count_differences);
HWY_EXPORT(count_changes);
HWY_EXPORT(count_row);
HWY_EXPORT(fill_row);
HWY_EXPORT(quantise_crossings);
HWY_EXPORT(quantise_crossing);
HWY_EXPORT(joins_inside);
}  // namespace

void pack_signs(const float* values, std::int64_t nx, float isovalue, std::uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(pack_signs)(values, nx, isovalue, words);
}
std::uint32_t count_ones(const std::uint64_t* row, std::int64_t x) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_ones)(row, x);
}
std::uint32_t count_differences(const std::uint64_t* a, const std::uint64_t* b, std::int64_t x) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_differences)(a, b, x);
}
std::uint32_t count_changes(const std::uint64_t* row, std::int64_t x) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_changes)(row, x);
}
RowItems count_row(const SignRows& rows, std::int64_t nx) { return HWY_DYNAMIC_DISPATCH(count_row)(rows, nx); }
void fill_row(const SignRows& rows, const ValueRows& values, std::int64_t nx, float isovalue, const RowItems& items,
              EdgeEnds* ends, std::uint8_t* joined) {
  HWY_DYNAMIC_DISPATCH(fill_row)(rows, values, nx, isovalue, items, ends, joined);
}
void quantise_crossings(const EdgeEnds* ends, std::size_t count, float isovalue, int bits, std::uint16_t* offsets) {
  HWY_DYNAMIC_DISPATCH(quantise_crossings)(ends, count, isovalue, bits, offsets);
}
std::uint16_t quantise_crossing(float value0, float value1, float isovalue, int bits) noexcept {
  return HWY_DYNAMIC_DISPATCH(quantise_crossing)(value0, value1, isovalue, bits);
}
bool joins_inside(float a, float b, float c, float d, float isovalue) noexcept {
  return HWY_DYNAMIC_DISPATCH(joins_inside)(a, b, c, d, isovalue);
}
}  // namespace dubsar
#endif
