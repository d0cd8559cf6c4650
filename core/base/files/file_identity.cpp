#include "core/base/files/file_identity.h"

#include <sys/stat.h>

#include <cerrno>

#include "core/base/files/file_fingerprint.h"

namespace dubsar {
namespace {

constexpr std::size_t kMostFingerprints = 16;

}  // namespace

Result<FileIdentity> identify_file(const std::filesystem::path& path, bool with_fingerprint) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return fail_errno(errno, fmt::format("cannot inspect {}", path.string()));
  FileIdentity found{path,
                     info.st_dev,
                     info.st_ino,
                     info.st_size,
                     info.st_mtim.tv_sec * std::int64_t{1'000'000'000} + info.st_mtim.tv_nsec,
                     {}};
  if (with_fingerprint) {
    DUBSAR_ASSIGN(found.fingerprint, file_fingerprint(path));
  }
  return found;
}

Result<std::vector<FileIdentity>> identify_files(std::span<const std::filesystem::path> paths) {
  std::vector<FileIdentity> found;
  for (const auto& path : paths) {
    DUBSAR_ASSIGN(FileIdentity one, identify_file(path, paths.size() <= kMostFingerprints));
    found.push_back(std::move(one));
  }
  return found;
}

Result<void> check_unchanged(std::span<const FileIdentity> before) {
  for (const FileIdentity& was : before) {
    const auto now = identify_file(was.path, !was.fingerprint.empty());
    const auto changed = [&](std::string_view how) {
      return fail(ErrorKind::kTryAgain,
                  "{} changed while it was read ({}), so that nothing was made of it; is it still being copied or "
                  "written? run this again when it is complete",
                  was.path.string(), how);
    };
    if (!now) return changed("it is gone");
    if (now->device != was.device || now->inode != was.inode) return changed("another file has its name");
    if (now->size != was.size) return changed(fmt::format("{} bytes, then {}", was.size, now->size));
    if (now->changed_ns != was.changed_ns) return changed("it was written to");
    if (now->fingerprint != was.fingerprint) return changed("other bytes");
  }
  return {};
}

}  // namespace dubsar
