#include "app/publish/seen_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace dubsar::app {

void color_as_seen(TriMesh& mesh, const Style& style, const SurfaceFields* fields) {
  const auto table = color_table(style);
  constexpr std::size_t kOpen = kAoColumns - 1;
  const std::vector<std::array<std::uint8_t, 3>> own = std::move(mesh.colors);
  mesh.colors.assign(mesh.positions.size(), {});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (fields != nullptr && is_field(style.map)) {
      mesh.colors[v] = field_color(style, field_figure(style.map, fields->values[v]));
      continue;
    }
    const std::size_t shape = mesh.shape.empty() ? 0 : mesh.shape[v];
    const std::size_t ao = mesh.ao.empty() ? kOpen : std::min<std::size_t>(mesh.ao[v], kOpen);
    const auto& seen = table[ao * kShapeRows + shape];
    for (std::size_t c = 0; c < 3; ++c)
      mesh.colors[v][c] = own.empty() ? seen[c] : static_cast<std::uint8_t>(seen[c] * own[v][c] / 255);
  }
  if (!style.mark_inferred || mesh.triangle_inferred.empty()) return;
  std::vector<bool> measured(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_inferred[t] == 0)
      for (const std::uint32_t v : mesh.triangles[t]) measured[v] = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_inferred[t] != 0)
      for (const std::uint32_t v : mesh.triangles[t])
        if (!measured[v]) mesh.colors[v] = style.hatch.whole();
}

std::int64_t coincident_triangles(const TriMesh& mesh) {
  using Corner = std::tuple<float, float, float>;
  using Key = std::array<Corner, 3>;
  std::vector<Key> keys;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_inferred.empty() || mesh.triangle_inferred[t] == 0) continue;  // only patches are made twice
    Key key;
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3& p = mesh.positions[mesh.triangles[t][c]];
      key[c] = {p.x, p.y, p.z};
    }
    std::sort(key.begin(), key.end());
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  std::int64_t count = 0;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if ((k > 0 && keys[k - 1] == keys[k]) || (k + 1 < keys.size() && keys[k + 1] == keys[k])) ++count;
  return count;
}

}  // namespace dubsar::app
