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

namespace dubsar::app {

struct MeshRequest {
  std::filesystem::path path;
  std::vector<std::string> partitions;  ///< names ("tablet"), parts ("envelope") or ids ("2"); empty: all
  bool fill_holes = true;
};

/// The mesh of the request; parts are joined into one TriMesh but share no vertices. kUsage, with the names there are,
/// for a partition that is not in the file; else the reader's errors.
Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress);
/// The same; of a mesh file that takes long to read `tell_coarse` gets a coarse surface first.
Result<TriMesh> load_mesh(const MeshRequest& request, Progress& progress,
                          const std::function<void(TriMesh)>& tell_coarse);

/// kUsage when an EXA file has no part of one of these names or ids; quick, so that slips are known before a large file
/// is read. Other files, and files that cannot be read, are let through.
Result<void> check_parts(const std::filesystem::path& path, std::span<const std::string> names);

/// True when the file begins like an EXA file.
bool is_exa_file(const std::filesystem::path& path);

}  // namespace dubsar::app
