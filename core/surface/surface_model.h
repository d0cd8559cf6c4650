#pragma once
// The product of the pipeline: the sampled surface, its smoothed dual mesh, attributes and parts. This is what an EXA
// file holds.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/surface/quad_mesh.h"
#include "core/surface/surface_samples.h"
#include "core/surface/tri_mesh.h"

namespace dubsar {

/// Per dual vertex; arrays are empty when the stage did not run.
struct VertexAttributes {
  std::vector<glm::vec3> normals;
  std::vector<float> k_min, k_max;
  std::vector<std::uint8_t> shape;
  std::vector<std::uint8_t> ao;  ///< 0..63
};

/// Triangles that close a hole which segmentation cut. Made once and used by both parts, reversed for `reverse_part`,
/// so that the parts mate exactly.
struct FillPatch {
  static constexpr std::uint8_t kNoPart = 255;
  std::uint8_t part = 0;                      ///< the triangles are oriented for this part
  std::uint8_t reverse_part = kNoPart;        ///< and reversed for this one, if any
  std::vector<glm::vec3> extra_positions;     ///< vertices that the patch adds, grid coordinates
  std::vector<Triangle> triangles;            ///< id < vertex_count(): dual vertex; else extra_positions[id - count]
};

struct SurfaceModel {
  GridFrame frame;
  SurfaceSamples samples;
  QuadMesh mesh;                              ///< smoothed positions; connectivity follows from samples
  VertexAttributes attributes;
  std::vector<std::uint8_t> quad_partition;   ///< per x-quad, 0..7; empty: not segmented, all 0
  std::vector<Partition> partitions;
  std::vector<FillPatch> patches;
  std::string provenance;                     ///< JSON text
};

struct MeshOptions {
  std::optional<int> partition;  ///< only this one
  bool fill_holes = true;        ///< add the fill patches
};

/// The triangle mesh of a model (curvature-guided diagonals, algorithms.md section 1.2). Parts are separate: vertices
/// on a cut are doubled, as are those where one part touches itself, so every closed part is a 2-manifold.
/// Deterministic. The partition of a vertex is that of its triangles.
Result<TriMesh> make_tri_mesh(const SurfaceModel& model, const MeshOptions& options = {});

}  // namespace dubsar
