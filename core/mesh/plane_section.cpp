#include "core/mesh/plane_section.h"

#include <glm/geometric.hpp>

namespace dubsar {

std::vector<SectionPiece> plane_section(const TriMesh& mesh, const glm::dvec3& at_mm, const glm::dvec3& normal) {
  const auto place = [&](std::uint32_t v) { return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])); };
  std::vector<double> height(mesh.positions.size());
  const glm::dvec3 n = glm::normalize(normal);
  for (std::size_t v = 0; v < height.size(); ++v) height[v] = glm::dot(n, place(static_cast<std::uint32_t>(v)) - at_mm);
  std::vector<SectionPiece> out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const int beyond = (height[corners[0]] >= 0) + (height[corners[1]] >= 0) + (height[corners[2]] >= 0);
    if (beyond == 0 || beyond == 3) continue;
    std::array<glm::dvec3, 2> ends{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
      if ((height[from] >= 0) == (height[to] >= 0)) continue;
      const double share = height[from] / (height[from] - height[to]);
      ends[found++] = place(from) + share * (place(to) - place(from));
    }
    out.push_back({ends[0], ends[1], t});
  }
  return out;
}

}  // namespace dubsar
