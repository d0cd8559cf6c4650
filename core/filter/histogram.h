#pragma once
// Which grey values a volume has, and how often: exact to 24 bits in one pass, then bins over any range.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Counts of floats by the upper 24 bits of their order-preserving bit pattern: relative precision 2^-15, no range to
/// be known before, no floating-point sums. Memory: 1 to 3 KiB per 256 neighbouring patterns that occur, a few MiB for
/// a scan.
class ValueCounts {
 public:
  /// NaN and infinities are left out.
  void add(std::span<const float> values);
  /// Adds the counts of another one; the order of merging does not matter.
  void merge(const ValueCounts& other);

  std::int64_t count() const noexcept { return count_; }  ///< finite values
  float min() const noexcept { return min_; }             ///< exact; +infinity while count() is 0
  float max() const noexcept { return max_; }

  struct Value {
    double centre = 0.0;
    std::int64_t count = 0;
  };
  /// Everything that occurs, rising.
  std::vector<Value> values() const;
  /// As what values() gives a value that was counted.
  static double centre_of(float value);

 private:
  template <class Count>
  using Blocks = std::vector<std::unique_ptr<std::array<Count, 256>>>;
  void count(std::span<const std::uint32_t> keys);
  void settle();
  std::int64_t count_at(std::size_t block, std::size_t place) const;

  Blocks<std::uint32_t> recent_ = Blocks<std::uint32_t>(1 << 16);  ///< half the size: more of them lie in the caches
  Blocks<std::int64_t> settled_ = Blocks<std::int64_t>(1 << 16);
  std::int64_t recent_count_ = 0;  ///< values in recent_
  std::int64_t count_ = 0;
  float min_ = std::numeric_limits<float>::infinity(), max_ = -std::numeric_limits<float>::infinity();
};

/// Counts slabs by all threads; of a volume that is being made, so that nobody has to read it again for its histogram.
/// Of large volumes some rows are enough, spread evenly: counting a voxel costs more than filtering it.
class ParallelCounts {
 public:
  /// Of a volume of more than kMostCounted voxels every second, third, ... row.
  static constexpr std::int64_t kMostCounted = 100'000'000;
  explicit ParallelCounts(const Dims& dims)
      : dims_(dims), step_(std::max<std::int64_t>(1, (dims.count() + kMostCounted - 1) / kMostCounted)) {}

  /// Slices from `z_begin` on, as many as there are.
  void add(std::int64_t z_begin, std::span<const float> slices);
  /// Everything counted so far; the same for any slab height and thread count. Begins anew.
  ValueCounts take();

 private:
  Dims dims_;
  std::int64_t step_;
  std::vector<ValueCounts> partial_;
};

/// Counts a whole source in slabs; the same for any slab height and thread count. Advances `progress` by voxels.
/// Errors: those of the source, kCancelled.
Result<ValueCounts> count_values(SlabSource& source, Progress& progress);

/// Equal bins over [low, low + width * mass.size()).
struct Histogram {
  double low = 0.0, width = 0.0;
  std::vector<double> mass;  ///< voxels per bin; fractions where a value is shared between bins
  double total = 0.0;        ///< all finite voxels, also those outside the bins

  double centre(double bin) const noexcept { return low + (bin + 0.5) * width; }
};

/// Bins over the range that leaves `tail` of the values out on either side, widened by 2 % (`tail` 0.01 %,
/// 2,048 bins). Values that come in steps (integer scans) are spread over their step, so that no comb of empty bins
/// remains; a step wider than 1/32 of the range is taken as a gap. A volume with one value has width 0 and no bins.
Histogram make_histogram(std::span<const ValueCounts::Value> values, int bins = 2048, double tail = 1e-4);
inline Histogram make_histogram(const ValueCounts& counts, int bins = 2048, double tail = 1e-4) {
  return make_histogram(counts.values(), bins, tail);
}

}  // namespace dubsar
