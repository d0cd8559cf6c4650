#pragma once
// The product of the pipeline: the sampled surface, its smoothed dual mesh, attributes and parts. This is what an EXA
// file holds.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/extract/quad_mesh.h"
#include "core/extract/surface_samples.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Per dual vertex; arrays are empty when the stage did not run.
struct VertexAttributes {
  std::vector<glm::vec3> normals;
  std::vector<float> k_min, k_max;
  std::vector<std::uint8_t> shape;
  std::vector<std::uint8_t> ao;  ///< 0..63
};

/// Triangles that close a hole which segmentation cut. Made once and used by both partitions, reversed for
/// `reverse_part`, so that the pieces mate exactly. A patch between two partitions of the same part (a membrane across
/// a crack, where the envelope's outside meets its inside) closes each of the two when it stands alone, and is left out
/// when they are shown together.
struct FillPatch {
  static constexpr std::uint8_t kNoPart = 255;
  std::uint8_t part = 0;                   ///< id of the partition that the triangles are oriented for
  std::uint8_t reverse_part = kNoPart;     ///< and of the one they are reversed for, if any
  std::vector<glm::vec3> extra_positions;  ///< vertices that the patch adds, grid coordinates
  std::vector<Triangle> triangles;         ///< id < vertex_count(): dual vertex; else extra_positions[id - count]
};

struct SurfaceModel {
  GridFrame frame;
  SurfaceSamples samples;
  QuadMesh mesh;  ///< smoothed positions; connectivity follows from samples
  VertexAttributes attributes;
  std::vector<std::uint8_t> quad_partition;  ///< per x-quad, 0..7; empty: not segmented, all 0
  std::vector<Partition> partitions;
  std::vector<FillPatch> patches;
  std::string provenance;  ///< JSON text
};

struct MeshOptions {
  std::optional<int> partition = std::nullopt;     ///< only this one
  std::optional<std::string> part = std::nullopt;  ///< only the partitions of this part, e.g. "envelope"
  bool fill_holes = true;                          ///< add the fill patches
};

/// The triangle mesh of a model (curvature-guided diagonals, docs/manifold.md). Parts are separate: vertices
/// on a cut are doubled, as are those where one part touches itself, so every closed part is a 2-manifold. Partitions
/// of one part stay joined; a vertex between them takes the lower id, any other vertex that of its triangles. Vertices
/// that fill patches and Steiner points add have averaged attributes; those of patches are flat. Deterministic. kUsage:
/// no such partition or part. kBadData: arrays, partition ids or patches that contradict each other. kTryAgain: more
/// than 2^31 vertices. `source`, if given, receives the dual vertex that each mesh vertex is or copies; kNoSource for
/// those that Steiner points and patches add.
inline constexpr std::uint32_t kNoSource = 0xffffffff;
Result<TriMesh> make_tri_mesh(const SurfaceModel& model, const MeshOptions& options = {},
                              std::vector<std::uint32_t>* source = nullptr);

/// Area, signed volume (mm, through the frame, which may be anisotropic) and watertightness of a closed or open mesh.
struct MeshMeasure {
  double area_mm2 = 0.0;
  double volume_mm3 = 0.0;
  bool watertight = false;  ///< closed 2-manifold (mesh_check.h)
};
MeshMeasure measure_mesh(const TriMesh& mesh);

/// Fills area, volume and watertight of every partition of the model, each measured alone with its fill patches.
/// Cost: one make_tri_mesh and one check_mesh per partition.
Result<void> measure_partitions(SurfaceModel& model);

/// The same for whole parts ("tablet", "envelope"), in order of their first partition; id is the first partition's.
Result<std::vector<Partition>> measure_parts(const SurfaceModel& model);

}  // namespace dubsar
