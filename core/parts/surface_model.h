#pragma once
// The product of the pipeline: the sampled surface, its smoothed dual mesh, attributes and parts. This is what an EXA
// file holds.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/labelled/labelled_surface.h"
#include "core/extract/quad_mesh.h"
#include "core/extract/surface_samples.h"
#include "core/extract/triangulate.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Triangles that close a hole which segmentation cut. Made once and used by both partitions, reversed for
/// `reverse_partition`, so that the pieces mate exactly. A patch between two partitions of one body (a membrane across
/// a crack, where the envelope's outside meets its inside) closes each of the two when it stands alone, and is left out
/// when they are shown together.
struct FillPatch {
  PartitionId partition = 0;                              ///< that the triangles are oriented for
  PartitionId reverse_partition = PartitionTable::kNone;  ///< that they are reversed for, if any
  std::vector<glm::vec3> extra_positions;                 ///< vertices that the patch adds, grid coordinates
  std::vector<Triangle> triangles;       ///< id < vertex_count(): dual vertex; else extra_positions[id - count]
  std::vector<std::uint8_t> evidence{};  ///< of the extra vertices (evidence.h); empty: all inferred
};

/// A block of the model's file that this program does not know: a later one added it, and it goes into every file that
/// is written of the model, as it is.
struct ForeignBlock {
  std::string type;  ///< four characters
  std::uint16_t codec = 0, flags = 0;
  std::uint32_t chunks = 0;
  std::string bytes;
};

struct SurfaceModel {
  GridFrame frame;
  SurfaceSamples samples;
  QuadMesh mesh;                            ///< smoothed positions; connectivity follows from samples
  VertexAttributes attributes;              ///< of dual vertices; arrays are empty when the stage did not run
  std::vector<PartitionId> quad_partition;  ///< per x-quad; empty: not segmented, all 0
  PartitionTable partitions;
  std::vector<FillPatch> patches;
  /// Of a surface of parts: the mesh is then that of its x-quads between clay and air, `drawing` their triangles, and
  /// the first patch the contact, whose first vertices are those of the labelled mesh that are not at the air. All
  /// three follow from places and normals (labelled_model.h).
  std::optional<LabelledSurface> labelled;
  std::optional<Triangulation> drawing;
  std::string provenance;  ///< JSON text
  std::vector<ForeignBlock> foreign;
  /// Of positions, normals and curvatures (settled_sum(), core/exa/offsets/settle.h) where the last two follow from the
  /// first, so that nobody has to compute them again to see that; 0: not known.
  std::uint64_t settled_sum = 0;
};

struct MeshOptions {
  std::optional<PartitionId> partition = std::nullopt;  ///< only this one
  std::optional<std::string> body = std::nullopt;       ///< only the partitions of this body, e.g. "envelope"
  bool fill_holes = true;                               ///< add the fill patches
  bool separate_partitions = false;                     ///< those of one body do not stay joined
  bool attributes = true;                               ///< of vertices; false: positions only
  bool only_evidence = false;                           ///< of the attributes that alone
  const Progress* progress = nullptr;                   ///< whose cancellation ends the work
};

/// The triangle mesh of a model (curvature-guided diagonals, docs/manifold.md). Bodies are separate: vertices
/// on a cut are doubled, as are those where one body touches itself, so every closed body is a 2-manifold. Partitions
/// of one body stay joined: their triangles share vertices. Vertices that fill patches and Steiner points add have
/// averaged attributes; those of patches are flat. Deterministic. kUsage: no such partition or body. kBadData: arrays,
/// partition ids or patches that contradict each other. kTryAgain: more than 2^31 vertices. kCancelled. `source`, if
/// given, receives the dual vertex that each mesh vertex is or copies; kNoSource for those that Steiner points and
/// patches add.
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

/// Fills area, volume and watertight of every partition of the model, each measured alone with its fill patches. Where
/// partitions of one body meet (at cracks of the envelope) they are open, and cones from the middle of these borders
/// stand for what is missing, so that the volumes of a body's partitions add up to its own.
/// Cost: one make_tri_mesh and one check_mesh.
Result<void> measure_partitions(SurfaceModel& model);

}  // namespace dubsar
