#pragma once
// EXA files: a surface model on disk. What is read back equals what was written, bit for bit; a model that went
// through quantise_for_exa() first takes a fraction of the space.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/container.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct ExaBlockStats {
  std::string name;  ///< "signs", "offsets", ...
  std::int64_t bytes = 0;
  double bits_per_vertex = 0.0;  ///< 0 without vertices
};

struct ExaStats {
  std::int64_t bytes = 0, vertices = 0;
  double bits_per_vertex = 0.0;
  std::vector<ExaBlockStats> blocks;  ///< in file order; head, table and end marker are the first, "container"
};

/// What a file says about itself, without decoding the surface.
struct ExaInfo {
  int major = 0, minor = 0;
  GridFrame frame;
  Dims dims;
  float isovalue = 0.0f;
  int offset_bits = 0;
  bool closed = true;
  std::int64_t vertices = 0, quads = 0;
  PartitionTable partitions;
  std::string provenance;
  ExaStats stats;
};

/// Rounds positions to 2^-10 grid steps, normals to 12 + 12 octahedral bits and curvatures to 2^-12 per grid step,
/// which is what EXA stores compactly: call it before measuring or exporting what will be saved. Twice is the same as
/// once. All threads.
void quantise_for_exa(SurfaceModel& model);

/// Writes the whole file or none; an old one stays until then. Errors: kInternal (arrays of wrong length, connectivity
/// that does not follow from the samples), kBadData (samples or positions that cannot be stored), kCannotCreate,
/// kPermission, kIo, kCancelled. The same bytes for any number of threads.
Result<ExaStats> write_exa(const std::filesystem::path& path, const SurfaceModel& model, Progress& progress);

/// Errors: kNoInput, kPermission, kIo, kBadData (damaged, hostile, or from a later dubsar), kTryAgain (memory),
/// kCancelled.
Result<SurfaceModel> read_exa(const std::filesystem::path& path, Progress& progress);

/// Reads head, table and the small text blocks only. Errors as read_exa().
Result<ExaInfo> read_exa_info(const std::filesystem::path& path);

/// The same from and to memory, for tests and fuzzers.
Result<std::vector<ExaBlock>> encode_exa(const SurfaceModel& model, Progress& progress);
Result<SurfaceModel> decode_exa(std::string_view file, Progress& progress);

/// "signs" for "SIGN" and so on; the type itself for blocks that are not known.
std::string exa_block_name(std::string_view type);

}  // namespace dubsar
