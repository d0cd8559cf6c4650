#pragma once
// Options that say how a volume file is read; shared by `process`, `info` and `view`.

#include <string>
#include <vector>

#include "app/cli/arguments.h"
#include "core/volume/formats/import_options.h"

namespace dubsar::app {

struct InputOptionTexts {
  std::string dataset, axis_order, crop, stride, voxel_size, dims, type, endian = "little", allow_external;
  std::int64_t skip = 0;
  std::vector<std::string> ignore;
  bool trust = false, allow_sparse = false;
};

void add_input_options(Arguments command, InputOptionTexts& texts);
/// Those that say how its file is read, not which part of it is taken: for verbs that look into a scan.
void add_scan_options(Arguments command, InputOptionTexts& texts);

/// Texts to options; kUsage with the text that is wrong.
Result<ImportOptions> parse_input_options(const std::string& path, const InputOptionTexts& texts);

}  // namespace dubsar::app
