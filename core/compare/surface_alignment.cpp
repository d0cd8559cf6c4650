#include "core/compare/surface_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"
#include "core/mesh/tablet_frame.h"

namespace dubsar {
namespace {

constexpr int kAlignFew = 600, kAlignMany = 6000;   // places of b
constexpr int kAlignFirst = 15, kAlignRounds = 60;  // rounds of each attitude, of the best
constexpr double kAlignKept = 0.9;                  // share of the places that counts
constexpr double kAlignRest = 1e-6;                 // mm: b moves less, and rests

bool is_measured(const TriMesh& mesh, std::size_t triangle) {
  return mesh.triangle_inferred.empty() || mesh.triangle_inferred[triangle] == 0;
}

/// Places spread evenly by area: middles of triangles, each as often as its share asks.
std::vector<glm::dvec3> spread_places(const TriMesh& mesh, const std::vector<glm::dvec3>& points, int count) {
  const auto area_of = [&](std::size_t t) {
    const Triangle& f = mesh.triangles[t];
    const double area = 0.5 * glm::length(glm::cross(points[f[1]] - points[f[0]], points[f[2]] - points[f[0]]));
    return is_measured(mesh, t) && std::isfinite(area) ? area : 0.0;
  };
  double all = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) all += area_of(t);
  std::vector<glm::dvec3> out;
  if (!(all > 0)) return out;
  double walked = 0.0, next = 0.5 * all / count;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = area_of(t);
    const Triangle& f = mesh.triangles[t];
    for (int k = 0; walked + area > next; ++k, next += all / count) {
      // Places within a large triangle: by halves and thirds of its sides (van der Corput).
      double u = 0.0, v = 0.0, base2 = 0.5, base3 = 1.0 / 3.0;
      for (int n = k + 1; n > 0; n /= 2, base2 *= 0.5) u += base2 * (n % 2);
      for (int n = k + 1; n > 0; n /= 3, base3 /= 3.0) v += base3 * (n % 3);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      out.push_back(points[f[0]] + u * (points[f[1]] - points[f[0]]) + v * (points[f[2]] - points[f[0]]));
    }
    walked += area;
  }
  return out;
}

glm::dvec3 middle_of_places(const std::vector<glm::dvec3>& places) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : places) sum += p;
  return sum / std::max(1.0, static_cast<double>(places.size()));
}

struct AlignRound {
  RigidMotion motion;
  double rms_mm = 0.0, moved_mm = 0.0;
};

/// One round: nearest places, the best of them, their planes.
AlignRound align_round(const NearestSurface& surface, const std::vector<glm::dvec3>& places, const RigidMotion& now) {
  std::vector<PlanePair> pairs(places.size());
  std::vector<double> distance(places.size());
  parallel_for(static_cast<std::int64_t>(places.size()), 64, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    const glm::dvec3 p = now(places[k]);
    const NearPlace near = surface.nearest(p);
    pairs[k] = {p, near.at_mm, near.normal, 1.0};
    distance[k] = near.distance_mm;
  });
  std::vector<double> sorted = distance;
  const auto kept = static_cast<std::size_t>(kAlignKept * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept), sorted.end());
  const double most = sorted[kept];
  std::vector<PlanePair> best;
  double sum2 = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (distance[k] > most) continue;
    best.push_back(pairs[k]);
    sum2 += distance[k] * distance[k];
  }
  const RigidMotion step = motion_to_planes(best);
  double moved = 0.0;
  for (const PlanePair& pair : best) moved = std::max(moved, glm::length(step(pair.point) - pair.point));
  return {after(step, now), std::sqrt(sum2 / static_cast<double>(best.size())), moved};
}

}  // namespace

std::vector<glm::dvec3> points_mm(const TriMesh& mesh) {
  std::vector<glm::dvec3> out;
  out.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) out.push_back(mesh.frame.mm_from_grid(glm::dvec3(p)));
  return out;
}

Result<SurfaceAlignment> align_surfaces(const TriMesh& a, const NearestSurface& surface, const TriMesh& b,
                                        Progress& progress) {
  DUBSAR_ASSIGN(const TabletFrame frame_a, find_tablet_frame(a));
  DUBSAR_ASSIGN(const TabletFrame frame_b, find_tablet_frame(b));
  const std::vector<glm::dvec3> points_a = points_mm(a), points_b = points_mm(b);
  const glm::dvec3 middle_a = middle_of_places(spread_places(a, points_a, kAlignMany));
  const std::vector<glm::dvec3> few = spread_places(b, points_b, kAlignFew),
                                many = spread_places(b, points_b, kAlignMany);
  if (few.size() < 12 || surface.empty())
    return fail(ErrorKind::kBadData, "compare: one of the surfaces shows no clay that the scan measured");
  const glm::dvec3 middle_b = middle_of_places(many);
  SurfaceAlignment out;
  double best = std::numeric_limits<double>::max();
  int attitude = 0;
  progress.begin("align", 8 * kAlignFirst + kAlignRounds, "round");
  for (const bool over : {false, true})
    for (const FrameTurn turn : {FrameTurn::kNone, FrameTurn::kHalf, FrameTurn::kLeft, FrameTurn::kRight}) {
      TabletFrame lies = turned(frame_b, turn);
      if (over) lies = turned(lies, FrameTurn::kOver);
      RigidMotion motion;
      motion.turn = glm::transpose(frame_a.tablet_from_model()) * lies.tablet_from_model();
      motion.shift = middle_a - motion.turn * middle_b;
      AlignRound round{motion, 0.0, 0.0};
      for (int k = 0; k < kAlignFirst; ++k) {
        if (progress.cancelled()) return cancelled_error();
        round = align_round(surface, few, round.motion);
        progress.advance(1);
      }
      if (round.rms_mm < best) {
        best = round.rms_mm;
        out = {round.motion, round.rms_mm, attitude};
      }
      ++attitude;
    }
  for (int k = 0; k < kAlignRounds; ++k) {
    if (progress.cancelled()) return cancelled_error();
    const AlignRound round = align_round(surface, many, out.a_from_b);
    out.a_from_b = round.motion;
    out.rms_mm = round.rms_mm;
    progress.advance(1);
    if (round.moved_mm < kAlignRest) break;
  }
  progress.end();
  return out;
}

}  // namespace dubsar
