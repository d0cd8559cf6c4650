#include "core/rays/lane_ramp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

using kernels::kLanes;

/// Bins of a cell of what is far, where it begins and where all of it is taken so: at 64 bins the smooth weights are
/// those of a cell's middle, to second order, within 2e-4.
constexpr std::int64_t kCell = 8, kFarFrom = 64, kFarAll = 128;
constexpr std::int64_t kLeastBinsOfFar = 512;
constexpr std::int64_t kCellsBeyond = 2;  ///< that interpolation between cells needs at either end

/// Share of a weight that is taken from cells: none up to kFarFrom, all of it from kFarAll on, smooth in between.
double share_of_cells(double distance) {
  const double t = std::clamp((distance - kFarFrom) / (kFarAll - kFarFrom), 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

double smooth_weight(double distance) {
  if (distance <= kFarFrom) return 0.0;
  return -share_of_cells(distance) / (2.0 * std::numbers::pi * std::numbers::pi * distance * distance);
}

}  // namespace

LaneRamp::LaneRamp(std::int64_t bins) : bins_(bins), reach_(bins | 1) {
  const bool cells = bins >= kLeastBinsOfFar;
  if (cells) {
    reach_ = kFarAll + 1;
    cells_ = (bins + kCell - 1) / kCell;
    // A cell blurs by the variance of its bins, which its weights take back.
    constexpr double kVariance = (kCell * kCell - 1) / 12.0;
    for (std::int64_t k = 0; k < cells_ + 2 * kCellsBeyond + kernels::kFarOutputs; ++k) {
      const auto at = static_cast<double>(k * kCell);
      const double bend = smooth_weight(at - 1.0) - 2.0 * smooth_weight(at) + smooth_weight(at + 1.0);
      far_.push_back(k == 0 ? 0.0F : static_cast<float>(smooth_weight(at) - 0.5 * kVariance * bend));
    }
  }
  for (std::int64_t n = 1; n < reach_ + 16; n += 2) {  // blocks of outputs look beyond the reach
    const double left = cells ? 1.0 - share_of_cells(static_cast<double>(n)) : 1.0;
    near_.push_back(static_cast<float>(-left / (std::numbers::pi * std::numbers::pi * static_cast<double>(n * n))));
  }
}

void LaneRamp::apply(const float* in, float* row) const {
  kernels::ramp_row(in, bins_, near_.data(), reach_, row);
  if (cells_ == 0) return;
  std::vector<float> sums(static_cast<std::size_t>(cells_ * kLanes), 0.0F);
  for (std::int64_t bin = 0; bin < bins_; ++bin) {
    float* const sum = sums.data() + bin / kCell * kLanes;
    for (std::int64_t lane = 0; lane < kLanes; ++lane) sum[lane] += in[bin * kLanes + lane];
  }
  const std::int64_t all = cells_ + 2 * kCellsBeyond;
  std::vector<float> from_cells(static_cast<std::size_t>((all + kernels::kFarOutputs) * kLanes));
  kernels::far_row(sums.data(), cells_, far_.data(), -kCellsBeyond, all, from_cells.data());
  for (std::int64_t part = 0; part < kCell; ++part) {
    // Bin kCell c + part lies that far from the middle of cell c.
    const double off = (static_cast<double>(part) - 0.5 * (kCell - 1)) / kCell;
    const kernels::CubicWeights weights(off - std::floor(off));
    const std::int64_t first = kCellsBeyond + static_cast<std::int64_t>(std::floor(off)) - 1;
    for (std::int64_t cell = 0; cell * kCell + part < bins_; ++cell) {
      float* const to = row + (cell * kCell + part) * kLanes;
      const float* const from = from_cells.data() + (first + cell) * kLanes;
      for (std::int64_t tap = 0; tap < 4; ++tap)
        for (std::int64_t lane = 0; lane < kLanes; ++lane)
          to[lane] += weights.of[static_cast<std::size_t>(tap)] * from[tap * kLanes + lane];
    }
  }
}

}  // namespace dubsar
