#include "core/volume/finite_source.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// By the bits of the exponent, in sums that vectors can hold: this looks at every voxel of a scan.
std::int64_t count_nonfinite(std::span<const float> values) {
  constexpr std::uint32_t kExponent = 0x7F800000U;
  constexpr std::size_t kAtOnce = 1 << 16;
  std::int64_t all = 0;
  for (std::size_t from = 0; from < values.size(); from += kAtOnce) {
    std::uint32_t count = 0;
    for (const float value : values.subspan(from, std::min(kAtOnce, values.size() - from)))
      count += (std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent ? 1U : 0U;
    all += count;
  }
  return all;
}

}  // namespace

FiniteSource::FiniteSource(std::unique_ptr<SlabSource> source, std::optional<float> fill)
    : source_(std::move(source)), fill_(fill), counted_(static_cast<std::size_t>(source_->dims().z), 0) {}

Result<void> FiniteSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_TRY(source_->read(z_begin, z_end, out));
  const Dims size = dims();
  std::vector<std::int64_t> bad(static_cast<std::size_t>(z_end - z_begin), 0);
  const std::int64_t grain = std::max<std::int64_t>(1, (1 << 18) / size.slice());
  parallel_for(z_end - z_begin, grain, [&](std::int64_t k) {
    const auto slice = out.subspan(static_cast<std::size_t>(k * size.slice()), static_cast<std::size_t>(size.slice()));
    bad[static_cast<std::size_t>(k)] = count_nonfinite(slice);
  });
  if (std::all_of(bad.begin(), bad.end(), [](std::int64_t n) { return n == 0; })) return {};
  for (std::int64_t k = 0; k < z_end - z_begin; ++k)
    if (std::exchange(counted_[static_cast<std::size_t>(z_begin + k)], std::uint8_t{1}) == 0)
      count_ += bad[static_cast<std::size_t>(k)];
  if (count_ > size.count() / 100)
    return fail(ErrorKind::kBadData,
                "import: {} of {} voxels read so far are NaN or Inf, expected at most 1 %; repair the "
                "volume, or crop to the part that is sound",
                count_, size.count());
  if (!fill_) {
    DUBSAR_ASSIGN(fill_, estimate_air());
  }
  parallel_for(z_end - z_begin, grain, [&](std::int64_t k) {
    if (bad[static_cast<std::size_t>(k)] == 0) return;
    const auto slice = out.subspan(static_cast<std::size_t>(k * size.slice()), static_cast<std::size_t>(size.slice()));
    std::replace_if(
        slice.begin(), slice.end(), [](float value) { return !std::isfinite(value); }, *fill_);
  });
  return {};
}

Result<float> FiniteSource::estimate_air() {
  constexpr std::int64_t kSlices = 9, kSamplesPerSlice = 1 << 16;
  const Dims size = dims();
  const auto step = static_cast<std::size_t>(std::max<std::int64_t>(1, size.slice() / kSamplesPerSlice));
  std::vector<float> slice(static_cast<std::size_t>(size.slice())), values;
  for (std::int64_t i = 0; i < std::min(kSlices, size.z); ++i) {
    const std::int64_t z = (2 * i + 1) * size.z / (2 * std::min(kSlices, size.z));
    DUBSAR_TRY(source_->read(z, z + 1, slice));
    for (std::size_t at = 0; at < slice.size(); at += step)
      if (std::isfinite(slice[at])) values.push_back(slice[at]);
  }
  if (values.empty()) return 0.0F;
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 20);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

}  // namespace dubsar
