#include <unistd.h>

#include <filesystem>

#include "app/cli/verb.h"

namespace dubsar::app {
namespace fs = std::filesystem;

Result<void> check_output_path(const std::string& path) {
  std::error_code ignored;
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (target.filename().empty() || fs::is_directory(target, ignored))
    return fail(ErrorKind::kCannotCreate, "cannot create {}: it is a folder, expected a file name", path);
  if (!fs::is_directory(folder, ignored))
    return fail(ErrorKind::kCannotCreate, "cannot create {}: the folder {} does not exist, make it first", path,
                folder.string());
  if (::access(folder.c_str(), W_OK) != 0)
    return fail(ErrorKind::kPermission, "cannot create {}: no permission to write in {}", path, folder.string());
  return {};
}

}  // namespace dubsar::app
