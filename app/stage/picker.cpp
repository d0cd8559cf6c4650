#include "app/stage/picker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
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

/// Does the ray come through a box before `end`? Boxes are a little wider, so that rounding loses nothing.
bool enters(const Ray& ray, const glm::vec3& low, const glm::vec3& high, double end) {
  constexpr double kWider = 1e-3;  // grid steps
  double from = 0.0;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    const double a = static_cast<double>(low[axis]) - kWider, b = static_cast<double>(high[axis]) + kWider;
    if (ray.direction[axis] == 0.0) {
      if (ray.from[axis] < a || ray.from[axis] > b) return false;
      continue;
    }
    const double one = (a - ray.from[axis]) / ray.direction[axis], other = (b - ray.from[axis]) / ray.direction[axis];
    from = std::max(from, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  return from <= end;
}

constexpr std::size_t kRun = 128;  ///< triangles

}  // namespace

Picker::Picker(const TriMesh& mesh) : mesh_(mesh), runs_((mesh.triangles.size() + kRun - 1) / kRun) {
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    Run run{glm::vec3(std::numeric_limits<float>::infinity()), glm::vec3(-std::numeric_limits<float>::infinity()), 255,
            0};
    for (std::size_t t = kRun * r; t < std::min(kRun * (r + 1), mesh.triangles.size()); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) {
        run.low = glm::min(run.low, mesh.positions[v]);
        run.high = glm::max(run.high, mesh.positions[v]);
      }
      run.first_part = std::min(run.first_part, mesh.partition_of(t));
      run.last_part = std::max(run.last_part, mesh.partition_of(t));
    }
    runs_[r] = run;
  }
}

std::optional<Picked> Picker::pick(const PartLooks& parts, const Ray& ray, std::span<const ClipPlane> clips) const {
  const auto kept = [&](double at) {
    return std::all_of(clips.begin(), clips.end(), [&](const ClipPlane& clip) {
      return glm::dot(clip.normal, ray.from + at * ray.direction - clip.point_mm) >= 0.0;
    });
  };
  const auto corner = [&](std::uint32_t v, const PartLook& part) {
    return mesh_.frame.mm_from_grid(glm::dvec3(mesh_.positions[v])) + part.offset_mm;
  };
  const auto look_of = [&](std::size_t partition) { return partition < parts.size() ? partition : 0; };
  const auto part_of = [&](std::size_t triangle) { return look_of(mesh_.partition_of(triangle)); };
  std::array<Ray, kMaxPartitions> rays;  // in the grid of each part, as far along as in mm
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const glm::dvec3 step = mesh_.frame.grid_voxel_mm();
    rays[p] = {(ray.from - parts[p].offset_mm - mesh_.frame.mm_from_grid(glm::dvec3(0.0))) / step,
               ray.direction / step};
  }
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> best;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Run& run = runs_[r];
    bool through = false;
    for (std::size_t id = run.first_part; id <= run.last_part && !through; ++id) {
      const std::size_t part = look_of(id);
      through = parts[part].visible && enters(rays[part], run.low, run.high, nearest);
    }
    if (!through) continue;
    for (std::size_t i = kRun * r; i < std::min(kRun * (r + 1), mesh_.triangles.size()); ++i) {
      const Triangle& t = mesh_.triangles[i];
      const std::size_t part = part_of(i);
      if (!parts[part].visible) continue;
      const double at = meets(rays[part], glm::dvec3(mesh_.positions[t[0]]), glm::dvec3(mesh_.positions[t[1]]),
                              glm::dvec3(mesh_.positions[t[2]]));
      if (at < nearest && kept(at)) {
        nearest = at;
        best = i;
      }
    }
  }
  if (!best) return std::nullopt;
  const Triangle& t = mesh_.triangles[*best];
  const PartLook& part = parts[part_of(*best)];
  const glm::dvec3 a = corner(t[0], part), b = corner(t[1], part), c = corner(t[2], part);
  return Picked{ray.from + nearest * ray.direction, glm::normalize(glm::cross(b - a, c - a)), *best};
}

}  // namespace dubsar::app
