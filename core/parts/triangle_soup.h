#pragma once
// The triangles of a surface model before they become a TriMesh: parts still share vertices, and Steiner points and
// patches have added some that have no attributes yet.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/extract/quad_cuts.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Ids 0..dual are dual vertices, then Steiner points, then patch
/// vertices (one copy for each side of a patch).
struct TriangleSoup {
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> partition, group;  ///< of each triangle
  std::vector<glm::vec3> added;                ///< positions of ids from dual_count on
  std::vector<std::uint8_t> patch_evidence;    ///< of the added vertices from first_patch_vertex on (evidence.h)
  std::vector<FacePoint> bends;                ///< sides of x-quads with a point; the ids of these are the last before
                                               ///< first_patch_vertex
  std::size_t first_patch_triangle = 0;
  std::size_t first_patch_vertex = 0;  ///< an id
};

/// One for each dual vertex: whether there two partitions meet of different `group` (of each partition id), or a patch
/// uses it. Only there can a vertex have more than one fan.
std::vector<std::uint8_t> border_vertices(const SurfaceModel& model, std::span<const std::uint8_t> group);

/// What add(triangle, items) finds of all triangles: a list for each range of them, in their order. All threads.
template <class Item, class Add>
std::vector<std::vector<Item>> lists_of_triangles(const TriangleSoup& soup, const Add& add) {
  constexpr std::int64_t kGrain = 1 << 16;
  const auto count = static_cast<std::int64_t>(soup.triangles.size());
  std::vector<std::vector<Item>> lists(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
  parallel_chunks(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    auto& list = lists[static_cast<std::size_t>(begin / kGrain)];
    for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) add(t, list);
  });
  return lists;
}

/// Does a mesh made with these options have this one of kVertexAttributes?
template <class Attribute>
bool takes(const MeshOptions& options, const Attribute& attribute) {
  return options.attributes && (!options.only_evidence || attribute.name == "evidence");
}

/// Those attributes of the model that the options ask for, at the added vertices (AddedValue says how). Call it before
/// split_fans().
VertexAttributes attributes_of_added(const SurfaceModel& model, const TriangleSoup& soup, const MeshOptions& options);

}  // namespace dubsar
