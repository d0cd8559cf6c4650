#pragma once
// The one door to mesh files: PLY, STL, OBJ, GLB and 3MF (only written), from and into a TriMesh.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/tablet_frame.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

enum class MeshFormat { kPly, kStl, kObj, kGlb, k3mf };

/// What the numbers in the file mean. kVox: coordinates of the input volume, voxel centres at integers. GLB is always
/// in metres, as glTF demands.
enum class MeshUnits { kMm, kVox };

struct MeshWriteOptions {
  MeshUnits units = MeshUnits::kMm;
  bool colors_derived = false;  ///< the mesh's colours follow from its attributes: readers of ours need not keep them
  bool compress = false;        ///< GLB only: quantised to 1/16 grid step, EXT_meshopt_compression; kUsage for others
};

/// What a person knows of a foreign file, and what it is read for.
struct MeshReadOptions {
  double unit_mm = 0.0;       ///< mm of one unit of the file; 0: as the format or the file says. kUsage for our own
  bool photo_detail = false;  ///< triangles are divided until their vertices hold what a photograph on them shows
};

struct MeshInfo {
  MeshFormat format = MeshFormat::kPly;
  std::int64_t bytes = 0, vertices = 0, triangles = 0;
  glm::dvec3 min_mm{0.0}, max_mm{0.0};  ///< box of the vertices used by triangles; of a point cloud of all
  MeshCheck check;                      ///< is it a 2-manifold?
  VoxelSize unit;                       ///< one file unit; unknown() when the file does not say
  std::vector<std::string> attributes;  ///< "normals", "colors", "k_min", ... that the file carries
  PartitionTable partitions;
  std::string provenance;          ///< JSON text, empty for foreign files
  std::optional<TabletFrame> way;  ///< how it lies, by its writing; none without triangles
};

std::string_view mesh_format_name(MeshFormat format) noexcept;

/// By the suffix, upper or lower case. kUsage for others; the text lists those that can be written.
Result<MeshFormat> mesh_format_from_path(const std::filesystem::path& path);

/// Writes the whole file or none; an old one stays until then. The suffix chooses the format. All parts go into one
/// file: STL has no groups, so give it one part at a time (select_partitions) where parts must stay watertight.
/// Curvatures are written per file unit. Colours are those of the mesh, else shape colours shaded by ambient light.
/// Errors: kUsage (suffix), kCannotCreate, kPermission, kIo, kCancelled, kInternal (arrays that contradict each other).
Result<void> write_mesh(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                        Progress& progress);

/// Recognises the format by content, by the suffix where content does not tell. Positions keep the file's numbers;
/// the frame says what one unit is, and where they are counted from when they lie far off. Equal places become one
/// vertex in STL, and in other foreign files that are more closed then; polygons and strips become triangles; the
/// photographs of a GLB file become colours of its vertices.
/// Errors: kNoInput, kPermission, kIo, kBadData (damaged or hostile; positions that are not finite), kTryAgain.
Result<TriMesh> read_mesh(const std::filesystem::path& path, Progress& progress);
/// The same, told a coarse surface (coarse_surface.h) before the whole is read, where there is one.
Result<TriMesh> read_mesh(const std::filesystem::path& path, Progress& progress, const MeshReadOptions& options,
                          const std::function<void(TriMesh)>& tell_coarse = {});

/// Reads the file and describes it.
Result<MeshInfo> mesh_info(const std::filesystem::path& path, Progress& progress, const MeshReadOptions& options = {});

/// The triangles of these partitions (bit k: of id k) and the vertices they use, in the old order.
TriMesh select_partitions(const TriMesh& mesh, std::uint8_t partitions);

}  // namespace dubsar
