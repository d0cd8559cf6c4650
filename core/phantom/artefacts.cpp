#include "core/phantom/artefacts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "core/phantom/random.h"

namespace dubsar::phantom {
namespace {

constexpr double kContrast = static_cast<double>(kClayDensity) - static_cast<double>(kAirDensity);
/// A streak: half of its width, how far it is seen along the axis (deviations, voxels), and how many begin in a slice.
constexpr double kStreakWidth = 1.2, kStreakThickness = 1.5, kStreaksPerSlice = 2.0;

std::vector<float> ring_profile(const PhantomOptions& options) {
  if (options.rings <= 0.0) return {};
  const auto columns = static_cast<std::size_t>(std::hypot(options.dims.x, options.dims.y) / 2.0 + 3.0);
  std::vector<float> profile(columns);
  Random random(options.seed, 0x72696e67);
  // A column in seven is off; uniform on [-a, a] has the deviation a / sqrt(3).
  const double range = options.rings * std::sqrt(3.0 * 7.0);
  for (float& gain : profile)
    gain = random.uniform() < 1.0 / 7.0
               ? static_cast<float>(random.uniform(-range, range)) * (kClayDensity - kAirDensity)
               : 0.0f;
  return profile;
}

}  // namespace

ScanArtefacts::ScanArtefacts(const PhantomOptions& options)
    : dims_(options.dims), cupping_(options.artefacts.cupping), rings_(ring_profile(options)) {
  if (options.artefacts.streaks <= 0.0) return;
  Random random(options.seed, 0x73747265616b);
  const glm::dvec2 middle{0.5 * static_cast<double>(dims_.x - 1), 0.5 * static_cast<double>(dims_.y - 1)};
  const auto dense_point = [&] {
    for (;;)
      if (const glm::dvec2 p{random.uniform(-1, 1), random.uniform(-1, 1)}; glm::dot(p, p) < 1.0)
        return middle + 0.8 * p * middle;
  };
  const auto count = static_cast<int>(kStreaksPerSlice * static_cast<double>(dims_.z));
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 a = dense_point(), b = dense_point();
    const double length = glm::length(b - a);
    const double z = random.uniform(-3.0 * kStreakThickness, static_cast<double>(dims_.z) + 3.0 * kStreakThickness);
    const double height = random.uniform(0.5, 1.5);
    if (length < 8.0) continue;
    lines_.push_back({a.x, a.y, z, -(b.y - a.y) / length, (b.x - a.x) / length, height});
  }
  std::sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.z < b.z; });
  // The mean square of the sum is that of all lines: over a line's profile and thickness 3/4 sqrt(pi) w and sqrt(pi) t.
  double squares = 0.0;
  const double pi = std::numbers::pi;
  for (const Line& line : lines_) {
    // As long as the grid is along it; all that a slice holds of it.
    const double along = std::min(static_cast<double>(dims_.x) / std::max(std::abs(line.across_y), 1e-9),
                                  static_cast<double>(dims_.y) / std::max(std::abs(line.across_x), 1e-9));
    squares +=
        line.height * line.height * along * 0.75 * std::sqrt(pi) * kStreakWidth * std::sqrt(pi) * kStreakThickness;
  }
  const double deviation = std::sqrt(squares / static_cast<double>(dims_.count()));
  if (deviation > 0.0) streak_height_ = options.artefacts.streaks * kContrast / deviation;
}

void ScanArtefacts::apply(std::int64_t y, std::int64_t z, std::span<float> row) const {
  const double x_middle = 0.5 * static_cast<double>(dims_.x - 1), y_middle = 0.5 * static_cast<double>(dims_.y - 1);
  const double off = static_cast<double>(y) - y_middle;
  if (cupping_ > 0.0)
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double across = (static_cast<double>(i) - x_middle) / x_middle,
                   radius2 = across * across + off * off / (y_middle * y_middle);
      row[i] *= static_cast<float>(1.0 - cupping_ * std::max(1.0 - radius2, 0.0));
    }
  constexpr double kReach = 4.0;  // deviations
  const auto here = static_cast<double>(z);
  auto line = std::lower_bound(lines_.begin(), lines_.end(), here - kReach * kStreakThickness,
                               [](const Line& l, double from) { return l.z < from; });
  for (; line != lines_.end() && line->z <= here + kReach * kStreakThickness; ++line) {
    const double up = (here - line->z) / kStreakThickness;
    const double height = streak_height_ * line->height * std::exp(-0.5 * up * up);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double t =
          ((static_cast<double>(i) - line->x) * line->across_x + (static_cast<double>(y) - line->y) * line->across_y) /
          kStreakWidth;
      if (std::abs(t) < kReach) row[i] -= static_cast<float>(height * (1.0 - t * t) * std::exp(-0.5 * t * t));
    }
  }
  if (rings_.empty()) return;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double radius = std::hypot(static_cast<double>(i) - x_middle, off);
    const auto column = static_cast<std::size_t>(radius);
    const auto t = static_cast<float>(radius - static_cast<double>(column));
    row[i] += (1.0f - t) * rings_[column] + t * rings_[column + 1];
  }
}

}  // namespace dubsar::phantom
