#include "core/contact/uncross.h"

#include <algorithm>

#include "core/mesh/intersections.h"

namespace dubsar {

std::int64_t uncross(const SurfaceModel& model, const std::vector<BandFace>& faces, const std::vector<glm::vec3>& home,
                     InterfaceMesh& mesh) {
  constexpr int kRounds = 5;  // half of the way home, then all of it
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  std::vector<Triangle> triangles = mesh.triangles;
  for (const BandFace& face : faces) {
    const Polygon polygon = model.mesh.polygon(face.quad);
    for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.size); ++i)
      triangles.push_back({polygon.vertex[0], polygon.vertex[i - 1], polygon.vertex[i]});
  }
  const auto own = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<glm::vec3> positions = model.mesh.positions;
  positions.insert(positions.end(), mesh.added.begin(), mesh.added.end());
  std::int64_t first = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::uint32_t> crossing;
    for (const auto& [a, b] : self_intersections(positions, triangles)) {
      if (a < own) crossing.push_back(a);
      if (b < own) crossing.push_back(b);
    }
    std::sort(crossing.begin(), crossing.end());
    crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
    if (round == 0) first = static_cast<std::int64_t>(crossing.size());
    if (crossing.empty()) break;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : crossing)
      for (const std::uint32_t v : triangles[t])
        if (v >= dual) vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const float share = round < 2 ? 0.5f : 1.0f;
    for (const std::uint32_t v : vertices) {
      glm::vec3& p = positions[v];
      p += share * (home[v - dual] - p);
    }
  }
  std::copy(positions.begin() + dual, positions.end(), mesh.added.begin());
  return first;
}

}  // namespace dubsar
