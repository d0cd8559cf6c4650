#include "core/relief/curvature/mesh_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace dubsar {
namespace {

constexpr double kCubeTolerance = 1e-6;
constexpr std::int64_t kTell = 1 << 16;

struct VertexFrame {
  glm::dvec3 u{0.0}, v{0.0}, n{0.0};
};

VertexFrame frame_of(const glm::dvec3& normal) {
  const glm::dvec3 aside = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(aside, normal));
  return {u, glm::cross(normal, u), normal};
}

/// A symmetric tensor of the plane: uu, uv, vv.
using Tensor = glm::dvec3;

/// From one tangent plane into another one, which is turned about the line that both share.
Tensor turned(const Tensor& t, const VertexFrame& from, const VertexFrame& to) {
  const double along = glm::dot(from.n, to.n);
  const glm::dvec3 axis = glm::cross(to.n, from.n);
  const auto tilt = [&](const glm::dvec3& x) {  // Rodrigues, from to.n to from.n
    if (along < -0.999) return -x;
    return x * along + glm::cross(axis, x) + axis * (glm::dot(axis, x) / (1.0 + along));
  };
  const glm::dvec3 u = tilt(to.u), v = tilt(to.v);
  const glm::dvec2 a(glm::dot(u, from.u), glm::dot(u, from.v)), b(glm::dot(v, from.u), glm::dot(v, from.v));
  const auto form = [&](const glm::dvec2& x, const glm::dvec2& y) {
    return x.x * (t.x * y.x + t.y * y.y) + x.y * (t.y * y.x + t.z * y.y);
  };
  return {form(a, a), form(a, b), form(b, b)};
}

/// Least squares of three edges, two equations each, in uu, uv, vv.
Tensor fitted(const std::array<glm::dvec2, 3>& edges, const std::array<glm::dvec2, 3>& turns) {
  double xx = 0, xy = 0, yy = 0;
  glm::dvec3 right(0.0);
  for (std::size_t e = 0; e < 3; ++e) {
    const glm::dvec2 d = edges[e], t = turns[e];
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
    right += glm::dvec3(d.x * t.x, d.y * t.x + d.x * t.y, d.y * t.y);
  }
  // [xx xy 0; xy xx+yy xy; 0 xy yy] . tensor = right
  const double middle = xx + yy, determinant = xx * (middle * yy - xy * xy) - xy * xy * yy;
  if (!(std::abs(determinant) > 1e-12 * middle * middle * middle)) return Tensor(0.0);
  const double uu = right.x * (middle * yy - xy * xy) - xy * (right.y * yy - xy * right.z);
  const double uv = xx * (right.y * yy - xy * right.z) - xy * right.x * yy;
  const double vv = xx * (middle * right.z - xy * right.y) - xy * xy * right.z + right.x * xy * xy;
  return Tensor(uu, uv, vv) / determinant;
}

bool has_own(const TriMesh& mesh) {
  const glm::dvec3 step = glm::abs(mesh.frame.grid_voxel_mm());
  return !mesh.k_min.empty() && mesh.k_min.size() == mesh.k_max.size() &&
         std::abs(step.x - step.y) <= kCubeTolerance * step.x && std::abs(step.x - step.z) <= kCubeTolerance * step.x;
}

std::vector<glm::dvec3> unit_normals(const TriMesh& mesh, const std::vector<glm::dvec3>& at, double sign) {
  std::vector<glm::dvec3> out(at.size(), glm::dvec3(0.0));
  if (!mesh.normals.empty())
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = glm::dvec3(mesh.normals[v]) / mesh.frame.grid_voxel_mm();
  else
    for (const Triangle& t : mesh.triangles) {
      const glm::dvec3 area = sign * glm::cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]]);
      for (const std::uint32_t v : t) out[v] += area;
    }
  for (glm::dvec3& n : out) {
    const double length = glm::length(n);
    n = length > 0 && std::isfinite(length) ? n / length : glm::dvec3(0, 0, 1);
  }
  return out;
}

}  // namespace

Result<MeshCurvatures> mesh_curvatures(const TriMesh& mesh, Progress& progress) {
  const std::size_t count = mesh.positions.size();
  const glm::dvec3 step = mesh.frame.grid_voxel_mm();
  MeshCurvatures out{std::vector<float>(count), std::vector<float>(count)};
  progress.begin("curvature", static_cast<std::int64_t>(mesh.triangles.size()), "triangle");
  if (has_own(mesh)) {
    const auto per_mm = static_cast<float>(1.0 / std::abs(step.x));
    for (std::size_t v = 0; v < count; ++v) {
      out.k_min[v] = mesh.k_min[v] * per_mm;
      out.k_max[v] = mesh.k_max[v] * per_mm;
    }
    progress.end();
    return out;
  }
  std::vector<glm::dvec3> at(count);
  for (std::size_t v = 0; v < count; ++v) at[v] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
  const double sign = step.x * step.y * step.z < 0 ? -1.0 : 1.0;
  const std::vector<glm::dvec3> normal = unit_normals(mesh, at, sign);
  std::vector<Tensor> tensor(count, Tensor(0.0));
  std::vector<double> weight(count, 0.0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kTell == 0 && i > 0) {
      if (progress.cancelled()) return cancelled_error();
      progress.advance(kTell);
    }
    const Triangle& t = mesh.triangles[i];
    const glm::dvec3 area = sign * glm::cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]]);
    const double size = glm::length(area);
    if (!(size > 0) || !std::isfinite(size)) continue;
    const VertexFrame frame = frame_of(area / size);
    std::array<glm::dvec2, 3> edges, turns;
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = t[(e + 1) % 3], b = t[(e + 2) % 3];
      const glm::dvec3 way = at[b] - at[a], turn = normal[b] - normal[a];
      edges[e] = {glm::dot(way, frame.u), glm::dot(way, frame.v)};
      turns[e] = {glm::dot(turn, frame.u), glm::dot(turn, frame.v)};
    }
    const Tensor own = fitted(edges, turns);
    for (const std::uint32_t v : t) {
      tensor[v] += size * turned(own, frame, frame_of(normal[v]));
      weight[v] += size;
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    if (!(weight[v] > 0)) continue;
    const Tensor t = tensor[v] / weight[v];
    const double mean = 0.5 * (t.x + t.z), half = std::hypot(0.5 * (t.x - t.z), t.y);
    out.k_min[v] = static_cast<float>(mean - half);
    out.k_max[v] = static_cast<float>(mean + half);
  }
  progress.end();
  return out;
}

}  // namespace dubsar
