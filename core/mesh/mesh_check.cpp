#include "core/mesh/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/result.h"
#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool has_area(std::span<const glm::vec3> positions, const Triangle& t) {
  const glm::dvec3 p(positions[t[0]]), a = glm::dvec3(positions[t[1]]) - p, b = glm::dvec3(positions[t[2]]) - p;
  const glm::dvec3 n = glm::cross(a, b);
  const double square = glm::dot(n, n);
  return square > 0.0 && std::isfinite(square);
}

/// The link of one vertex: each triangle around it gives a directed link edge from its next to its last corner.
class Link {
 public:
  void clear() { ends_.clear(); }
  void add(std::uint32_t from, std::uint32_t to) {
    const auto triangle = static_cast<std::uint32_t>(ends_.size() / 2);
    ends_.push_back({from, triangle, true});
    ends_.push_back({to, triangle, false});
  }
  /// Adds what this vertex says: edges are counted at their lower end.
  void check(std::uint32_t vertex, MeshCheck& sum) {
    if (is_ring()) {
      ++sum.vertices;
      for (std::size_t i = 0; i < ends_.size(); i += 2) sum.edges += ends_[i].neighbour >= vertex;
      return;
    }
    std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.neighbour < b.neighbour; });
    const std::size_t triangles = ends_.size() / 2;
    fans_.reset(triangles);
    std::size_t fans = triangles, path_ends = 0;
    bool branches = false;
    for (std::size_t i = 0, j; i < ends_.size(); i = j) {
      std::size_t leaving = 0;
      for (j = i; j < ends_.size() && ends_[j].neighbour == ends_[i].neighbour; ++j) {
        leaving += ends_[j].leaves;
        fans -= fans_.join(ends_[i].triangle, ends_[j].triangle);
      }
      const std::size_t degree = j - i;
      branches |= degree > 2;
      path_ends += degree == 1;
      if (ends_[i].neighbour < vertex) continue;
      ++sum.edges;
      sum.boundary_edges += degree == 1;
      sum.nonmanifold_edges += degree > 2;
      sum.inconsistent_edges += degree == 2 && leaving != 1;
    }
    ++sum.vertices;
    sum.nonmanifold_vertices += branches || fans != 1 || path_ends > 2;
  }

 private:
  struct End {
    std::uint32_t neighbour, triangle;
    bool leaves;
  };
  /// Whether the triangles go once around the vertex, all in one sense, as they do nearly everywhere. Puts them in that
  /// order as far as it gets.
  bool is_ring() {
    constexpr std::size_t kMostTriangles = 12;  // more are sorted faster
    const std::size_t size = ends_.size();
    if (size < 6 || size > 2 * kMostTriangles) return false;
    for (std::size_t i = 2; i < size; i += 2) {
      std::size_t next = i;
      while (next < size && ends_[next].neighbour != ends_[i - 1].neighbour) next += 2;
      if (next == size) return false;
      std::swap(ends_[i], ends_[next]);
      std::swap(ends_[i + 1], ends_[next + 1]);
    }
    if (ends_[size - 1].neighbour != ends_[0].neighbour) return false;
    for (std::size_t i = 0; i < size; i += 2)
      for (std::size_t j = i + 2; j < size; j += 2)
        if (ends_[i].neighbour == ends_[j].neighbour) return false;  // passes a neighbour twice
    return true;
  }

  std::vector<End> ends_;
  DisjointSets fans_;
};

/// Triangles around each vertex, rising, one vertex after another: three times 4 bytes a triangle, no edge is ever
/// stored. `first`: where those of each begin, and the end. Every thread looks through all triangles for those of its
/// own range of vertices, so that nobody has to wait and the order is that of one thread.
LargeArray<std::uint32_t> triangles_around(std::size_t vertices, std::span<const Triangle> triangles,
                                           std::vector<std::uint32_t>& first) {
  constexpr std::int64_t kLeast = 1 << 16, kMostRanges = 8;
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t ranges =
      std::clamp<std::int64_t>(count / kLeast, 1, std::min<std::int64_t>(thread_count(), kMostRanges));
  const std::int64_t length = (count + ranges - 1) / ranges;
  first.clear();
  resize_large(first, vertices + 1);
  parallel_for(ranges, 1, [&](std::int64_t range) {
    const auto low = static_cast<std::uint32_t>(range * length),
               size = static_cast<std::uint32_t>(std::min(length, count - range * length));
    for (const Triangle& t : triangles) {
      if (is_degenerate(t)) continue;
      for (const std::uint32_t v : t)
        if (v - low < size) ++first[v];
    }
  });
  std::uint32_t total = 0;
  for (std::uint32_t& f : first) f = total += f;
  LargeArray<std::uint32_t> around(total);
  parallel_for(ranges, 1, [&](std::int64_t range) {
    const auto low = static_cast<std::uint32_t>(range * length),
               size = static_cast<std::uint32_t>(std::min(length, count - range * length));
    for (std::size_t i = triangles.size(); i-- > 0;) {
      if (is_degenerate(triangles[i])) continue;
      for (const std::uint32_t v : triangles[i])
        if (v - low < size) around.data()[--first[v]] = static_cast<std::uint32_t>(i);
    }
  });
  return around;
}

std::int64_t count_components(std::size_t vertices, std::span<const Triangle> triangles,
                              std::span<const std::uint32_t> first) {
  ConcurrentSets sets(vertices);
  parallel_for(static_cast<std::int64_t>(triangles.size()), 1 << 14, [&](std::int64_t i) {
    const Triangle& t = triangles[static_cast<std::size_t>(i)];
    if (is_degenerate(t)) return;
    for (std::size_t k = 1; k < 3; ++k) sets.join(t[0], t[k]);
  });
  return parallel_reduce<std::int64_t>(
      static_cast<std::int64_t>(vertices), 1 << 16, 0,
      [&](std::int64_t begin, std::int64_t end) {
        std::int64_t roots = 0;
        for (auto v = static_cast<std::uint32_t>(begin); v < static_cast<std::uint64_t>(end); ++v)
          roots += first[v + 1] > first[v] && sets.root(v) == v ? 1 : 0;
        return roots;
      },
      [](std::int64_t one, std::int64_t other) { return one + other; });
}

MeshCheck add(MeshCheck a, const MeshCheck& b) {
  a.vertices += b.vertices;
  a.triangles += b.triangles;
  a.edges += b.edges;
  a.boundary_edges += b.boundary_edges;
  a.nonmanifold_edges += b.nonmanifold_edges;
  a.inconsistent_edges += b.inconsistent_edges;
  a.nonmanifold_vertices += b.nonmanifold_vertices;
  a.degenerate_triangles += b.degenerate_triangles;
  a.zero_area_triangles += b.zero_area_triangles;
  return a;
}

}  // namespace

namespace {

/// What of a mesh belongs to which label; without labels all is of one.
using Labels = std::span<const PartitionId>;

/// All but components and the Euler number; triangles without area where there are `positions` of the vertices.
std::vector<MeshCheck> check_labelled(std::size_t vertices, std::span<const glm::vec3> positions,
                                      std::span<const Triangle> triangles, Labels labels, std::size_t label_count,
                                      std::vector<std::uint32_t>& first) {
  DUBSAR_CHECK(triangles.size() < (std::size_t{1} << 32) / 3);
  const auto label_of = [&](std::size_t triangle) { return labels.empty() ? std::size_t{0} : labels[triangle]; };
  using Checks = std::vector<MeshCheck>;
  const auto add_all = [](Checks a, const Checks& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = add(a[i], b[i]);
    return a;
  };
  Checks sum = parallel_reduce<Checks>(
      static_cast<std::int64_t>(triangles.size()), 1 << 16, Checks(label_count),
      [&](std::int64_t begin, std::int64_t end) {
        Checks part(label_count);
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          const Triangle& t = triangles[i];
          DUBSAR_CHECK(t[0] < vertices && t[1] < vertices && t[2] < vertices);
          const bool degenerate = is_degenerate(t);
          MeshCheck& check = part[label_of(i)];
          ++check.triangles;
          check.degenerate_triangles += degenerate;
          check.zero_area_triangles += !degenerate && !positions.empty() && !has_area(positions, t);
        }
        return part;
      },
      add_all);

  const LargeArray<std::uint32_t> around = triangles_around(vertices, triangles, first);
  return parallel_reduce<Checks>(
      static_cast<std::int64_t>(vertices), 1 << 14, std::move(sum),
      [&](std::int64_t begin, std::int64_t end) {
        Checks part(label_count);
        Link link;
        for (auto v = static_cast<std::uint32_t>(begin); v < static_cast<std::uint64_t>(end); ++v) {
          if (first[v] == first[v + 1]) continue;
          link.clear();
          for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
            const Triangle& t = triangles[around.data()[i]];
            const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
            link.add(t[(k + 1) % 3], t[(k + 2) % 3]);
          }
          link.check(v, part[label_of(around.data()[first[v]])]);
        }
        return part;
      },
      add_all);
}

}  // namespace

MeshCheck check_mesh(std::span<const glm::vec3> positions, std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> first;
  MeshCheck check = check_labelled(positions.size(), positions, triangles, {}, 1, first).front();
  check.components = count_components(positions.size(), triangles, first);
  check.euler = check.vertices - check.edges + (check.triangles - check.degenerate_triangles);
  return check;
}

std::vector<bool> watertight_parts(std::size_t vertices, std::span<const Triangle> triangles,
                                   std::span<const PartitionId> parts) {
  DUBSAR_CHECK(parts.size() == triangles.size());
  std::vector<std::uint32_t> first;
  std::vector<bool> watertight;
  for (const MeshCheck& check :
       check_labelled(vertices, {}, triangles, parts, std::size_t{PartitionTable::kHighest} + 1, first))
    watertight.push_back(check.watertight());
  return watertight;
}

}  // namespace dubsar
