#include "core/compare/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/base/numbers/morton_code.h"

namespace dubsar {
namespace {
constexpr std::size_t kNearFan = 8;
}  // namespace

glm::dvec3 nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const glm::dvec3 bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const glm::dvec3 cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

double NearestSurface::Bounds::distance2(const glm::dvec3& p) const {
  const glm::dvec3 off = glm::max(glm::max(low - p, p - high), glm::dvec3(0.0));
  return glm::dot(off, off);
}

NearestSurface::NearestSurface(std::vector<glm::dvec3> points_mm, std::span<const Triangle> triangles)
    : points_(std::move(points_mm)), triangles_(triangles.begin(), triangles.end()) {
  Bounds all;
  std::vector<Bounds> bounds(triangles_.size());
  std::vector<std::uint32_t> kept;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t v : triangles_[t]) {
      bounds[t].low = glm::min(bounds[t].low, points_[v]);
      bounds[t].high = glm::max(bounds[t].high, points_[v]);
      sum += points_[v];
    }
    if (!std::isfinite(sum.x + sum.y + sum.z)) continue;
    kept.push_back(static_cast<std::uint32_t>(t));
    all.low = glm::min(all.low, bounds[t].low);
    all.high = glm::max(all.high, bounds[t].high);
  }
  const glm::dvec3 size = glm::max(all.high - all.low, glm::dvec3(1e-30));
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (const std::uint32_t t : kept) {
    const glm::dvec3 share = (0.5 * (bounds[t].low + bounds[t].high) - all.low) / size;
    keys.emplace_back(morton_code(glm::vec3(glm::clamp(share, 0.0, 1.0)) * 2097151.0f), t);
  }
  std::sort(keys.begin(), keys.end());
  for (const auto& [key, t] : keys) order_.push_back(t);
  levels_.emplace_back();
  for (const std::uint32_t t : order_) levels_[0].push_back(bounds[t]);
  while (levels_.back().size() > kNearFan) {
    const std::vector<Bounds>& below = levels_.back();
    std::vector<Bounds> level((below.size() + kNearFan - 1) / kNearFan);
    for (std::size_t i = 0; i < below.size(); ++i) {
      level[i / kNearFan].low = glm::min(level[i / kNearFan].low, below[i].low);
      level[i / kNearFan].high = glm::max(level[i / kNearFan].high, below[i].high);
    }
    levels_.push_back(std::move(level));
  }
}

void NearestSurface::look(std::size_t level, std::size_t begin, std::size_t end, const glm::dvec3& point,
                          NearPlace& best, double& best2) const {
  std::array<std::pair<double, std::size_t>, kNearFan> nearest{};
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) nearest[count++] = {levels_[level][i].distance2(point), i};
  std::sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const auto [bound2, i] = nearest[k];
    if (!(bound2 < best2)) return;
    if (level > 0) {
      look(level - 1, i * kNearFan, std::min((i + 1) * kNearFan, levels_[level - 1].size()), point, best, best2);
      continue;
    }
    const Triangle& t = triangles_[order_[i]];
    const glm::dvec3 at = nearest_on_triangle(point, points_[t[0]], points_[t[1]], points_[t[2]]);
    const double distance2 = glm::dot(point - at, point - at);
    if (!(distance2 < best2)) continue;
    best2 = distance2;
    best.at_mm = at;
    best.triangle = order_[i];
  }
}

NearPlace NearestSurface::nearest(const glm::dvec3& point, double within_mm) const {
  NearPlace best;
  if (empty()) return best;
  const double most = within_mm < 1e150 ? within_mm * within_mm : std::numeric_limits<double>::max();
  double best2 = most;
  const std::size_t top = levels_.size() - 1;
  look(top, 0, levels_[top].size(), point, best, best2);
  if (!(best2 < most)) return best;
  best.distance_mm = std::sqrt(best2);
  const Triangle& t = triangles_[best.triangle];
  const glm::dvec3 n = glm::cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
  const double length = glm::length(n);
  if (length > 0) best.normal = n / length;
  return best;
}

}  // namespace dubsar
