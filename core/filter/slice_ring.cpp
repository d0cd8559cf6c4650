#include "core/filter/slice_ring.h"

#include <vector>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kLine = 16;          // floats in a cache line
constexpr std::int64_t kStaging = 1 << 18;  // floats; slices are copied on while they are in a second-level cache
constexpr std::int64_t kLead = 2 * kLine;   // >= kPad, keeps rows aligned

std::int64_t padded_pitch(std::int64_t nx) {
  std::int64_t lines = (kLead + nx + SliceRing::kPad + kLine - 1) / kLine;
  lines |= 1;  // an odd number of cache lines: the same x of neighbouring rows never falls into the same cache set
  return lines * kLine;
}

}  // namespace

SliceRing::SliceRing(Dims dims, std::int64_t capacity, Rows rows) : dims_(dims), capacity_(std::min(capacity, dims.z)) {
  DUBSAR_CHECK(dims.count() > 0 && capacity > 0);
  if (rows == Rows::kPadded) {
    lead_ = kLead;
    pitch_ = padded_pitch(dims.x);
    stride_ = pitch_ * dims.y + 5 * kLine;  // the same for neighbouring slices
  } else {
    pitch_ = dims.x;
    stride_ = dims.slice();
  }
  slices_ = Buffer<float>(stride_ * capacity_);
}

void SliceRing::pad_row(float* row) const noexcept {
  std::fill(row - kPad, row, row[0]);
  std::fill(row + dims_.x, row - lead_ + pitch_, row[dims_.x - 1]);
}

SliceRange SliceRing::missing(SliceRange wanted) noexcept {
  wanted = {std::max<std::int64_t>(wanted.begin, 0), std::min(wanted.end, dims_.z)};
  if (wanted.begin < held_.begin || wanted.begin > held_.end) held_ = {wanted.begin, wanted.begin};
  held_.begin = std::max(held_.begin, wanted.end - capacity_);
  return {held_.end, std::max(wanted.end, held_.end)};
}

Result<void> SliceRing::load(SlabSource& source, SliceRange wanted, const Wanted& points) {
  DUBSAR_CHECK(std::min(wanted.end, dims_.z) - std::max<std::int64_t>(wanted.begin, 0) <= capacity_);
  const SliceRange part = missing(wanted);
  if (part.empty()) return {};
  const std::int64_t slice = dims_.slice();
  const auto give_up = [&](auto& result) {
    forget();
    return result;
  };
  if (lead_ == 0) {
    for (std::int64_t z = part.begin; z < part.end;) {  // runs that do not wrap around the end of the ring
      const std::int64_t end = std::min(part.end, z + capacity_ - z % capacity_);
      if (auto ok = source.read(z, end, {row(0, z), static_cast<std::size_t>((end - z) * slice)}); !ok)
        return give_up(ok);
      z = end;
    }
  } else {
    const std::int64_t step = std::clamp<std::int64_t>(kStaging / slice, 1, part.end - part.begin);
    if (staging_.size() < step * slice) staging_ = Buffer<float>(step * slice);
    for (std::int64_t z = part.begin; z < part.end; z += step) {
      const std::int64_t end = std::min(part.end, z + step);
      if (!points.any(z, end)) continue;
      if (auto ok = source.read(z, end, staging_.span().first(static_cast<std::size_t>((end - z) * slice))); !ok)
        return give_up(ok);
      parallel_chunks((end - z) * dims_.y, 64, [&](std::int64_t begin, std::int64_t stop) {
        std::vector<Span> spans;
        for (std::int64_t i = begin; i < stop; ++i) {
          const std::int64_t y = i % dims_.y, at = z + i / dims_.y;
          points.spans(dims_.x, y, at, spans);
          if (spans.empty()) continue;
          float* to = row(y, at);
          const float* from = staging_.data() + i * dims_.x;
          for (const Span& span : spans) std::copy(from + span.begin, from + span.end, to + span.begin);
          pad_row(to);
        }
      });
    }
  }
  hold(part);
  return {};
}

}  // namespace dubsar
