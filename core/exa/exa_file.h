#pragma once
// EXA files: a surface model on disk (docs/exa.md). What is read back equals what was written, bit for bit; a model
// that went through settle_for_exa() first takes a twentieth of the space.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/container.h"
#include "core/exa/exa_text.h"
#include "core/exa/signs/topology.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct ExaBlockStats {
  std::string name;  ///< "signs_8", "offsets", ...
  std::int64_t bytes = 0;
  double bits_per_vertex = 0.0;  ///< 0 without vertices
  std::int64_t chunks = 0;
};

struct ExaStats {
  std::int64_t bytes = 0, vertices = 0;
  double bits_per_vertex = 0.0;
  std::vector<ExaBlockStats> blocks;  ///< in file order; head, table and end mark are the first, "container"
};

/// What a file says about itself, without decoding the surface.
struct ExaInfo {
  int major = 0, minor = 0;
  ExaHeader header;
  PartitionTable partitions;
  std::string provenance;
  ExaStats stats;
};

/// Writes the whole file or none; an old one stays until then. Errors: kInternal (arrays of wrong length, connectivity
/// that does not follow from the samples), kBadData (samples or positions that cannot be stored), kCannotCreate,
/// kPermission, kIo, kCancelled. The same bytes for any number of threads.
Result<ExaStats> write_exa(const std::filesystem::path& path, const SurfaceModel& model, Progress& progress);

/// As decode_salvaged() (exa_salvage.h). Errors as read_exa().
struct SalvagedExa;
Result<SalvagedExa> salvage_exa(const std::filesystem::path& path, Progress& progress);

struct ExaReadOptions {
  bool recompute = true;  ///< normals, curvatures and shape classes that the file leaves to the reader; else empty
};

/// Errors: kNoInput, kPermission, kIo, kBadData (damaged, hostile, or from another version), kTryAgain (memory),
/// kCancelled.
Result<SurfaceModel> read_exa(const std::filesystem::path& path, Progress& progress,
                              const ExaReadOptions& options = {});

/// Reads head, table and the small text blocks only. Errors as read_exa().
Result<ExaInfo> read_exa_info(const std::filesystem::path& path);

/// A coarser surface: that of every 2^level-th grid point (level 1..3), a closed 2-manifold with vertices half-way
/// along the edges and no attributes. Reads and decodes no finer signs. Errors as read_exa().
Result<SurfaceModel> read_exa_level(const std::filesystem::path& path, int level, Progress& progress);

/// The surface of the bricks that touch a box of grid points, open where they end, without attributes and escapes.
/// Reads and decodes no other bricks. Errors as read_exa(); kUsage: the box lies outside the grid.
Result<SurfaceModel> read_exa_box(const std::filesystem::path& path, const GridBox& box, Progress& progress);

/// Checks all sums of a file, known blocks or not, without decoding. Errors as read_exa().
Result<void> check_exa_sums(const std::filesystem::path& path);

/// The same from and to memory, for tests and fuzzers.
Result<std::vector<ExaBlock>> encode_exa(const SurfaceModel& model, Progress& progress);
Result<SurfaceModel> decode_exa(std::string_view file, Progress& progress, const ExaReadOptions& options = {});

}  // namespace dubsar
