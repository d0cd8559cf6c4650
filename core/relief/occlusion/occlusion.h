#pragma once
// Ambient occlusion per vertex (paper section 3.4.4): how much light of an even sky reaches it.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/mesh/tri_mesh.h"
#include "core/relief/occlusion/shared_sky.h"

namespace dubsar {

/// How rays find the surface.
enum class OcclusionEngine : std::uint8_t {
  kBricks,     ///< march through distances on the voxels (surface_bricks.h): within .02 RMS of the triangles
  kTriangles,  ///< exact, by Embree
};

inline constexpr EnumName<OcclusionEngine> kOcclusionEngines[] = {{OcclusionEngine::kBricks, "march"},
                                                                  {OcclusionEngine::kTriangles, "triangles"}};
static_assert(names_all(kOcclusionEngines, static_cast<std::size_t>(OcclusionEngine::kTriangles) + 1));

struct OcclusionOptions {
  OcclusionEngine engine = OcclusionEngine::kBricks;
  int rays = 160;            ///< per vertex (paper); 1..65536
  float radius_vox = 64.0f;  ///< surfaces further away take no light (paper)
  /// Rays start this far above the vertex along its normal, so that neither rounding nor the roughness that the 4-bit
  /// offsets leave (0.03 voxel) shades a vertex. Costs at most offset / radius of the value: 0.004.
  float offset_vox = 0.25f;
  /// Each vertex follows about rays / shared_by of them, others in each neighbouring voxel, and their light is brought
  /// together along the surface (shared_sky.h). By 19: .011 to .012 RMS off 160 rays, as much as marching is off the
  /// triangles. 1..rays.
  int shared_by = 1;
  double most_cells = 4e8;  ///< of the grid that is marched through; larger bodies are lit box by box (kBricks)
};

/// The surface that is lit; the arrays are borrowed. Triangles without a body are all of one. Bodies share no vertices:
/// a vertex belongs to the lowest body of its triangles, one without triangles to body 0.
struct LitSurface {
  std::span<const glm::vec3> positions;
  std::span<const glm::vec3> normals;  ///< unit, one per vertex
  std::span<const Triangle> triangles;
  std::span<const PartitionId> bodies = {};  ///< of each triangle, or empty
};

/// 1 - sum w1 w2 / sum w1 per vertex: 1 open, 0 dark; w2 = 1 - d / radius for a ray that meets a surface at distance
/// d < radius, 0 for others. A ray that first meets the back of a triangle started under the surface: d = 0. (In open
/// meshes this darkens what looks at their inner side.) A ray only meets triangles of its vertex's body: each is lit as
/// if it lay alone in the hand. A vertex whose normal or position is not finite gets 1. kBadData: a triangle names a
/// vertex that is not there. kTryAgain: out of memory. Deterministic for any thread count and vectors. Progress in
/// rays. Memory of the largest body: by kTriangles about 100 bytes a triangle; by kBricks see surface_bricks.h.
Result<std::vector<float>> ambient_light(const LitSurface& surface, const OcclusionOptions& options,
                                         Progress& progress);

/// How many rays ambient_light() follows from each vertex.
inline int rays_of_vertex(const OcclusionOptions& options) {
  return (options.rays + options.shared_by - 1) / options.shared_by;
}

/// The same in 64 steps: round(63 light), as TriMesh::ao and VertexAttributes::ao hold it.
Result<std::vector<std::uint8_t>> ambient_occlusion(const LitSurface& surface, const OcclusionOptions& options,
                                                    Progress& progress);

}  // namespace dubsar
