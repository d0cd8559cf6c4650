#include "core/mesh_io/polygon_soup.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace dubsar {
namespace {
double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The polygon in a plane perpendicular to the largest part of its Newell normal, counter-clockwise.
std::vector<glm::dvec2> flattened(std::span<const glm::vec3> positions, std::span<const std::uint32_t> polygon) {
  const glm::dvec3 first(positions[polygon[0]]);
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    normal += glm::cross(glm::dvec3(positions[polygon[i]]) - first,
                         glm::dvec3(positions[polygon[(i + 1) % polygon.size()]]) - first);
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool flip = normal[axis] < 0.0;
  std::vector<glm::dvec2> flat;
  flat.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const glm::dvec3 p = glm::dvec3(positions[v]) - first;
    const double a = p[(axis + 1) % 3], b = p[(axis + 2) % 3];
    flat.push_back(flip ? glm::dvec2(b, a) : glm::dvec2(a, b));
  }
  return flat;
}

bool convex(std::span<const glm::dvec2> p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    if (cross(p[(i + 1) % n] - p[i], p[(i + 2) % n] - p[(i + 1) % n]) < 0.0) return false;
  return true;
}

bool inside(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& p) {
  return cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0;
}

void clip_ears(std::span<const std::uint32_t> polygon, std::span<const glm::dvec2> flat, std::vector<Triangle>& out) {
  std::vector<std::uint32_t> rest(polygon.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = static_cast<std::uint32_t>(i);
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = rest.size();
    const std::uint32_t a = rest[(i + n - 1) % n], b = rest[i], c = rest[(i + 1) % n];
    if (cross(flat[b] - flat[a], flat[c] - flat[b]) <= 0.0) return false;
    for (const std::uint32_t other : rest)
      if (other != a && other != b && other != c && inside(flat[a], flat[b], flat[c], flat[other])) return false;
    return true;
  };
  while (rest.size() > 3) {
    std::size_t ear = 0;
    while (ear < rest.size() && !is_ear(ear)) ++ear;
    if (ear == rest.size()) ear = 0;  // crosses itself: any cut is as good, the number of triangles stays right
    const std::size_t n = rest.size();
    out.push_back({polygon[rest[(ear + n - 1) % n]], polygon[rest[ear]], polygon[rest[(ear + 1) % n]]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  out.push_back({polygon[rest[0]], polygon[rest[1]], polygon[rest[2]]});
}
}  // namespace

Result<std::vector<Triangle>> triangulate_soup(std::span<const glm::vec3> positions, const PolygonSoup& soup,
                                               std::string_view what) {
  std::vector<Triangle> triangles;
  triangles.reserve(soup.corners.size() - 2 * soup.sizes.size());
  std::size_t first = 0;
  for (const std::uint32_t size : soup.sizes) {
    const auto polygon = std::span(soup.corners).subspan(first, size);
    first += size;
    if (size == 3) {
      triangles.push_back({polygon[0], polygon[1], polygon[2]});
      continue;
    }
    const std::vector<glm::dvec2> flat = flattened(positions, polygon);
    if (convex(flat)) {
      for (std::size_t i = 1; i + 1 < size; ++i) triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
    } else if (size <= kMaxConcaveCorners) {
      clip_ears(polygon, flat, triangles);
    } else {
      return fail(ErrorKind::kBadData, "{}: a non-convex polygon has {} corners, expected at most {}; triangulate it",
                  what, size, kMaxConcaveCorners);
    }
  }
  return triangles;
}

std::vector<PartitionId> triangle_partitions(const PolygonSoup& soup) {
  std::vector<PartitionId> of_triangle;
  for (std::size_t p = 0; p < soup.partitions.size(); ++p)
    of_triangle.insert(of_triangle.end(), soup.sizes[p] - 2, soup.partitions[p]);
  return of_triangle;
}

}  // namespace dubsar
