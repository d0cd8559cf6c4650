#include "input/tracking/hands/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

constexpr double kTipReach = 1.75;  // in palm radii: what reaches this far is a finger

glm::dvec2 rotated(const glm::dvec2& v, double angle) {
  return {v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle)};
}

}  // namespace

std::optional<Silhouette> outline(std::span<const std::uint8_t> labels, int width, int height, const Region& region,
                                  std::vector<float>& distance) {
  const auto inside = [&](const glm::dvec2& pixel) {
    const int x = static_cast<int>(std::lround(pixel.x)), y = static_cast<int>(std::lround(pixel.y));
    return x >= 0 && y >= 0 && x < width && y < height &&
           labels[static_cast<std::size_t>(y * width + x)] == region.label;
  };
  distance_inside(labels, width, height, region, distance);
  const int w = region.x1 - region.x0 + 2, h = region.y1 - region.y0 + 2;
  float thickest = 0.0F;
  std::vector<float> row_best(static_cast<std::size_t>(h));
  for (int y = 0; y < h; ++y) {
    const float* row = distance.data() + y * w;
    row_best[static_cast<std::size_t>(y)] = *std::max_element(row, row + w);
    thickest = std::max(thickest, row_best[static_cast<std::size_t>(y)]);
  }
  // The arm may be as thick as the palm, but a wrist lies between: from the fingers' side up, the first thick
  // place that is followed by a narrower one.
  float radius = 0.0F;
  int palm_row = 0;
  for (int y = h - 1; y >= 0; --y) {
    const float here = row_best[static_cast<std::size_t>(y)];
    if (here > radius) {
      radius = here;
      palm_row = y;
    } else if (radius > 0.5F * thickest && here < 0.92F * radius) {
      break;
    }
  }
  if (radius < 3.0F) return std::nullopt;
  const float* row = distance.data() + palm_row * w;
  const int palm_column = static_cast<int>(std::max_element(row, row + w) - row);

  Silhouette s;
  s.radius_px = static_cast<double>(radius);
  glm::dvec2 sum(0.0);
  double weight = 0.0;
  const int near = static_cast<int>(0.7F * radius);
  for (int y = std::max(0, palm_row - near); y <= std::min(h - 1, palm_row + near); ++y)
    for (int x = std::max(0, palm_column - near); x <= std::min(w - 1, palm_column + near); ++x) {
      const float d = distance[static_cast<std::size_t>(y * w + x)];
      if (d <= 0.85F * radius) continue;
      const double share = static_cast<double>(d - 0.85F * radius);
      sum += share * glm::dvec2(x, y);
      weight += share;
    }
  s.palm_px = sum / weight + glm::dvec2(region.x0 - 1, region.y0 - 1);

  // The arm: the widest run of the silhouette along circles around the palm, on the user's side (up in the
  // picture).
  constexpr int kDirections = 180;
  glm::dvec2 arm(0.0);
  for (const double circle : {1.5, 1.8, 2.1}) {
    std::array<bool, kDirections> in{};
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      in[static_cast<std::size_t>(i)] =
          inside(s.palm_px + circle * s.radius_px * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    double best = 0.0;
    glm::dvec2 best_direction(0.0);
    for (int i = 0; i < kDirections; ++i) {
      if (!in[static_cast<std::size_t>(i)] || in[static_cast<std::size_t>((i + kDirections - 1) % kDirections)])
        continue;
      int length = 0;
      while (length < kDirections && in[static_cast<std::size_t>((i + length) % kDirections)]) ++length;
      const double middle = 2.0 * std::numbers::pi * (i + 0.5 * (length - 1)) / kDirections;
      const glm::dvec2 direction(std::cos(middle), std::sin(middle));
      const double score = length * (0.5 - direction.y);  // nothing of what points well to the fingers' side
      if (score > best) {
        best = score;
        best_direction = direction;
      }
    }
    arm += best_direction;
  }
  s.arm_seen = glm::length(arm) > 1.0;
  s.forward = s.arm_seen ? -glm::normalize(arm) : glm::dvec2(0.0, 1.0);

  // How far the silhouette reaches in every direction of the fingers' side.
  constexpr int kRays = 121;  // -120 to 120 degrees
  std::array<double, kRays> reach{};
  for (int i = 0; i < kRays; ++i) {
    const glm::dvec2 direction = rotated(s.forward, (2.0 * i - 120.0) * kRadPerDeg);
    double r = 0.8 * s.radius_px;
    while (r < 4.0 * s.radius_px && inside(s.palm_px + r * direction)) r += 0.5;
    reach[static_cast<std::size_t>(i)] = r / s.radius_px;
  }
  std::array<double, 55> front{};  // -54 to 54 degrees: four fingers without the thumb
  std::copy_n(reach.begin() + 33, front.size(), front.begin());
  std::nth_element(front.begin(), front.begin() + 43, front.end());
  s.reach = front[43];

  for (int i = 1; i + 1 < kRays; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (reach[at] < kTipReach || s.finger_rad.size() == 5) continue;
    // One finger: the run of rays that stay within 85 % of its longest.
    std::size_t low = at, high = at;
    bool is_top = true;
    while (low > 0 && reach[low - 1] > 0.85 * reach[at]) is_top = (reach[--low] < reach[at]) && is_top;
    while (high + 1 < kRays && reach[high + 1] > 0.85 * reach[at]) is_top = (reach[++high] <= reach[at]) && is_top;
    if (!is_top || low == 0 || high + 1 == kRays) continue;
    s.finger_rad.push_back((static_cast<double>(low + high) - 120.0) * kRadPerDeg);
  }
  return s;
}

}  // namespace dubsar
