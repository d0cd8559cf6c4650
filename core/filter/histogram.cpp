#include "core/filter/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kSign = 0x80000000U, kInfinite = 0x7F800000U;

/// Of keys, which are unsigned integers in the order of the floats.
double value_of(std::uint32_t key) { return std::bit_cast<float>((key & kSign) != 0 ? key ^ kSign : ~key); }

/// Adds `mass`, spread evenly over [begin, end), to the bins.
void spread(Histogram& h, double begin, double end, double mass) {
  const double bins = static_cast<double>(h.mass.size());
  const double from = (begin - h.low) / h.width, to = (end - h.low) / h.width;
  if (!(to > 0.0) || !(from < bins)) return;
  const double per_bin = to > from ? mass / (to - from) : 0.0;
  const auto first = static_cast<std::size_t>(std::max(from, 0.0));
  if (to - from < 1e-9) {
    h.mass[std::min(first, h.mass.size() - 1)] += mass;
    return;
  }
  for (std::size_t bin = first; bin < h.mass.size() && static_cast<double>(bin) < to; ++bin) {
    const double left = std::max(from, static_cast<double>(bin)), right = std::min(to, static_cast<double>(bin) + 1.0);
    h.mass[bin] += per_bin * std::max(0.0, right - left);
  }
}

double quantile(std::span<const ValueCounts::Value> values, double rank) {
  double below = 0.0;
  for (const auto& value : values) {
    below += static_cast<double>(value.count);
    if (below > rank) return value.centre;
  }
  return values.back().centre;
}

}  // namespace

namespace {
template <class Blocks>
auto& block_of(Blocks& blocks, std::size_t index) {
  if (!blocks[index]) blocks[index] = std::make_unique<typename Blocks::value_type::element_type>();
  return *blocks[index];
}
}  // namespace

/// Values are turned into keys some at a time by vectors, and then counted: the counters of the values of a scan fit
/// the second-level cache, so that the two loops cost about as much as reading them.
void ValueCounts::add(std::span<const float> values) {
  constexpr std::size_t kBatch = 2048;
  std::array<std::uint32_t, kBatch> keys;
  for (std::size_t from = 0; from < values.size(); from += kBatch) {
    const std::size_t size = std::min(kBatch, values.size() - from);
    const float* const batch = values.data() + from;
    std::uint32_t lowest = ~0U, highest = 0, bad = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t bits = std::bit_cast<std::uint32_t>(batch[i] + 0.0F);  // -0 is 0
      bad += (bits & ~kSign) >= kInfinite ? 1U : 0U;
      const std::uint32_t key = bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) | kSign);
      keys[i] = key;
      lowest = std::min(lowest, key);
      highest = std::max(highest, key);
    }
    std::size_t kept = size;
    if (bad > 0) {
      kept = 0;
      lowest = ~0U, highest = 0;
      for (std::size_t i = 0; i < size; ++i) {
        if (!(std::abs(batch[i]) <= std::numeric_limits<float>::max())) continue;
        keys[kept++] = keys[i];
        lowest = std::min(lowest, keys[i]);
        highest = std::max(highest, keys[i]);
      }
    }
    if (kept == 0) continue;
    min_ = std::min(min_, static_cast<float>(value_of(lowest)));
    max_ = std::max(max_, static_cast<float>(value_of(highest)));
    count({keys.data(), kept});
  }
}

void ValueCounts::count(std::span<const std::uint32_t> keys) {
  const auto size = static_cast<std::int64_t>(keys.size());
  if (recent_count_ + size > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) settle();
  for (const std::uint32_t key : keys) {
    auto* counters = recent_[key >> 16].get();
    if (counters == nullptr) counters = &block_of(recent_, key >> 16);
    ++(*counters)[(key >> 8) & 0xFFU];
  }
  recent_count_ += size;
  count_ += size;
}

/// No counter of 32 bits may overflow.
void ValueCounts::settle() {
  for (std::size_t i = 0; i < recent_.size(); ++i) {
    if (!recent_[i]) continue;
    auto& sums = block_of(settled_, i);
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += std::exchange((*recent_[i])[k], 0U);
  }
  recent_count_ = 0;
}

std::int64_t ValueCounts::count_at(std::size_t block, std::size_t place) const {
  return (recent_[block] ? std::int64_t{(*recent_[block])[place]} : 0) +
         (settled_[block] ? (*settled_[block])[place] : 0);
}

void ValueCounts::merge(const ValueCounts& other) {
  for (std::size_t i = 0; i < settled_.size(); ++i) {
    if (!other.recent_[i] && !other.settled_[i]) continue;
    auto& mine = block_of(settled_, i);
    for (std::size_t k = 0; k < mine.size(); ++k) mine[k] += other.count_at(i, k);
  }
  count_ += other.count_;
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
}

std::vector<ValueCounts::Value> ValueCounts::values() const {
  std::vector<Value> all;
  for (std::size_t i = 0; i < settled_.size(); ++i) {
    if (!recent_[i] && !settled_[i]) continue;
    for (std::size_t k = 0; k < 256; ++k) {
      const std::int64_t count = count_at(i, k);
      if (count == 0) continue;
      const auto key = static_cast<std::uint32_t>(i << 16 | k << 8);
      // Numbers with few digits, such as integers, are the first of their 256 patterns on the positive side and the
      // last on the negative one: taking that one as the centre keeps them exact.
      all.push_back({value_of((key & kSign) != 0 ? key : key | 0xFFU), count});
    }
  }
  return all;
}

double ValueCounts::centre_of(float value) {
  ValueCounts alone;
  alone.add({&value, 1});
  return alone.values().front().centre;
}

void ParallelCounts::add(std::int64_t z_begin, std::span<const float> slices) {
  const auto parts = static_cast<std::size_t>(thread_count());
  if (partial_.size() < parts) partial_.resize(parts);
  const std::int64_t rows = static_cast<std::int64_t>(slices.size()) / std::max<std::int64_t>(dims_.x, 1);
  parallel_for(static_cast<std::int64_t>(parts), 1, [&](std::int64_t i) {
    const auto part = static_cast<std::size_t>(i), width = static_cast<std::size_t>(dims_.x);
    const auto from = rows * i / static_cast<std::int64_t>(parts),
               to = rows * (i + 1) / static_cast<std::int64_t>(parts);
    if (step_ == 1) {
      partial_[part].add(
          slices.subspan(static_cast<std::size_t>(from) * width, static_cast<std::size_t>(to - from) * width));
      return;
    }
    for (std::int64_t row = from; row < to; ++row)
      if ((row % dims_.y + z_begin + row / dims_.y) % step_ == 0)
        partial_[part].add(slices.subspan(static_cast<std::size_t>(row) * width, width));
  });
}

ValueCounts ParallelCounts::take() {
  ValueCounts all;
  for (const ValueCounts& part : partial_) all.merge(part);
  partial_.clear();
  return all;
}

Result<ValueCounts> count_values(SlabSource& source, Progress& progress) {
  const Dims dims = source.dims();
  if (dims.count() == 0) return ValueCounts{};
  constexpr std::int64_t kSlabVoxels = 1 << 19;  // stays in the cache between reading and counting
  const std::int64_t height = std::clamp<std::int64_t>(kSlabVoxels / dims.slice(), 1, dims.z);
  ParallelCounts counts(dims);
  Buffer<float> slab(dims.slice() * height);
  for (std::int64_t z = 0; z < dims.z; z += height) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t end = std::min(dims.z, z + height), count = (end - z) * dims.slice();
    const std::span<float> part = slab.span().first(static_cast<std::size_t>(count));
    DUBSAR_TRY(source.read(z, end, part));
    counts.add(z, part);
    progress.advance(count);
  }
  return counts.take();
}

Histogram make_histogram(std::span<const ValueCounts::Value> values, int bins, double tail) {
  Histogram h;
  for (const ValueCounts::Value& value : values) h.total += static_cast<double>(value.count);
  if (values.size() < 2) {
    if (!values.empty()) h.low = values.front().centre;
    return h;
  }
  double low = quantile(values, tail * h.total), high = quantile(values, (1.0 - tail) * h.total);
  if (!(high > low)) {  // all but a few voxels are equal
    low = values.front().centre;
    high = values.back().centre;
  }
  const double range = high - low;
  h.low = low - 0.02 * range;
  h.width = 1.04 * range / bins;
  h.mass.assign(static_cast<std::size_t>(bins), 0.0);
  const double reach = range / 64.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double here = values[i].centre;
    double before = i > 0 ? 0.5 * (here - values[i - 1].centre) : reach;
    double after = i + 1 < values.size() ? 0.5 * (values[i + 1].centre - here) : reach;
    if (i == 0) before = after;
    if (i + 1 == values.size()) after = before;
    spread(h, here - std::min(before, reach), here + std::min(after, reach), static_cast<double>(values[i].count));
  }
  return h;
}

}  // namespace dubsar
