#include "core/volume/brick_mask.h"

#include <algorithm>
#include <bit>

namespace dubsar {
namespace {

std::int64_t bricks_of(std::int64_t points) { return (points + BrickMask::kEdge - 1) / BrickMask::kEdge; }

}  // namespace

BrickMask::BrickMask(const Dims& dims)
    : dims_(dims),
      bricks_{bricks_of(dims.x), bricks_of(dims.y), bricks_of(dims.z)},
      words_((bricks_.x + 63) / 64),
      bits_(static_cast<std::size_t>(words_ * bricks_.y * bricks_.z), 0) {}

void BrickMask::set_all() noexcept {
  for (std::int64_t bz = 0; bz < bricks_.z; ++bz)
    for (std::int64_t by = 0; by < bricks_.y; ++by)
      for (std::int64_t bx = 0; bx < bricks_.x; ++bx) set(bx, by, bz);
}

std::int64_t BrickMask::count() const noexcept {
  std::int64_t count = 0;
  for (const std::uint64_t word : bits_) count += std::popcount(word);
  return count;
}

void BrickMask::spans(std::int64_t y, std::int64_t z, std::int64_t reach, std::vector<Span>& out) const {
  out.clear();
  const auto first = [&](std::int64_t p) { return std::max<std::int64_t>(p - reach, 0) / kEdge; };
  const auto last = [&](std::int64_t p, std::int64_t n) { return std::min((p + reach) / kEdge, n - 1); };
  const std::int64_t y0 = first(y), y1 = last(y, bricks_.y), z0 = first(z), z1 = last(z, bricks_.z);
  for (std::int64_t w = 0; w < words_; ++w) {
    std::uint64_t word = 0;
    for (std::int64_t bz = z0; bz <= z1; ++bz)
      for (std::int64_t by = y0; by <= y1; ++by) word |= row(by, bz)[w];
    while (word != 0) {
      const int begin = std::countr_zero(word), ones = std::countr_one(word >> begin);
      const std::int64_t bx = 64 * w + begin;
      const Span span{std::max<std::int64_t>(bx * kEdge - reach, 0), std::min((bx + ones) * kEdge + reach, dims_.x)};
      if (!out.empty() && out.back().end >= span.begin)
        out.back().end = span.end;
      else
        out.push_back(span);
      word = begin + ones == 64 ? 0 : word >> (begin + ones) << (begin + ones);
    }
  }
}

bool BrickMask::any(std::int64_t z_begin, std::int64_t z_end, std::int64_t reach) const noexcept {
  const std::int64_t b0 = std::max<std::int64_t>(z_begin - reach, 0) / kEdge,
                     b1 = std::min((z_end - 1 + reach) / kEdge, bricks_.z - 1);
  const auto layer = words_ * bricks_.y;
  return std::any_of(bits_.begin() + b0 * layer, bits_.begin() + (b1 + 1) * layer,
                     [](std::uint64_t word) { return word != 0; });
}

}  // namespace dubsar
