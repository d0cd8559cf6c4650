#include "core/volume/formats/external_access.h"

#include <algorithm>

namespace dubsar {
namespace fs = std::filesystem;

Result<fs::path> allowed_file(const std::string& what, const fs::path& referring_file, const std::string& name,
                              const std::optional<fs::path>& allowed) {
  if (!allowed)
    return fail(ErrorKind::kBadData, "{} lies in another file \"{}\", which is not opened unless its folder is allowed",
                what, name);
  std::error_code error;
  const fs::path folder = fs::canonical(*allowed, error);
  if (error)
    return fail(ErrorKind::kNoInput, "folder of external files {}: {}, expected a folder", allowed->string(),
                error.message());
  const fs::path file = fs::canonical(referring_file.parent_path() / name, error);
  if (error) return fail(ErrorKind::kNoInput, "{} lies in another file \"{}\": {}", what, name, error.message());
  if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
    return fail(ErrorKind::kBadData, "{} lies in \"{}\", which is outside the allowed folder {}", what, name,
                folder.string());
  return file;
}

}  // namespace dubsar
