#pragma once
// The door for inputs that name other files: links, external storage, detached data.

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace dubsar {

/// The file `name`, as named in `referring_file` (relative names start at the folder of that file), when it lies inside
/// `allowed` after all symbolic links are resolved. `what` starts the error text, e.g. "import_hdf5: dataset \"/a\"".
/// kBadData when no folder is allowed or the file lies outside, kNoInput when it does not exist.
Result<std::filesystem::path> allowed_file(const std::string& what, const std::filesystem::path& referring_file,
                                           const std::string& name,
                                           const std::optional<std::filesystem::path>& allowed);

}  // namespace dubsar
