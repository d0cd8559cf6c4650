// How deep a wedge is below the surface that the scribe wrote on.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/mesh/level_ground.h"
#include "core/mesh/surface_measure.h"

namespace dubsar {
namespace {

constexpr std::size_t kLeastVertices = 30;
constexpr double kWindowMm = 0.35;       // within which a way down is looked for
constexpr double kWindowSpacings = 1.6;  // on coarser surfaces
/// As far as that the ground is looked at, in depths of the impression, but not beyond kMostRadiusMm: of wide ones
/// there is too little ground within the radius that was asked for.
constexpr double kRadiusDepths = 3.5, kMostRadiusMm = 12.0;

/// Shares of what is known that make the standard deviation. The last two were chosen on three phantoms (wedges of 5
/// and 7 voxels, 14 and 25 dB, blurs of .45 and .6 voxel) so that 95 % of the wedges lie within two of them.
constexpr double kGroundDoubt = 0.5, kFilledDoubt = 0.4, kSpacingDoubt = 0.37, kDepthDoubt = 0.075;

/// The deepest vertex that a way down leads to from the one nearest to the place.
std::size_t bottom_of(const std::vector<GroundSample>& samples, const std::vector<double>& depths,
                      const glm::dvec3& place_mm, double window_mm) {
  const auto far2 = [&](std::size_t i, const glm::dvec3& p) {
    return glm::dot(samples[i].at_mm - p, samples[i].at_mm - p);
  };
  std::size_t bottom = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (far2(i, place_mm) < far2(bottom, place_mm)) bottom = i;
  for (bool down = true; std::exchange(down, false);) {
    const glm::dvec3 from = samples[bottom].at_mm;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (depths[i] > depths[bottom] && far2(i, from) < window_mm * window_mm) {
        bottom = i;
        down = true;
      }
  }
  return bottom;
}

/// How much the bottom is bent, 1/mm: the sum of its two principal curvatures, of a sheet through what lies within some
/// vertices of it, nearer ones counting more; 0 where it is not hollow.
double hollow_bend(const Neighbourhood& around, const std::vector<double>& depths, std::size_t bottom) {
  const double window = around.spacing_mm;
  const GroundSample& deepest = around.samples[bottom];
  double u = deepest.u, v = deepest.v, bend = 0.0;
  for (int round = 0; round < 4; ++round) {  // to the deepest place of the sheet itself
    SheetEquations equations;
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const double x = (around.samples[i].u - u) / window, y = (around.samples[i].v - v) / window;
      const double far2 = x * x + y * y;
      if (far2 < 9.0)
        equations.add(sheet_terms(x, y), depths[i] / window, around.samples[i].area * std::exp(-0.5 * far2));
    }
    equations.regularize();
    const auto sheet = equations.solved();
    if (!sheet) return 0.0;
    const auto [level, along_u, along_v, uu, uv, vv] = *sheet;
    bend = std::max(0.0, -2.0 * (uu + vv)) / window;
    const double a = 2 * uu, b = uv, c = 2 * vv, determinant = a * c - b * b;
    if (!(a < 0) || !(determinant > 0)) break;
    glm::dvec2 step((b * along_v - c * along_u) / determinant, (b * along_u - a * along_v) / determinant);
    step *= std::min(1.0, 0.7 / std::max(glm::length(step), 1e-12));
    u += window * step.x;
    v += window * step.y;
  }
  return bend;
}

/// How much deeper a bottom was before a blur of this variance (mm2) filled it. A blur moves a surface as heat spreads:
/// the bottom rises by half of its bend for each unit of variance, and bends the less the farther that has gone: the
/// inverse square of the bend of a rounded cone grows in proportion to the variance. kStraightening is that proportion,
/// from phantoms with wedges of 3 to 10 voxels.
double filled_by_blur(double bend, double variance_mm2) {
  constexpr double kStraightening = 0.9;
  if (!(bend > 0) || !(variance_mm2 > 0)) return 0.0;
  const double gone = std::min(1.0, kStraightening * variance_mm2 * bend * bend);
  return variance_mm2 * bend / (1.0 + std::sqrt(1.0 - gone));
}

}  // namespace

Result<ImpressionDepth> impression_depth(const TriMesh& mesh, const SurfacePlace& place, const DepthOptions& options) {
  if (!(options.radius_mm > 0) || !std::isfinite(options.radius_mm))
    return fail(ErrorKind::kUsage, "depth: a radius of {} mm found, expected more than 0", options.radius_mm);
  ImpressionDepth out;
  for (double radius = options.radius_mm;;) {
    const Neighbourhood around = neighbourhood(mesh, place, radius);
    const std::vector<GroundSample>& samples = around.samples;
    if (samples.size() < kLeastVertices)
      return fail(ErrorKind::kUsage, "depth: {} vertices lie within {} mm, expected at least {}", samples.size(),
                  radius, kLeastVertices);
    const LevelGround ground(around, radius);
    std::vector<double> depths;
    for (const GroundSample& sample : samples) depths.push_back(ground.depth(sample));
    const std::size_t bottom =
        bottom_of(samples, depths, place.at_mm, std::max(kWindowMm, kWindowSpacings * around.spacing_mm));
    const double seen = std::max(0.0, depths[bottom]);
    const double wanted = std::min(kRadiusDepths * seen, kMostRadiusMm);
    if (wanted > 1.1 * radius) {
      radius = wanted;
      continue;
    }
    out.filled_mm = seen > 0 ? filled_by_blur(hollow_bend(around, depths, bottom), options.blur_mm2) : 0.0;
    out.depth_mm = seen + out.filled_mm;
    out.uncertainty_mm = std::hypot(std::hypot(kGroundDoubt * ground.roughness_mm(), kFilledDoubt * out.filled_mm),
                                    kSpacingDoubt * around.spacing_mm, kDepthDoubt * out.depth_mm);
    const glm::dvec2 slope = ground.slope(samples[bottom].u, samples[bottom].v);
    out.outward = glm::normalize(around.out - around.right * slope.x - around.up * slope.y);
    out.rim_mm = samples[bottom].at_mm + seen * out.outward;
    out.bottom_mm = out.rim_mm - out.depth_mm * out.outward;
    out.level_share = ground.share();
    return out;
  }
}

}  // namespace dubsar
