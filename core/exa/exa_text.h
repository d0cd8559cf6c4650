#pragma once
// The text blocks of an EXA file: the JSON header and the partition table.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/parts/surface_model.h"
#include "core/relief/curvature/curvature.h"

namespace dubsar {

/// What the arrays of normals and curvatures are.
enum class ExaNormals {
  kNone,
  kRecomputed,  ///< recomputed_normals() and principal_curvatures() of the mesh that was read
  kExact,       ///< stored
};

/// Of a surface of parts that touch (labelled_surface.h).
struct ExaContact {
  std::int64_t edges = 0;     ///< of the grid, between clay of both
  std::int64_t vertices = 0;  ///< that are not at the air
  std::uint32_t sum = 0;      ///< over their places, the offsets of the edges, and how the vertices are known
};

/// position_sum_of() and quad_sum_of() of the mesh that was written, how its x-quads are cut, and what not every mesh
/// has.
struct MeshSums {
  std::uint32_t positions = 0, quads = 0;
  bool embedded = false;  ///< as QuadMesh::embedded says
  /// The last brick along an axis of 128 k + 1 points has the offsets and face decisions of its far side.
  bool far_sides = false;
  std::optional<ExaContact> contact;
};

struct ExaHeader {
  GridFrame frame;
  Dims dims;
  float isovalue = 0.0f;
  int offset_bits = 4;
  bool closed = true;
  std::int64_t vertices = 0, quads = 0;
  SampleCounts samples;  ///< as many offsets as edges, as many decisions as faces
  ExaNormals normals = ExaNormals::kNone;
  bool curvatures = false;  ///< kRecomputed: k_min and k_max follow
  bool shapes = false;      ///< shape_classes() of the curvatures; not stored
  CurvatureMethod curvature = CurvatureMethod::kFit;
  std::string tool;  ///< program and version that wrote the file
  MeshSums sums;
};

/// kBadData when a number is not finite (JSON cannot hold it).
Result<std::string> exa_header_json(const ExaHeader& header);
/// kBadData: a grid so large for so small a file that a reader would spend its time on nothing; docs/exa.md, bounds.
Result<void> check_exa_size(const Dims& dims, std::uint64_t file_bytes);
/// kBadData: missing or wrong members, dimensions out of bounds, or counts that no file of `file_bytes` can have.
Result<ExaHeader> parse_exa_header(std::string_view text, std::uint64_t file_bytes);

/// Most memory that reading a file with this header takes, besides the file itself.
std::uint64_t exa_memory_bound(const ExaHeader& header);

Result<std::string> exa_partitions_json(const PartitionTable& partitions);
Result<PartitionTable> parse_exa_partitions(std::string_view text);

/// CRC-32 over the positions as floats and the offsets, and over x-quads and doubled corners: tells a reader that
/// decodes other samples, or builds another mesh from the same.
std::uint32_t position_sum_of(const SurfaceModel& model);
std::uint32_t quad_sum_of(const QuadMesh& mesh);

}  // namespace dubsar
