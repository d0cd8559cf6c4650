#pragma once
// The one list of what may be known of vertices besides their positions. Whoever copies, joins, checks or names
// attributes goes through it, so that adding one is a member of VertexAttributes and its entry here.

#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// What a vertex gets that a Steiner point or a fill patch adds to a surface.
enum class AddedValue {
  kNormal,       ///< unit mean over the surface around it; on a patch the patch's own
  kSurfaceMean,  ///< mean over the surface around it; 0 on a patch
  kMean,         ///< mean over the surface around it; inside a patch that of all rims
  kNeighbour,    ///< that of a neighbour on the surface; 0 on a patch
};

template <class Mesh, class T>
struct VertexAttribute {
  std::string_view name;  ///< in reports and messages
  std::vector<T> Mesh::*values;
  AddedValue added = AddedValue::kNeighbour;
};
template <class Mesh, class T>
VertexAttribute(std::string_view, std::vector<T> Mesh::*, AddedValue = {}) -> VertexAttribute<Mesh, T>;

inline constexpr std::tuple kVertexAttributes{
    VertexAttribute{"normals", &VertexAttributes::normals, AddedValue::kNormal},
    VertexAttribute{"colors", &VertexAttributes::colors, AddedValue::kNeighbour},
    VertexAttribute{"k_min", &VertexAttributes::k_min, AddedValue::kSurfaceMean},
    VertexAttribute{"k_max", &VertexAttributes::k_max, AddedValue::kSurfaceMean},
    VertexAttribute{"shape", &VertexAttributes::shape, AddedValue::kNeighbour},
    VertexAttribute{"ao", &VertexAttributes::ao, AddedValue::kMean},
    VertexAttribute{"evidence", &VertexAttributes::evidence, AddedValue::kNeighbour},
};

/// Calls visit(attribute) for each entry of a list, in its order.
template <class Visit, class List = decltype(kVertexAttributes)>
void for_each_attribute(const Visit& visit, const List& list = kVertexAttributes) {
  std::apply([&](const auto&... attribute) { (visit(attribute), ...); }, list);
}

/// Gives `to` the positions and attributes of the vertices `ids` of `from`, in that order; replaces its own.
template <class Mesh, class List = decltype(kVertexAttributes)>
void gather_vertices(const Mesh& from, std::span<const std::uint32_t> ids, Mesh& to,
                     const List& list = kVertexAttributes) {
  const auto gather = [&](const auto& source, auto& target) {
    target.clear();
    if (source.empty()) return;
    target.reserve(ids.size());
    for (const std::uint32_t v : ids) target.push_back(source[v]);
  };
  gather(from.positions, to.positions);
  for_each_attribute([&](const auto& a) { gather(from.*a.values, to.*a.values); }, list);
}

/// Puts the vertices of `from` behind those of `to`. An attribute that only one of them has is dropped.
template <class Mesh, class List = decltype(kVertexAttributes)>
void append_vertices(Mesh& to, const Mesh& from, const List& list = kVertexAttributes) {
  const auto append = [](auto& target, const auto& source) {
    target.insert(target.end(), source.begin(), source.end());
  };
  for_each_attribute(
      [&](const auto& a) {
        const bool both =
            ((to.*a.values).size() == to.positions.size()) && ((from.*a.values).size() == from.positions.size());
        if (both)
          append(to.*a.values, from.*a.values);
        else
          (to.*a.values).clear();
      },
      list);
  append(to.positions, from.positions);
}

/// The one check of a mesh: every attribute has one entry per vertex or none, triangles name vertices that are there,
/// partitions are below PartitionTable::kMost, one per triangle or none. `kind` and `what` make the error.
template <class Mesh, class List = decltype(kVertexAttributes)>
Result<void> check_arrays(const Mesh& mesh, ErrorKind kind, std::string_view what,
                          const List& list = kVertexAttributes) {
  const std::size_t count = mesh.positions.size();
  Result<void> result;
  for_each_attribute(
      [&](const auto& a) {
        const std::size_t size = (mesh.*a.values).size();
        if (result && size != 0 && size != count)
          result =
              fail(kind, "{}: the mesh has {} vertices but {} {}, expected as many or none", what, count, size, a.name);
      },
      list);
  DUBSAR_TRY(result);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= count) return fail(kind, "{}: a triangle names vertex {}, but there are {}", what, v, count);
  if (!mesh.triangle_partition.empty() && mesh.triangle_partition.size() != mesh.triangles.size())
    return fail(kind, "{}: the mesh has {} triangles but {} partition ids, expected as many or none", what,
                mesh.triangles.size(), mesh.triangle_partition.size());
  for (const PartitionId id : mesh.triangle_partition)
    if (id > PartitionTable::kHighest)
      return fail(kind, "{}: partition {} found, expected 0 to {}", what, id, PartitionTable::kHighest);
  return {};
}

}  // namespace dubsar
