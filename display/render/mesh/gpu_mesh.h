#pragma once
// A triangle mesh in graphics memory: 12 bytes a vertex (16 with foreign colours), triangles grouped by partition.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"
#include "display/optics/view.h"
#include "display/render/camera.h"
#include "display/render/context/gl_objects.h"
#include "display/render/mesh/surface_field.h"
#include "display/render/shading.h"

namespace dubsar {

/// As the vertex shader reads it.
struct PackedVertex {
  std::array<std::uint16_t, 3> position;  ///< 0..65535 across the box of the mesh: at most 0.5 um off in 6 cm
  std::uint16_t attributes;               ///< shape | ao << 7 | partition << 13
  std::array<std::int16_t, 2> normal;     ///< octahedral, signed normalised
};
static_assert(sizeof(PackedVertex) == 12);

/// The box around those whose bit is set; a box of size 0 for none.
Box joined_box(const std::array<Box, kMaxPartitions>& boxes, std::uint8_t bits);

/// A run of triangles of one partition that lie close together.
struct TriangleChunk {
  std::int64_t first = 0, count = 0;
  int partition = 0;
  bool inferred = false;
  Box box_mm;
};

/// The mesh in the form the renderer wants; pure CPU work, so that it can be tested and made in any thread.
struct PackedMesh {
  Box box_mm;  ///< of all finite vertices that triangles use
  std::vector<PackedVertex> vertices;
  std::vector<std::array<std::uint8_t, 4>> colors;  ///< only when the mesh has foreign colours
  std::vector<std::uint32_t> source;                ///< which vertex of the mesh it was made from each one is
  /// Sorted by partition, within one those that the scan shows before those that are inferred; else order is kept.
  std::vector<Triangle> triangles;
  std::array<std::int64_t, kMaxPartitions + 1> first_triangle{};  ///< of each partition
  std::array<std::int64_t, kMaxPartitions> first_inferred{};      ///< of each partition; its end when there is none
  std::array<Box, kMaxPartitions> partition_box_mm{};
  std::vector<TriangleChunk> chunks;  ///< all triangles, or none (display/render/mesh/lod.h makes them)
  bool has_shape = false, has_ao = false;
  bool mirrored = false;  ///< the frame turns counter-clockwise into clockwise

  /// Box of the partitions whose bit is set; a box of size 0 when they hold no triangle.
  Box box_of(std::uint8_t partitions) const;
  std::int64_t triangles_of(std::uint8_t partitions) const;
};

/// Positions and normals go to mm by mesh.frame. A vertex between partitions gets a copy for each but the first, behind
/// the vertices of the mesh, so that every vertex tells the partition of its triangles. Missing normals are computed
/// (area-weighted); triangles with vertices that are not finite are dropped. kBadData when an index or an attribute
/// array does not fit. Cost: about 30 ns a vertex on one core.
Result<PackedMesh> pack_mesh(const TriMesh& mesh);

/// Octahedral code of a unit vector (Cigolle et al. 2014); (0, 0) decodes to +z.
std::array<std::int16_t, 2> encode_octahedral(const glm::dvec3& unit);
glm::dvec3 decode_octahedral(const std::array<std::int16_t, 2>& code);

using TriangleRanges = std::vector<std::pair<std::int64_t, std::int64_t>>;
enum class ShownEvidence { kMeasured, kInferred, kBoth };

/// The packed mesh in buffers of the current context.
class GpuMesh {
 public:
  static Result<GpuMesh> upload(const PackedMesh& mesh);
  /// Room for the mesh, so that its contents can come piece by piece: upload_some() until it says true. Then the mesh
  /// may go, which must be the same in all calls; before, nothing of it can be drawn.
  static Result<GpuMesh> reserve(const PackedMesh& mesh);
  Result<bool> upload_some(PackedMesh& mesh, std::size_t bytes);

  /// Figures of the surface that its vertices carry, by the vertices of the mesh it was made from. kTryAgain.
  Result<void> carry(const SurfaceFields& fields);

  GLuint vertex_array() const noexcept { return vertex_array_; }
  const Box& box_mm() const noexcept { return box_mm_; }
  bool mirrored() const noexcept { return mirrored_; }
  bool has_colors() const noexcept { return colors_ != 0; }
  /// Of what was uploaded: no two uploads of a process have the same.
  std::uint64_t version() const noexcept { return version_; }
  /// Index ranges (first triangle, count) to draw for the partitions whose bit is set, neighbours joined, without the
  /// chunks that none of the views (world: the mesh's) can see. What is nearer in the first view comes before what is
  /// farther, in four steps, so that little is drawn that is not seen after all.
  TriangleRanges visible_ranges(std::uint8_t partitions, std::span<const View> views,
                                ShownEvidence evidence = ShownEvidence::kBoth) const;

 private:
  bool fill(const PackedMesh& mesh, std::size_t bytes);

  GlVertexArray vertex_array_;
  GlBuffer vertices_, colors_, indices_, fields_;
  std::vector<std::uint32_t> source_;
  Box box_mm_;
  std::vector<TriangleChunk> chunks_;  ///< of a mesh without chunks: one a partition and evidence
  bool mirrored_ = false;
  std::uint64_t version_ = 0;
  std::size_t uploaded_ = 0;  ///< bytes of vertices, triangles, colours, in this order
};

}  // namespace dubsar
