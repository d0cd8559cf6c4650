#include "core/base/files/kept_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <system_error>

#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/file_lock.h"
#include "core/base/system/utc_day.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
constexpr std::string_view kOrphan = ".orphan-";

Result<std::optional<std::string>> text_of(const fs::path& file, std::int64_t max_bytes) {
  std::error_code error;
  if (file.empty() || fs::status(file, error).type() == fs::file_type::not_found) return std::optional<std::string>();
  auto text = read_text_file(file, max_bytes);
  if (!text && text.error().kind == ErrorKind::kNoInput) return std::optional<std::string>();  // it went meanwhile
  if (!text) return tl::unexpected<Error>(text.error());
  return std::optional(*std::move(text));
}

}  // namespace

Result<std::optional<std::string>> KeptFile::read(std::int64_t max_bytes) {
  known_.reset();
  DUBSAR_ASSIGN(std::optional<std::string> text, text_of(file_, max_bytes));
  known_ = text ? bytes_checksum(*text) : std::string();
  return text;
}

bool KeptFile::is_known() const {
  const auto text = text_of(file_, kLargest);
  if (!text) return false;  // what cannot be read is nobody we know
  return known_ && *known_ == (*text ? bytes_checksum(**text) : std::string());
}

Result<Kept> KeptFile::write(std::string_view text) {
  if (file_.empty()) return fail(ErrorKind::kCannotCreate, "there is no place where this could be kept");
  DUBSAR_ASSIGN(const FileLock lock, FileLock::take(file_));
  DUBSAR_ASSIGN(AtomicFile next, AtomicFile::create(file_, static_cast<std::int64_t>(text.size())));
  DUBSAR_TRY(next.write(text));
  if (!is_known()) return Kept::kStranger;
  DUBSAR_TRY(next.commit());
  known_ = bytes_checksum(text);
  return Kept::kDone;
}

Result<Kept> KeptFile::remove() {
  DUBSAR_ASSIGN(const FileLock lock, FileLock::take(file_));
  if (!is_known()) return Kept::kStranger;
  if (!known_->empty() && ::unlink(file_.c_str()) != 0)
    return fail_errno(errno, fmt::format("cannot remove {}", file_.string()));
  known_ = std::string();
  return Kept::kDone;
}

Result<fs::path> KeptFile::set_aside() {
  DUBSAR_ASSIGN(const FileLock lock, FileLock::take(file_));
  struct stat info {};
  if (::lstat(file_.c_str(), &info) != 0) return fail_errno(errno, fmt::format("cannot inspect {}", file_.string()));
  const std::string first = fmt::format("{}{}{}", file_.string(), kOrphan, utc_day(info.st_mtime));
  for (int number = 1; number < 10'000; ++number) {
    const fs::path aside = number == 1 ? fs::path(first) : fs::path(fmt::format("{}-{}", first, number));
    if (::renameat2(AT_FDCWD, file_.c_str(), AT_FDCWD, aside.c_str(), RENAME_NOREPLACE) != 0) {
      if (errno == EEXIST) continue;
      // File systems without that: a second name, which is never given to two files.
      if (errno != EINVAL && errno != ENOSYS) return fail_errno(errno, fmt::format("cannot rename {}", file_.string()));
      if (::link(file_.c_str(), aside.c_str()) != 0) {
        if (errno == EEXIST) continue;
        return fail_errno(errno, fmt::format("cannot rename {}", file_.string()));
      }
      if (::unlink(file_.c_str()) != 0) return fail_errno(errno, fmt::format("cannot rename {}", file_.string()));
    }
    known_ = std::string();
    return aside;
  }
  return fail(ErrorKind::kCannotCreate, "cannot set {} aside: too many files of its name are there", file_.string());
}

std::string set_aside_day(const fs::path& file) {
  constexpr std::size_t kDay = 10;  // letters
  const std::string name = file.filename().string();
  const std::size_t at = name.rfind(kOrphan);
  return at == std::string::npos ? std::string() : name.substr(at + kOrphan.size(), kDay);
}

std::vector<fs::path> set_aside_of(const fs::path& file) {
  std::vector<fs::path> out;
  const std::string beginning = file.filename().string() + std::string(kOrphan);
  std::error_code error;
  for (fs::directory_iterator at(file.parent_path(), error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().starts_with(beginning)) out.push_back(at->path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace dubsar
