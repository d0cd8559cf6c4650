#include "app/viewer/steering/picker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace dubsar::app {
namespace {

/// Distance along the ray, or infinity (T. Moeller, B. Trumbore: Fast, minimum storage ray-triangle intersection,
/// 1997).
double meets(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(ray.direction, ac);
  const double det = glm::dot(ab, p);
  if (det == 0.0) return kNever;
  const glm::dvec3 to = ray.from - a;
  const double beside = glm::dot(to, p);
  if (beside * det < 0.0 || std::abs(beside) > std::abs(det)) return kNever;  // most of them, without a division
  const double u = beside / det;
  if (!(u >= 0.0 && u <= 1.0)) return kNever;
  const glm::dvec3 q = glm::cross(to, ab);
  const double v = glm::dot(ray.direction, q) / det;
  if (!(v >= 0.0 && u + v <= 1.0)) return kNever;
  const double t = glm::dot(ac, q) / det;
  return t > 0.0 ? t : kNever;
}

}  // namespace

std::optional<Picked> pick(const TriMesh& mesh, const PartLooks& parts, const Ray& ray,
                           std::span<const ClipPlane> clips) {
  const auto kept = [&](double at) {
    return std::all_of(clips.begin(), clips.end(), [&](const ClipPlane& clip) {
      return glm::dot(clip.normal, ray.from + at * ray.direction - clip.point_mm) >= 0.0;
    });
  };
  const auto corner = [&](std::uint32_t v, const PartLook& part) {
    return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])) + part.offset_mm;
  };
  const auto part_of = [&](std::int64_t triangle) {
    const std::size_t id = mesh.partition_of(static_cast<std::size_t>(triangle));
    return id < parts.size() ? id : 0;
  };
  std::array<Ray, kMaxPartitions> rays;  // in the grid of each part, as far along as in mm
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const glm::dvec3 step = mesh.frame.grid_voxel_mm();
    rays[p] = {(ray.from - parts[p].offset_mm - mesh.frame.mm_from_grid(glm::dvec3(0.0))) / step, ray.direction / step};
  }
  double nearest = std::numeric_limits<double>::infinity();
  std::int64_t best = -1;
  const auto count = static_cast<std::int64_t>(mesh.triangles.size());
#pragma omp parallel
  {
    double mine = std::numeric_limits<double>::infinity();
    std::int64_t found = -1;
#pragma omp for schedule(static) nowait
    for (std::int64_t i = 0; i < count; ++i) {
      const Triangle& t = mesh.triangles[static_cast<std::size_t>(i)];
      const std::size_t part = part_of(i);
      if (!parts[part].visible) continue;
      const double at = meets(rays[part], glm::dvec3(mesh.positions[t[0]]), glm::dvec3(mesh.positions[t[1]]),
                              glm::dvec3(mesh.positions[t[2]]));
      if (at < mine && kept(at)) {
        mine = at;
        found = i;
      }
    }
#pragma omp critical(dubsar_pick)
    if (mine < nearest || (mine == nearest && found >= 0 && found < best)) {
      nearest = mine;
      best = found;
    }
  }
  if (best < 0) return std::nullopt;
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(best)];
  const PartLook& part = parts[part_of(best)];
  const glm::dvec3 a = corner(t[0], part), b = corner(t[1], part), c = corner(t[2], part);
  return Picked{ray.from + nearest * ray.direction, glm::normalize(glm::cross(b - a, c - a)),
                static_cast<std::size_t>(best)};
}

}  // namespace dubsar::app
