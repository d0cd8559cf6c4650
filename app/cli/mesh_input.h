#pragma once
// Surfaces from files: EXA and mesh formats, whole or some of their parts.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar::app {

struct MeshRequest {
  std::filesystem::path path;
  std::vector<std::string> partitions;  ///< names ("tablet"), parts ("envelope") or ids ("2"); empty: all
  bool fill_holes = true;
  MeshReadOptions foreign{};  ///< of mesh files
  bool divide_pores = false;  ///< pores go with the body that they lie in (pores_by_body.h): for who moves parts
};

/// The mesh of the request; parts are joined into one TriMesh but share no vertices. kUsage, with the names there are,
/// for a partition that is not in the file; else the reader's errors.
Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress);
/// The same; of a mesh file that takes long to read `tell_coarse` gets a coarse surface first.
Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress,
                          const std::function<void(TriMesh)>& tell_coarse);

/// What was written on, of a file: `part` is "auto" (the tablet where there is one, else everything), "all", or a name;
/// `unit` as --unit says it. Errors of load_mesh(), mesh_unit_mm(). `photo_detail`: for pictures; where the shape
/// counts triangles stay as fine as they were measured.
Result<TriMesh> load_written_part(const std::string& path, const std::string& part, const std::string& unit,
                                  Progress& progress, bool photo_detail = false);

/// "--unit": what one unit of a mesh file is.
inline constexpr const char* kUnitHelp =
    "of a mesh file, what one unit is: m, cm, mm, um, inch; where the file does not say, or means mm and says m as GLB "
    "does";
/// mm in it; 0 for an empty text. kUsage for what is no unit.
Result<double> mesh_unit_mm(const std::string& unit);

/// kUsage when an EXA file has no part of one of these names or ids; quick, so that slips are known before a large file
/// is read. Other files, and files that cannot be read, are let through.
Result<void> check_parts(const std::filesystem::path& path, std::span<const std::string> names);

/// True when the file begins like an EXA file.
bool is_exa_file(const std::filesystem::path& path);

}  // namespace dubsar::app
