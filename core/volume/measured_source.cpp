#include "core/volume/measured_source.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/system/parallel.h"
#include "core/volume/slice_border.h"

namespace dubsar {
namespace {

/// By the bits of the exponent, in sums that vectors can hold: this looks at every voxel of a scan.
bool has_nonfinite(std::span<const float> values) {
  constexpr std::uint32_t kExponent = 0x7F800000U;
  constexpr std::size_t kAtOnce = 1 << 16;
  for (std::size_t from = 0; from < values.size(); from += kAtOnce) {
    std::uint32_t count = 0;
    for (const float value : values.subspan(from, std::min(kAtOnce, values.size() - from)))
      count += (std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent ? 1U : 0U;
    if (count > 0) return true;
  }
  return false;
}

std::vector<float> own_padding(std::span<const float> slice, const Dims& dims) {
  const std::optional<float> value = SliceBorder(slice, dims.x, dims.y).padding();
  return value ? std::vector<float>{*value} : std::vector<float>{};
}

constexpr std::uint8_t kCounted = 1, kBridged = 2;

bool is_one_of(float value, const std::vector<float>& values) {
  return std::any_of(values.begin(), values.end(), [&](float other) { return value == other; });
}

}  // namespace

MeasuredSource::MeasuredSource(std::unique_ptr<SlabSource> source, Options options)
    : source_(std::move(source)),
      options_(std::move(options)),
      counted_(static_cast<std::size_t>(source_->dims().z), 0) {}

Result<Unmeasured> MeasuredSource::unmeasured() {
  if (!options_.known) {
    DUBSAR_ASSIGN(options_.known, find_unmeasured(*source_, options_.ignored));
    if (options_.fill) options_.known->fill = *options_.fill;
  }
  return *options_.known;
}

std::vector<std::int64_t> MeasuredSource::bridged() const {
  std::vector<std::int64_t> slices;
  for (std::size_t z = 0; z < counted_.size(); ++z)
    if (counted_[z] == kBridged) slices.push_back(static_cast<std::int64_t>(z));
  return slices;
}

/// `between`: NaN and Inf that no end of a row reaches.
MeasuredSource::Counts MeasuredSource::fill_slice(std::span<float> slice, std::int64_t& between) const {
  const Unmeasured& what = *options_.known;
  const bool nonfinite = options_.may_have_nonfinite && has_nonfinite(slice);
  const std::vector<float> outside = what.each_slice ? own_padding(slice, dims()) : what.outside;
  const auto is_outside = [&](float v) {
    return is_one_of(v, outside) || is_one_of(v, what.ignored) || (nonfinite && !std::isfinite(v));
  };
  const bool inside_too = nonfinite || !what.ignored.empty();
  const auto width = static_cast<std::size_t>(dims().x);
  Counts counts;
  const auto fill = [&](float& v) {
    std::isfinite(v) ? ++counts.outside : ++counts.nonfinite;
    v = what.fill;
  };
  for (std::size_t row = 0; row < slice.size(); row += width) {
    std::size_t begin = row, end = row + width;
    for (; begin < end && is_outside(slice[begin]); ++begin) fill(slice[begin]);
    for (; begin < end && is_outside(slice[end - 1]); --end) fill(slice[end - 1]);
    if (!inside_too) continue;
    for (std::size_t at = begin; at < end; ++at) {
      if (std::isfinite(slice[at]) && !is_one_of(slice[at], what.ignored)) continue;
      between += std::isfinite(slice[at]) ? 0 : 1;
      fill(slice[at]);
    }
  }
  return counts;
}

Result<void> MeasuredSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_ASSIGN(const Unmeasured what, unmeasured());
  DUBSAR_TRY(source_->read(z_begin, z_end, out));
  const Dims size = dims();
  const auto slices = static_cast<std::size_t>(z_end - z_begin);
  const std::span<float> slab = out.first(slices * static_cast<std::size_t>(size.slice()));
  DUBSAR_ASSIGN(std::vector<Bridge> bridges, bridges_of(*source_, z_begin, z_end, slab, [&](float v) {
                  return is_one_of(v, what.outside) || is_one_of(v, what.ignored);
                }));
  for (Bridge& bridge : bridges) {
    std::int64_t elsewhere = 0;
    fill_slice(bridge.below_values, elsewhere);
    fill_slice(bridge.above_values, elsewhere);
    counted_[static_cast<std::size_t>(bridge.slice)] = kBridged;
    cross(bridge, slab.subspan(static_cast<std::size_t>((bridge.slice - z_begin) * size.slice()),
                               static_cast<std::size_t>(size.slice())));
  }
  if (!options_.may_have_nonfinite && what.outside.empty() && what.ignored.empty()) return {};
  std::vector<Counts> filled(slices);
  std::vector<std::int64_t> between(slices, 0);
  const std::int64_t grain = std::max<std::int64_t>(1, (1 << 18) / size.slice());
  parallel_for(z_end - z_begin, grain, [&](std::int64_t k) {
    const auto slice = out.subspan(static_cast<std::size_t>(k * size.slice()), static_cast<std::size_t>(size.slice()));
    filled[static_cast<std::size_t>(k)] = fill_slice(slice, between[static_cast<std::size_t>(k)]);
  });
  for (std::size_t k = 0; k < slices; ++k) {
    std::uint8_t& counted = counted_[static_cast<std::size_t>(z_begin) + k];
    if (counted != 0) continue;
    counted = kCounted;
    counts_.outside += filled[k].outside;
    counts_.nonfinite += filled[k].nonfinite;
    between_ += between[k];
  }
  if (between_ > size.count() / 100)
    return fail(ErrorKind::kBadData,
                "import: {} of {} voxels read so far are NaN or Inf with measurements on both sides, expected at most "
                "1 %; repair the volume, or crop to the part that is sound",
                between_, size.count());
  return {};
}

}  // namespace dubsar
