#include "app/cli/file_uses.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/base/text/near_word.h"

namespace dubsar::app {
namespace fs = std::filesystem;
namespace {

/// The file of an input text, which may end in ":/dataset" or begin with a wire's name.
fs::path file_of(const std::string& text) {
  std::error_code ignored;
  if (fs::exists(text, ignored)) return text;
  const auto colon = text.rfind(":/");
  return colon == std::string::npos ? text : text.substr(0, colon);
}

/// The one name of a file, there or not: whole, without "." and "..", and behind links, also those that lead nowhere
/// yet.
fs::path whole_name(fs::path path) {
  std::error_code error;
  path = fs::weakly_canonical(fs::absolute(path, error), error);
  for (int links = 0; links < 40 && fs::is_symlink(path, error); ++links)
    path = fs::weakly_canonical(path.parent_path() / fs::read_symlink(path, error), error);
  return path;
}

/// By device and inode where both exist, else by name.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  const fs::path left = whole_name(a);
  return !left.empty() && left == whole_name(b);
}

Result<void> check_place(const FileUse& file) {
  std::error_code ignored;
  DUBSAR_TRY(check_output_kind(file.path));
  const fs::path given(file.path), target = fs::is_symlink(given, ignored) ? whole_name(given) : given;
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    return fail(ErrorKind::kCannotCreate, "cannot create {}: the folder {} does not exist, make it first", file.path,
                folder.string());
  if (::access(folder.c_str(), W_OK) != 0)
    return fail(ErrorKind::kPermission, "cannot create {}: no permission to write in {}", file.path, folder.string());
  return {};
}

Result<void> check_not_read(const FileUse& out, const FileUse& in) {
  std::error_code ignored;
  const fs::path read = file_of(in.path);
  if (same_file(out.path, read))
    return fail(ErrorKind::kUsage,
                "{} {} is the file that is read as {}; expected another name, so that nothing is lost", out.option,
                out.path, in.option);
  if (fs::is_directory(read, ignored) && fs::exists(out.path, ignored) &&
      same_file(fs::absolute(out.path, ignored).parent_path(), read))
    return fail(ErrorKind::kUsage, "{} {} lies in the folder that is read as {}; expected a new name", out.option,
                out.path, in.option);
  return {};
}

Result<void> check_replaced(const FileUse& out) {
  const std::string lost = what_would_be_lost(out.path, out.format);
  if (lost.empty()) return {};
  return fail(ErrorKind::kCannotCreate, "{} {} exists and is {}, which would be lost; expected another name",
              out.option, out.path, lost);
}

/// A name beside the one that is missing that differs by a slip.
Result<void> check_there(const FileUse& in) {
  std::error_code error;
  const fs::path file = file_of(in.path);
  if (fs::exists(file, error) || error) return {};  // what else is wrong with it, reading it says
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    return fail(ErrorKind::kNoInput, "there is no file {}, nor a folder {}", in.path, folder.string());
  std::vector<std::string> names;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && names.size() < 10000; at.increment(error))
    if (at->path().filename().string().find(".tmp-") == std::string::npos)
      names.push_back(file.has_parent_path() ? (folder / at->path().filename()).string()
                                             : at->path().filename().string());
  std::sort(names.begin(), names.end());
  return fail(ErrorKind::kNoInput, "there is no file {}{}", in.path, did_you_mean(file.string(), names));
}

Result<void> check_suffix(const FileUse& out) {
  if (out.format == FileFormat::kExa && lower_suffix(out.path) != ".exa")
    return fail(ErrorKind::kUsage, "{} {} found, expected a name that ends in .exa", out.option, out.path);
  const std::string suffix = lower_suffix(out.path);
  if (out.format == FileFormat::kPhantom && suffix != ".h5" && suffix != ".hdf5" && suffix != ".nxs")
    return fail(ErrorKind::kUsage, "{} {} found, expected a name that ends in .h5, .hdf5 or .nxs", out.option,
                out.path);
  return {};
}

}  // namespace

Result<void> check_inputs(std::span<const FileUse> files) {
  for (const FileUse& file : files)
    if (!file.written) DUBSAR_TRY(check_there(file));
  return {};
}

Result<void> check_apart(const FileUse& out, std::span<const std::string> made) {
  if (out.path.empty() || out.path == "-") return {};
  for (const std::string& file : made)
    if (same_file(out.path, file))
      return fail(ErrorKind::kUsage, "{} {} is a file that this run makes, expected another name", out.option,
                  out.path);
  return {};
}

Result<void> check_made(const std::string& option, const std::string& path, FileFormat format) {
  const FileUse file{option, path, true, format};
  DUBSAR_TRY(check_place(file));
  return check_replaced(file);
}

Result<void> check_file_uses(std::span<const FileUse> files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!files[i].written) continue;
    DUBSAR_TRY(check_place(files[i]));
    DUBSAR_TRY(check_suffix(files[i]));
    for (std::size_t k = 0; k < files.size(); ++k) {
      if (k == i) continue;
      if (!files[k].written) DUBSAR_TRY(check_not_read(files[i], files[k]));
      if (files[k].written && k < i && same_file(files[i].path, files[k].path))
        return fail(ErrorKind::kUsage, "{} and {} are the same file {}, expected two names", files[k].option,
                    files[i].option, files[i].path);
    }
    DUBSAR_TRY(check_replaced(files[i]));
  }
  return {};
}

}  // namespace dubsar::app
