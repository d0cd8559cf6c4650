#pragma once
// Surfaces of a session from files, with the work on them.

#include <string>
#include <vector>

#include "app/cli/input_options.h"
#include "app/session/file_loader.h"
#include "app/viewer/view_options.h"

namespace dubsar::app {

/// How the files of a session are read.
struct FileReading {
  std::vector<std::string> partitions{};  ///< only these parts; empty: all
  double unit_mm = 0.0;                   ///< of mesh files; 0: as they say
  std::optional<ImportOptions> scan{};    ///< that the surface was made of; none: looked for
  bool upright = false;                   ///< the obverse stands upright, as its writing says
  bool keeps_work = false;                ///< what earlier sessions left is taken up, and this one leaves its own
};

/// Reads a file as a session with these options wants it; any thread. Errors of load_mesh().
ReadSurface surface_reader(const ViewOptions& options, const FileReading& reading);

/// Reads what documents set beside a surface of such a session: with nothing of its work, and keeping none.
ReadSurface beside_reader(ViewOptions options, FileReading reading);

/// The scan of that name, read as the options say, or the surface that was made of it; none without a name. kUsage:
/// options without a scan; errors of open_voxels(), so that slips are known before a large surface is read.
Result<std::optional<ImportOptions>> asked_scan(const std::string& scan, const InputOptionTexts& reading,
                                                const std::vector<std::string>& surfaces);

/// What can be known at once: kNoInput, kPermission, kUsage for parts that are not in it, kBadData for the head of an
/// EXA file.
Result<void> check_surface(const std::string& file, const std::vector<std::string>& partitions);

/// The file of --record (empty: none) is none that these sources read, as replay:FILE does. kUsage; errors of
/// check_file_uses().
Result<void> check_record(const std::string& record, const std::vector<std::string>& sources);

/// Frames of an earlier run in `folder` may be written over, nobody's else. kCannotCreate.
Result<void> check_frames(const std::string& folder);

}  // namespace dubsar::app
