#include "core/compare/surface_difference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

struct WeighedAmount {
  double mm = 0.0, area = 0.0;
};

/// The amount below which this share of the area lies.
double amount_at(std::vector<WeighedAmount>& amounts, double share) {
  std::sort(amounts.begin(), amounts.end(), [](const auto& a, const auto& b) { return a.mm < b.mm; });
  double all = 0.0, walked = 0.0;
  for (const WeighedAmount& each : amounts) all += each.area;
  for (const WeighedAmount& each : amounts) {
    walked += each.area;
    if (walked >= share * all) return each.mm;
  }
  return 0.0;
}

}  // namespace

Result<SurfaceDifference> difference_of(const TriMesh& a, const TriMesh& b, double reach_mm, Progress& progress) {
  const NearestSurface surface(points_mm(a), a.triangles);
  SurfaceDifference out;
  DUBSAR_ASSIGN(out.alignment, align_surfaces(a, surface, b, progress));
  const std::vector<glm::dvec3> points = points_mm(b);
  std::vector<double> area(points.size(), 0.0);
  std::vector<std::uint8_t> inferred(points.size(), 0);
  for (std::size_t t = 0; t < b.triangles.size(); ++t) {
    const Triangle& f = b.triangles[t];
    const double third = glm::length(glm::cross(points[f[1]] - points[f[0]], points[f[2]] - points[f[0]])) / 6.0;
    for (const std::uint32_t v : f) {
      area[v] += std::isfinite(third) ? third : 0.0;
      if (!b.triangle_inferred.empty() && b.triangle_inferred[t] != 0) inferred[v] = 1;
    }
  }
  out.vertex_mm.assign(points.size(), std::numeric_limits<double>::quiet_NaN());
  progress.begin("compare", static_cast<std::int64_t>(points.size()), "vertex");
  parallel_for(static_cast<std::int64_t>(points.size()), 256, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    progress.advance(1);
    if (inferred[v] != 0 || progress.cancelled()) return;
    const glm::dvec3 p = out.alignment.a_from_b(points[v]);
    if (!std::isfinite(p.x + p.y + p.z)) return;
    const NearPlace near = surface.nearest(p, reach_mm);
    if (!(near.distance_mm <= reach_mm)) return;
    if (!a.triangle_inferred.empty() && a.triangle_inferred[near.triangle] != 0) return;
    const bool outside = glm::dot(p - near.at_mm, near.normal) >= 0;
    out.vertex_mm[v] = outside ? near.distance_mm : -near.distance_mm;
  });
  if (progress.cancelled()) return cancelled_error();
  progress.end();
  std::vector<WeighedAmount> amounts;
  double sum = 0.0, sum2 = 0.0, close = 0.0, near = 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const double mm = out.vertex_mm[v];
    if (std::isnan(mm)) {
      out.left_out_mm2 += area[v];
      continue;
    }
    out.compared_mm2 += area[v];
    sum += area[v] * mm;
    sum2 += area[v] * mm * mm;
    close += std::abs(mm) <= 0.05 ? area[v] : 0.0;
    near += std::abs(mm) <= 0.1 ? area[v] : 0.0;
    amounts.push_back({std::abs(mm), area[v]});
  }
  if (out.compared_mm2 > 0) {
    out.mean_mm = sum / out.compared_mm2;
    out.rms_mm = std::sqrt(sum2 / out.compared_mm2);
    out.within_05 = close / out.compared_mm2;
    out.within_10 = near / out.compared_mm2;
    out.median_mm = amount_at(amounts, 0.5);
    out.most_mm = amount_at(amounts, 0.99);
  }
  return out;
}

std::array<std::uint8_t, 3> difference_color(double mm, double range_mm) {
  if (std::isnan(mm)) return {128, 128, 128};
  // Ends of a scale that people who do not tell red from green read, too (blue and vermilion of Okabe and Ito).
  constexpr std::array<double, 3> kLess{0, 90, 178}, kMore{213, 70, 0}, kSame{245, 245, 245};
  const double share = std::clamp(std::abs(mm) / range_mm, 0.0, 1.0);
  const auto& end = mm < 0 ? kLess : kMore;
  std::array<std::uint8_t, 3> out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(kSame[c] + share * (end[c] - kSame[c])));
  return out;
}

}  // namespace dubsar
