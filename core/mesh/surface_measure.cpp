#include "core/mesh/surface_measure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace dubsar {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

glm::dvec3 vertex_mm(const TriMesh& mesh, std::uint32_t v) {
  return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
}

std::array<glm::dvec3, 3> corners_mm(const TriMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {vertex_mm(mesh, t[0]), vertex_mm(mesh, t[1]), vertex_mm(mesh, t[2])};
}

/// Twice the area long.
glm::dvec3 area_normal(const std::array<glm::dvec3, 3>& c) { return glm::cross(c[1] - c[0], c[2] - c[0]); }

/// C. Ericson: Real-time collision detection, 2004, 5.1.5.
glm::dvec3 nearest_in(const std::array<glm::dvec3, 3>& c, const glm::dvec3& p) {
  const glm::dvec3 ab = c[1] - c[0], ac = c[2] - c[0], ap = p - c[0];
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return c[0];
  const glm::dvec3 bp = p - c[1];
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return c[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return c[0] + ab * (d1 / (d1 - d3));
  const glm::dvec3 cp = p - c[2];
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return c[0] + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return c[1] + (c[2] - c[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  return sum != 0 ? c[0] + ab * (vb / sum) + ac * (vc / sum) : c[0];
}

/// Mean of the faces' normals within `radius_mm` that look the same way as the place's own, by area.
glm::dvec3 broad_normal(const TriMesh& mesh, const SurfacePlace& place, double radius_mm) {
  glm::dvec3 sum = place.normal * 1e-12;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::dvec3 first = vertex_mm(mesh, mesh.triangles[t][0]) - place.at_mm;
    if (glm::dot(first, first) > radius_mm * radius_mm) continue;
    const glm::dvec3 normal = area_normal(corners_mm(mesh, t));
    if (glm::dot(normal, place.normal) > 0) sum += normal;
  }
  return glm::normalize(sum);
}

/// The section of a plane with a mesh, as a graph: each crossed edge is a place, each crossed triangle joins two.
class Section {
 public:
  Section(const TriMesh& mesh, const glm::dvec3& point, const glm::dvec3& normal) {
    const glm::dvec3 scale = mesh.frame.input_voxel.mm * mesh.frame.scale;
    const glm::dvec3 shift = mesh.frame.mm_from_grid(glm::dvec3(0.0));
    const glm::dvec3 n = normal * scale;  // of grid coordinates
    const double d = glm::dot(normal, shift - point);
    const auto height = [&](std::uint32_t v) { return glm::dot(n, glm::dvec3(mesh.positions[v])) + d; };
    for (const Triangle& t : mesh.triangles) {
      const std::array<double, 3> h{height(t[0]), height(t[1]), height(t[2])};
      const int above = (h[0] >= 0) + (h[1] >= 0) + (h[2] >= 0);  // what lies in it counts as above: no special cases
      if (above == 0 || above == 3) continue;
      std::array<std::uint32_t, 2> ends{};
      std::size_t found = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if ((h[k] >= 0) == (h[next] >= 0)) continue;
        const std::uint64_t low = std::min(t[k], t[next]), high = std::max(t[k], t[next]);
        const auto [at, fresh] = index_.try_emplace(low << 32 | high, static_cast<std::uint32_t>(places_.size()));
        if (fresh) {
          const double share = h[k] / (h[k] - h[next]);
          const glm::dvec3 a = vertex_mm(mesh, t[k]), b = vertex_mm(mesh, t[next]);
          places_.push_back(a + share * (b - a));
          joined_.emplace_back();
        }
        if (found < 2) ends[found++] = at->second;
      }
      segments_.push_back(ends);
    }
    for (std::uint32_t s = 0; s < segments_.size(); ++s)
      for (const std::uint32_t end : segments_[s]) joined_[end].push_back(s);
  }

  /// The segment that is nearest to a place.
  std::optional<std::uint32_t> nearest(const glm::dvec3& p) const {
    double best = kInf;
    std::optional<std::uint32_t> out;
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
      const glm::dvec3 a = places_[segments_[s][0]], ab = places_[segments_[s][1]] - a;
      const double t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-300), 0.0, 1.0);
      const glm::dvec3 off = p - a - t * ab;
      if (glm::dot(off, off) < best) {
        best = glm::dot(off, off);
        out = s;
      }
    }
    return out;
  }

  /// Places passed from segment `from`, left by its end `side`, until segment `to`; none when that is not reached.
  std::optional<std::vector<glm::dvec3>> walk(std::uint32_t from, std::size_t side, std::uint32_t to) const {
    std::vector<glm::dvec3> out;
    std::uint32_t segment = from, end = segments_[from][side];
    while (segment != to || out.empty()) {
      out.push_back(places_[end]);
      const auto& joined = joined_[end];
      if (joined.size() != 2) return std::nullopt;  // a border, or sheets that share an edge
      segment = joined[0] == segment ? joined[1] : joined[0];
      if (segment == to) return out;
      if (segment == from || out.size() > segments_.size()) return std::nullopt;
      end = segments_[segment][0] == end ? segments_[segment][1] : segments_[segment][0];
    }
    return out;
  }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> index_;  // of places by edges
  std::vector<glm::dvec3> places_;
  std::vector<std::array<std::uint32_t, 2>> segments_;
  std::vector<std::vector<std::uint32_t>> joined_;
};

}  // namespace

Result<SurfacePlace> nearest_place(const TriMesh& mesh, const glm::dvec3& point_mm) {
  double nearest = kInf;
  std::int64_t best = -1;
  const auto count = static_cast<std::int64_t>(mesh.triangles.size());
#pragma omp parallel
  {
    double mine = kInf;
    std::int64_t found = -1;
#pragma omp for schedule(static) nowait
    for (std::int64_t t = 0; t < count; ++t) {
      const glm::dvec3 off = nearest_in(corners_mm(mesh, static_cast<std::size_t>(t)), point_mm) - point_mm;
      if (const double far = glm::dot(off, off); far < mine) {
        mine = far;
        found = t;
      }
    }
#pragma omp critical(dubsar_nearest_place)
    if (mine < nearest || (mine == nearest && found >= 0 && found < best)) {
      nearest = mine;
      best = found;
    }
  }
  if (best < 0) return fail(ErrorKind::kBadData, "measure: the surface has no triangles");
  const auto corners = corners_mm(mesh, static_cast<std::size_t>(best));
  const glm::dvec3 normal = area_normal(corners);
  const double size = glm::length(normal);
  return SurfacePlace{nearest_in(corners, point_mm), size > 0 ? normal / size : glm::dvec3(0, 0, 1),
                      static_cast<std::size_t>(best)};
}

double angle_between_deg(const glm::dvec3& a, const glm::dvec3& apex, const glm::dvec3& b) {
  const glm::dvec3 u = a - apex, v = b - apex;
  if (u == glm::dvec3(0.0) || v == glm::dvec3(0.0)) return 0.0;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * 180.0 / std::numbers::pi;
}

double length_of(const std::vector<glm::dvec3>& path_mm) {
  double out = 0.0;
  for (std::size_t i = 1; i < path_mm.size(); ++i) out += glm::distance(path_mm[i - 1], path_mm[i]);
  return out;
}

double deepest_below_chord(const std::vector<glm::dvec3>& path_mm, const glm::dvec3& up) {
  if (path_mm.size() < 3) return 0.0;
  const glm::dvec3 chord = path_mm.back() - path_mm.front();
  const double size = glm::dot(chord, chord);
  if (size == 0) return 0.0;
  const glm::dvec3 across = glm::normalize(up - chord * (glm::dot(up, chord) / size));
  double deepest = 0.0;
  for (const glm::dvec3& p : path_mm) deepest = std::max(deepest, glm::dot(across, path_mm.front() - p));
  return deepest;
}

std::vector<glm::dvec3> section_between(const TriMesh& mesh, const SurfacePlace& a, const SurfacePlace& b) {
  const glm::dvec3 chord = b.at_mm - a.at_mm;
  const double straight = glm::length(chord);
  if (!(straight > 0)) return {a.at_mm, b.at_mm};
  constexpr double kAround = 0.15;  // of the distance: beyond the wedge that a place may lie in
  const glm::dvec3 up = broad_normal(mesh, a, kAround * straight) + broad_normal(mesh, b, kAround * straight);
  const glm::dvec3 normal = glm::cross(chord, up);
  if (!(glm::length(normal) > 1e-9 * straight)) return {};
  const Section section(mesh, a.at_mm, glm::normalize(normal));
  const auto from = section.nearest(a.at_mm), to = section.nearest(b.at_mm);
  if (!from || !to) return {};
  if (*from == *to) return {a.at_mm, b.at_mm};
  std::vector<glm::dvec3> best;
  for (const std::size_t side : {0u, 1u}) {
    auto way = section.walk(*from, side, *to);
    if (!way) continue;
    way->insert(way->begin(), a.at_mm);
    way->push_back(b.at_mm);
    if (best.empty() || length_of(*way) < length_of(best)) best = *std::move(way);
  }
  return best;
}

}  // namespace dubsar
