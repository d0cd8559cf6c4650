#include "app/document/file_kinds.h"

#include <algorithm>
#include <array>
#include <span>
#include <system_error>

#include "core/base/files/file_suffix.h"

namespace dubsar::app {
namespace {

bool ends_in(const std::filesystem::path& path, std::span<const std::string_view> suffixes) {
  return std::find(suffixes.begin(), suffixes.end(), lower_suffix(path)) != suffixes.end();
}

}  // namespace

bool names_a_surface(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  const std::size_t at = suffix.empty() ? std::string_view::npos : kSurfaceSuffixes.find(suffix);
  if (at == std::string_view::npos) return false;
  const std::size_t end = at + suffix.size();
  return end == kSurfaceSuffixes.size() || kSurfaceSuffixes[end] == ',' || kSurfaceSuffixes[end] == ' ';
}

bool names_a_scan(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 6> kSuffixes{".h5", ".hdf5", ".hdf", ".nxs", ".nrrd", ".nhdr"};
  return ends_in(path, kSuffixes);
}

bool names_a_slice(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 2> kSuffixes{".tif", ".tiff"};
  return ends_in(path, kSuffixes);
}

Result<void> check_surface_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    return fail(ErrorKind::kNoInput, "{}: there is no such file", file.string());
  if (std::filesystem::is_directory(file, error))
    return fail(ErrorKind::kUsage, "{} is a folder, expected a surface such as tablet.exa", file.string());
  if (!names_a_surface(file))
    return fail(ErrorKind::kUsage, "{} is no surface by its name, expected {}", file.string(), kSurfaceSuffixes);
  return {};
}

}  // namespace dubsar::app
