#include "core/parts/triangle_soup.h"

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <span>
#include <tuple>
#include <type_traits>

#include "core/base/numbers/counting_sort.h"
#include "core/base/system/parallel.h"
#include "core/mesh/fans.h"
#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

constexpr std::int64_t kSoupGrain = 1 << 14;

/// An added vertex and a dual vertex that share a triangle, in the order of the triangles.
struct Around {
  std::uint32_t added, dual;
  bool patch;  ///< the triangle is of a fill patch
};

/// What add(triangle, items) finds of all triangles, in their order.
template <class Item, class Add>
std::vector<Item> gather_from(const TriangleSoup& soup, const Add& add) {
  using Items = std::vector<Item>;
  return parallel_reduce<Items>(
      static_cast<std::int64_t>(soup.triangles.size()), 1 << 16, {},
      [&](std::int64_t begin, std::int64_t end) {
        Items part;
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) add(t, part);
        return part;
      },
      [](Items all, const Items& part) {
        all.insert(all.end(), part.begin(), part.end());
        return all;
      });
}

std::vector<Around> find_around(const TriangleSoup& soup, std::uint32_t dual) {
  return gather_from<Around>(soup, [&](std::size_t i, std::vector<Around>& around) {
    for (const std::uint32_t v : soup.triangles[i]) {
      if (v < dual) continue;
      for (const std::uint32_t w : soup.triangles[i])
        if (w < dual) around.push_back({v - dual, w, i >= soup.first_patch_triangle});
    }
  });
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

VertexAttributes attributes_of_added(const SurfaceModel& model, const TriangleSoup& soup) {
  const std::vector<Around> around = find_around(soup, static_cast<std::uint32_t>(model.mesh.positions.size()));
  VertexAttributes added;
  for_each_attribute([&](const auto& a) {
    const auto& values = model.attributes.*a.values;
    if (!values.empty()) added.*a.values = values_of_added(values, a.added, model, soup, around);
  });
  return added;
}

Result<std::vector<std::uint32_t>> split_fans(TriangleSoup& soup, const std::vector<std::uint8_t>& border,
                                              std::uint32_t first_copy, const Progress* progress) {
  const auto cancelled = [&] { return progress != nullptr && progress->cancelled(); };
  struct Corner {
    std::uint32_t vertex;
    std::uint8_t group;
    std::uint32_t triangle;
    std::uint32_t next, previous;  ///< the other two vertices, in order
  };
  auto corners = gather_from<Corner>(soup, [&](std::size_t t, std::vector<Corner>& found) {
    const Triangle& triangle = soup.triangles[t];
    for (std::size_t c = 0; c < 3; ++c)
      if (triangle[c] < border.size() && border[triangle[c]] != 0)
        found.push_back(
            {triangle[c], soup.group[t], static_cast<std::uint32_t>(t), triangle[(c + 1) % 3], triangle[(c + 2) % 3]});
  });
  if (cancelled()) return cancelled_error();
  counting_sort(corners, border.size(), [](const Corner& corner) { return corner.vertex; });
  for (auto begin = corners.begin(), end = begin; begin != corners.end(); begin = end) {
    while (end != corners.end() && end->vertex == begin->vertex) ++end;
    std::sort(begin, end, [](const Corner& a, const Corner& b) {
      return std::tie(a.group, a.triangle) < std::tie(b.group, b.triangle);
    });
  }

  std::vector<std::uint32_t> copies;
  Fans fans;
  bool original_taken = false;
  for (std::size_t begin = 0, end; begin < corners.size(); begin = end) {
    if (cancelled()) return cancelled_error();
    const std::uint32_t vertex = corners[begin].vertex;
    if (begin == 0 || corners[begin - 1].vertex != vertex) original_taken = false;
    fans.clear();
    for (end = begin;
         end < corners.size() && corners[end].vertex == vertex && corners[end].group == corners[begin].group; ++end)
      fans.add(corners[end].next, corners[end].previous);
    const std::uint32_t count = fans.find();
    // The first fan of a vertex keeps it, all others get copies.
    const std::uint32_t kept = original_taken ? 0 : 1;
    const std::uint32_t first_new = first_copy + static_cast<std::uint32_t>(copies.size());
    copies.insert(copies.end(), count - kept, vertex);
    original_taken = true;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t fan = fans.of_corner()[i - begin];
      if (fan < kept) continue;
      for (std::uint32_t& v : soup.triangles[corners[i].triangle])
        if (v == vertex) v = first_new + fan - kept;
    }
  }
  return copies;
}

}  // namespace dubsar
