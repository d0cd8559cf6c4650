#include "core/rays/polar_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/rays/ring_field.h"

namespace dubsar {
namespace {

constexpr double kPolarInfinite = std::numeric_limits<double>::infinity();
/// Distances on either side that a ring stands out of; fewer sectors, or fewer voxels of one, say nothing.
constexpr std::int64_t kPolarReach = 6, kPolarLeastSectors = 3, kPolarLeastBeside = 5;
constexpr double kPolarLeastVoxels = 3.0;
/// Of a normal distribution: deviation a median deviation; error of a median a mean's.
constexpr double kOfMedian = 1.4826, kMedianError = 1.2533;

double median_in(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct SeenRing {
  double difference, weight;
  std::int64_t sector;
};

double weighted_median(std::vector<SeenRing>& seen) {
  std::sort(seen.begin(), seen.end(), [](const SeenRing& a, const SeenRing& b) { return a.difference < b.difference; });
  double all = 0.0, below = 0.0;
  for (const SeenRing& one : seen) all += one.weight;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    below += seen[i].weight;
    if (2.0 * below > all) return seen[i].difference;
    if (2.0 * below == all && i + 1 < seen.size()) return 0.5 * (seen[i].difference + seen[i + 1].difference);
  }
  return seen.back().difference;
}

/// How far a half of the turn is from all of it, of four halves.
double worst_half(const std::vector<SeenRing>& seen, double middle) {
  double worst = 0.0;
  std::vector<SeenRing> half;
  for (std::int64_t begin = 0; begin < PolarSlice::kSectors; begin += PolarSlice::kSectors / 4) {
    half.clear();
    for (const SeenRing& one : seen)
      if ((one.sector + PolarSlice::kSectors - begin) % PolarSlice::kSectors < PolarSlice::kSectors / 2)
        half.push_back(one);
    if (!half.empty()) worst = std::max(worst, std::abs(weighted_median(half) - middle));
  }
  return worst;
}

/// What a sector has more than around it, NaN where that is not seen.
std::vector<double> sector_differences(const PolarSums& sums, bool clay, std::int64_t sector) {
  const std::int64_t radii = sums.radii;
  std::vector<double> mean(static_cast<std::size_t>(radii), NAN), out = mean, around;
  for (std::int64_t r = 0; r < radii; ++r)
    if (const std::size_t i = sums.at(clay, sector, r); sums.weight[i] >= kPolarLeastVoxels)
      mean[static_cast<std::size_t>(r)] = sums.sum[i] / sums.weight[i];
  for (std::int64_t r = 0; r < radii; ++r) {
    if (std::isnan(mean[static_cast<std::size_t>(r)])) continue;
    around.clear();
    std::int64_t before = 0, behind = 0;
    for (std::int64_t k = std::max<std::int64_t>(0, r - kPolarReach); k <= std::min(radii - 1, r + kPolarReach); ++k) {
      if (k == r || std::isnan(mean[static_cast<std::size_t>(k)])) continue;
      around.push_back(mean[static_cast<std::size_t>(k)]);
      ++(k < r ? before : behind);
    }
    if (before + behind < kPolarLeastBeside || std::min(before, behind) == 0) continue;
    around.push_back(mean[static_cast<std::size_t>(r)]);
    out[static_cast<std::size_t>(r)] = mean[static_cast<std::size_t>(r)] - median_in(around);
  }
  return out;
}

}  // namespace

PolarSlice::PolarSlice(const Dims& dims, const glm::dvec2& centre)
    : dims_(dims),
      radii_(radii_of(dims, centre)),
      radius_(static_cast<std::size_t>(dims.slice())),
      sector_(static_cast<std::size_t>(dims.slice())) {
  for (std::int64_t y = 0; y < dims.y; ++y)
    for (std::int64_t x = 0; x < dims.x; ++x) {
      const double along = static_cast<double>(x) - centre.x, across = static_cast<double>(y) - centre.y;
      const auto i = static_cast<std::size_t>(y * dims.x + x);
      radius_[i] = static_cast<float>(std::hypot(along, across));
      const double turn = std::atan2(across, along) / (2.0 * std::numbers::pi) + 0.5;
      sector_[i] = static_cast<std::uint8_t>(
          std::min<std::int64_t>(static_cast<std::int64_t>(turn * static_cast<double>(kSectors)), kSectors - 1));
    }
}

void PolarSlice::add(std::span<const float> slice, std::span<const Material> sure, PolarSums& sums) const {
  const std::int64_t half_x = dims_.x / 2, half_y = dims_.y / 2;
  for (std::int64_t y = 0; y < 2 * half_y; ++y)
    for (std::int64_t x = 0; x < 2 * half_x; ++x) {
      const Material material = sure[static_cast<std::size_t>(y / 2 * half_x + x / 2)];
      if (material == Material::kUnsure) continue;
      const auto i = static_cast<std::size_t>(y * dims_.x + x);
      const auto ring = static_cast<std::int64_t>(radius_[i]);
      const double t = radius_[i] - static_cast<float>(ring), value = slice[i];
      const std::size_t at = sums.at(material == Material::kClay, sector_[i], ring);
      sums.sum[at] += (1.0 - t) * value;
      sums.weight[at] += 1.0 - t;
      sums.sum[at + 1] += t * value;
      sums.weight[at + 1] += t;
    }
}

void PolarSums::add(const PolarSums& other) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other.sum[i], weight[i] += other.weight[i];
}

PolarSums PolarSums::half_from(std::int64_t first_sector) const {
  PolarSums half = *this;
  for (const bool clay : {false, true})
    for (std::int64_t sector = PolarSlice::kSectors / 2; sector < PolarSlice::kSectors; ++sector)
      for (std::int64_t r = 0; r < radii; ++r)
        half.weight[at(clay, (first_sector + sector) % PolarSlice::kSectors, r)] = 0.0;
  return half;
}

std::array<AngularConstants, 3> constants_over_angles(const PolarSums& sums) {
  const auto radii = static_cast<std::size_t>(sums.radii);
  std::array<std::vector<std::vector<SeenRing>>, 2> seen;
  for (auto& of : seen) of.resize(radii);
  for (const bool clay : {false, true})
    for (std::int64_t sector = 0; sector < PolarSlice::kSectors; ++sector) {
      const std::vector<double> found = sector_differences(sums, clay, sector);
      for (std::size_t r = 0; r < radii; ++r)
        if (!std::isnan(found[r]))
          seen[clay ? 1 : 0][r].push_back(
              {found[r], sums.weight[sums.at(clay, sector, static_cast<std::int64_t>(r))], sector});
    }
  std::array<AngularConstants, 3> out;
  for (AngularConstants& one : out)
    one = {std::vector<double>(radii), std::vector<double>(radii, kPolarInfinite), std::vector<double>(radii)};
  std::vector<double> off;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t r = 0; r < radii; ++r) {
      if (static_cast<std::int64_t>(seen[k][r].size()) < kPolarLeastSectors) continue;
      const double middle = out[k].value[r] = weighted_median(seen[k][r]);
      for (const SeenRing& one : seen[k][r]) off.push_back(std::abs(one.difference - middle) * std::sqrt(one.weight));
    }
  const double noise = off.empty() ? 0.0 : kOfMedian * median_in(off);  // of a voxel
  const auto judge = [&](std::vector<SeenRing>& values, AngularConstants& to, std::size_t r) {
    if (static_cast<std::int64_t>(values.size()) < kPolarLeastSectors) return;
    to.value[r] = weighted_median(values);
    double weight = 0.0, squares = 0.0;
    for (const SeenRing& one : values) {
      weight += one.weight;
      squares += one.weight * (one.difference - to.value[r]) * (one.difference - to.value[r]);
    }
    // Of a voxel's noise, or where sectors differ by more than that, of theirs.
    to.error[r] = kMedianError *
                  std::max(noise / std::sqrt(weight), std::sqrt(squares / weight / static_cast<double>(values.size())));
    to.uneven[r] = worst_half(values, to.value[r]);
  };
  for (std::size_t r = 0; r < radii; ++r) {
    judge(seen[0][r], out[0], r);
    judge(seen[1][r], out[1], r);
    std::vector<SeenRing> both = seen[0][r];
    both.insert(both.end(), seen[1][r].begin(), seen[1][r].end());
    judge(both, out[2], r);
  }
  return out;
}

}  // namespace dubsar
