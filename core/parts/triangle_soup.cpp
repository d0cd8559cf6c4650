#include "core/parts/triangle_soup.h"

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <span>
#include <type_traits>

#include "core/base/system/parallel.h"
#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

constexpr std::int64_t kSoupGrain = 1 << 14;

/// An added vertex and a dual vertex that share a triangle, in the order of the triangles.
struct Around {
  std::uint32_t added, dual;
  bool patch;  ///< the triangle is of a fill patch
};

std::vector<Around> find_around(const TriangleSoup& soup, std::uint32_t dual) {
  const auto lists = lists_of_triangles<Around>(soup, [&](std::size_t i, std::vector<Around>& around) {
    for (const std::uint32_t v : soup.triangles[i]) {
      if (v < dual) continue;
      for (const std::uint32_t w : soup.triangles[i])
        if (w < dual) around.push_back({v - dual, w, i >= soup.first_patch_triangle});
    }
  });
  std::vector<Around> all;
  for (const std::vector<Around>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::vector<glm::vec3> normals_of_added(const SurfaceModel& model, const TriangleSoup& soup,
                                        std::span<const Around> around) {
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  std::vector<glm::vec3> normals(soup.added.size(), glm::vec3(0.0f));
  const auto position = [&](std::uint32_t v) { return v < dual ? model.mesh.positions[v] : soup.added[v - dual]; };
  for (std::size_t i = soup.first_patch_triangle; i < soup.triangles.size(); ++i) {
    const Triangle& t = soup.triangles[i];
    for (const std::uint32_t v : t)
      if (v >= dual) normals[v - dual] += glm::cross(position(t[1]) - position(t[0]), position(t[2]) - position(t[0]));
  }
  for (const Around& a : around)
    if (!a.patch) normals[a.added] += model.attributes.normals[a.dual];
  for (glm::vec3& n : normals) {
    const float length = glm::length(n);
    n = length > 0.0f ? n / length : glm::vec3(0.0f, 0.0f, 1.0f);
  }
  return normals;
}

/// Means over the dual vertices around; `everywhere`: on patches too, and for their inner vertices over all rims.
template <class T>
std::vector<T> means_of_added(const std::vector<T>& values, bool everywhere, const TriangleSoup& soup,
                              std::span<const Around> around, std::size_t first_patch_vertex) {
  std::vector<float> sum(soup.added.size(), 0.0f), count(soup.added.size(), 0.0f);
  for (const Around& a : around) {
    if (a.patch && !everywhere) continue;
    sum[a.added] += static_cast<float>(values[a.dual]);
    count[a.added] += 1.0f;
  }
  float rims = 0.0f, rim_count = 0.0f;
  for (std::size_t i = first_patch_vertex; i < sum.size(); ++i) rims += sum[i], rim_count += count[i];
  std::vector<T> means(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const float mean = count[i] > 0.0f ? sum[i] / count[i] : rim_count > 0.0f ? rims / rim_count : sum[i];
    means[i] = static_cast<T>(std::is_integral_v<T> ? mean + 0.5f : mean);
  }
  return means;
}

/// The values of an attribute at the added vertices (AddedValue).
template <class T>
std::vector<T> values_of_added(const std::vector<T>& values, AddedValue rule, const SurfaceModel& model,
                               const TriangleSoup& soup, std::span<const Around> around) {
  if constexpr (std::is_same_v<T, glm::vec3>) {
    if (rule == AddedValue::kNormal) return normals_of_added(model, soup, around);
  }
  if constexpr (std::is_arithmetic_v<T>) {
    if (rule == AddedValue::kMean || rule == AddedValue::kSurfaceMean)
      return means_of_added(values, rule == AddedValue::kMean, soup, around,
                            soup.first_patch_vertex - model.mesh.positions.size());
  }
  std::vector<T> result(soup.added.size(), T{});
  for (const Around& a : around)
    if (!a.patch) result[a.added] = values[a.dual];
  return result;
}

}  // namespace

std::vector<std::uint8_t> border_vertices(const SurfaceModel& model, std::span<const std::uint8_t> group) {
  constexpr std::uint8_t kUnseen = 254;
  const QuadMesh& mesh = model.mesh;
  std::vector<std::uint8_t> border(mesh.positions.size(), 0);
  if (!model.quad_partition.empty()) {
    // Whoever comes first, what is left is the same: a vertex that two groups have seen.
    std::vector<std::uint8_t> seen(mesh.positions.size(), kUnseen);
    const auto visit = [&](std::uint32_t v, std::uint32_t q) {
      const std::uint8_t own = group[model.quad_partition[q]];
      const std::atomic_ref of_vertex(seen[v]);
      std::uint8_t before = of_vertex.load(std::memory_order_relaxed);
      if (before == kUnseen && of_vertex.compare_exchange_strong(before, own, std::memory_order_relaxed)) return;
      if (before != own) std::atomic_ref(border[v]).store(1, std::memory_order_relaxed);
    };
    parallel_for(mesh.quad_count(), kSoupGrain, [&](std::int64_t i) {
      const auto q = static_cast<std::uint32_t>(i);
      for (const std::uint32_t v : mesh.quads[q]) visit(v, q);
    });
    for (const DoubledCorner& d : mesh.doubled) visit(d.vertex, d.quad);
  }
  for (const FillPatch& patch : model.patches)
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t)
        if (v < border.size()) border[v] = 1;
  return border;
}

VertexAttributes attributes_of_added(const SurfaceModel& model, const TriangleSoup& soup, const MeshOptions& options) {
  VertexAttributes added;
  if (!options.attributes) return added;
  const std::vector<Around> around = find_around(soup, static_cast<std::uint32_t>(model.mesh.positions.size()));
  for_each_attribute([&](const auto& a) {
    const auto& values = model.attributes.*a.values;
    if (!values.empty() && takes(options, a)) added.*a.values = values_of_added(values, a.added, model, soup, around);
  });
  return added;
}

}  // namespace dubsar
