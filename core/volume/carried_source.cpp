#include "core/volume/carried_source.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCarriedRows = 16;
constexpr std::size_t kSums = 4;  ///< move and weight

std::int64_t cell_of(float place, std::int64_t size) {
  return std::clamp(static_cast<std::int64_t>(std::floor(place)), std::int64_t{0}, size - 1);
}

/// Of the slopes to the value before and after one: the steeper, since a crossing lies on the steepest step of an edge
/// and moves with it; their mean where they point in different ways.
double slope_of(float before, float here, float after) {
  const double left = static_cast<double>(here) - before, right = static_cast<double>(after) - here;
  if (left * right <= 0.0) return 0.5 * (left + right);
  return std::abs(left) > std::abs(right) ? left : right;
}

}  // namespace

CarriedSource::CarriedSource(SlabSource& source, std::span<const glm::vec3> places, std::span<const glm::vec3> moves,
                             float share)
    : source_(&source), places_(places), moves_(moves), share_(share) {
  DUBSAR_CHECK(places.size() == moves.size());
  const Dims d = source.dims();
  const auto row_of = [&](const glm::vec3& p) {
    return static_cast<std::size_t>(cell_of(p.z, d.z) * d.y + cell_of(p.y, d.y));
  };
  first_.assign(static_cast<std::size_t>(d.y * d.z) + 1, 0);
  for (const glm::vec3& p : places) ++first_[row_of(p) + 1];
  for (std::size_t row = 1; row < first_.size(); ++row) first_[row] += first_[row - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  order_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) order_[next[row_of(places[i])]++] = static_cast<std::uint32_t>(i);
}

// In doubles, so that the order of places, in which the axes stand, does not matter once a value is a float again.
bool CarriedSource::gather(std::int64_t y, std::int64_t z, std::vector<double>& sums) const {
  constexpr auto kCells = static_cast<std::int64_t>(kReach);
  const Dims d = dims();
  bool any = false;
  for (std::int64_t cz = std::max<std::int64_t>(0, z - kCells - 1); cz <= std::min(z + kCells, d.z - 1); ++cz)
    for (std::int64_t cy = std::max<std::int64_t>(0, y - kCells - 1); cy <= std::min(y + kCells, d.y - 1); ++cy) {
      const auto row = static_cast<std::size_t>(cz * d.y + cy);
      for (std::uint32_t k = first_[row]; k < first_[row + 1]; ++k) {
        const glm::vec3 &p = places_[order_[k]], &move = moves_[order_[k]];
        const double dy = p.y - static_cast<double>(y), dz = p.z - static_cast<double>(z), across = dy * dy + dz * dz;
        if (across >= kReach * kReach) continue;
        if (!any) std::fill(sums.begin(), sums.end(), 0.0);
        any = true;
        const std::int64_t middle = cell_of(p.x, d.x);
        for (std::int64_t x = std::max<std::int64_t>(0, middle - kCells); x <= std::min(middle + kCells + 1, d.x - 1);
             ++x) {
          const double dx = p.x - static_cast<double>(x), left = 1.0 - (across + dx * dx) / (kReach * kReach);
          if (left <= 0.0) continue;
          const double weight = left * left * left;
          double* const sum = &sums[kSums * static_cast<std::size_t>(x)];
          sum[0] += weight * move.x;
          sum[1] += weight * move.y;
          sum[2] += weight * move.z;
          sum[3] += weight;
        }
      }
    }
  return any;
}

Result<void> CarriedSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  const std::int64_t from = std::max<std::int64_t>(0, z_begin - 1), to = std::min(d.z, z_end + 1);
  slices_.resize(static_cast<std::size_t>((to - from) * d.slice()));
  DUBSAR_TRY(source_->read(from, to, slices_));
  const auto value = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return slices_[static_cast<std::size_t>((std::clamp<std::int64_t>(z, 0, d.z - 1) - from) * d.slice() +
                                            std::clamp<std::int64_t>(y, 0, d.y - 1) * d.x +
                                            std::clamp<std::int64_t>(x, 0, d.x - 1))];
  };
  parallel_chunks((z_end - z_begin) * d.y, kCarriedRows, [&](std::int64_t begin, std::int64_t end) {
    std::vector<double> sums(kSums * static_cast<std::size_t>(d.x));
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % d.y, z = z_begin + i / d.y;
      const float* const row = &slices_[static_cast<std::size_t>((z - from) * d.slice() + y * d.x)];
      float* const to_row = &out[static_cast<std::size_t>(i * d.x)];
      std::copy(row, row + d.x, to_row);
      if (!gather(y, z, sums)) continue;
      for (std::int64_t x = 0; x < d.x; ++x) {
        const double* const sum = &sums[kSums * static_cast<std::size_t>(x)];
        if (sum[3] <= 0.0) continue;
        const double along = sum[0] * slope_of(value(x - 1, y, z), row[x], value(x + 1, y, z)) +
                             sum[1] * slope_of(value(x, y - 1, z), row[x], value(x, y + 1, z)) +
                             sum[2] * slope_of(value(x, y, z - 1), row[x], value(x, y, z + 1));
        to_row[x] = static_cast<float>(row[x] - share_ * along / sum[3]);
      }
    }
  });
  return {};
}

}  // namespace dubsar
