#include "core/base/files/growing_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace dubsar {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLeftOvers = 100;

tl::unexpected<Error> cannot_create(int error, const fs::path& path) {
  auto failed = fail_errno(error, fmt::format("cannot create {}", path.string()));
  if (failed.value().kind == ErrorKind::kNoInput) failed.value().kind = ErrorKind::kCannotCreate;
  return failed;
}

int create_new(const fs::path& path) { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }

}  // namespace

Result<GrowingFile> GrowingFile::create(const fs::path& target) {
  GrowingFile file;
  std::error_code error;
  const fs::file_status found = fs::status(target, error);
  if (target.filename().empty() || fs::is_directory(found))
    return fail(ErrorKind::kCannotCreate, "cannot create {}: it is a folder, expected a file name", target.string());
  file.target_ = file.path_ = target;
  if (!fs::exists(found)) {
    file.descriptor_ = create_new(target);
    if (file.descriptor_ < 0 && errno == EEXIST)
      return fail(ErrorKind::kCannotCreate, "cannot create {}: it is a symbolic link to nothing", target.string());
  } else if (!fs::is_regular_file(found)) {
    file.regular_ = false;
    file.descriptor_ = ::open(target.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);  // a FIFO that nobody reads: ENXIO
    if (file.descriptor_ >= 0) ::fcntl(file.descriptor_, F_SETFL, 0);
  } else {
    file.target_ = fs::canonical(target, error);
    if (error) return cannot_create(error.value(), target);
    for (int attempt = 1; attempt <= kMostLeftOvers && file.descriptor_ < 0; ++attempt) {
      file.path_ = file.target_;
      file.path_ += attempt == 1 ? std::string(".partial") : fmt::format(".partial{}", attempt);
      file.descriptor_ = create_new(file.path_);
      if (file.descriptor_ < 0 && errno != EEXIST) break;
    }
  }
  if (file.descriptor_ < 0) return cannot_create(errno, file.path_);
  return file;
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      regular_(other.regular_),
      target_(std::move(other.target_)),
      path_(std::move(other.path_)) {}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> GrowingFile::append(std::string_view text) {
  DUBSAR_CHECK(descriptor_ >= 0);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail_errno(errno, fmt::format("cannot write {}", path_.string()));
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> GrowingFile::finish() {
  DUBSAR_CHECK(descriptor_ >= 0);
  const int descriptor = std::exchange(descriptor_, -1);
  const bool synced = !regular_ || ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!synced) return fail_errno(error, fmt::format("cannot sync {}", path_.string()));
  if (has_its_name()) return {};
  if (::rename(path_.c_str(), target_.c_str()) != 0)
    return fail_errno(errno, fmt::format("cannot rename {} to {}", path_.string(), target_.string()));
  path_ = target_;
  return {};
}

void GrowingFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (regular_ && !path_.empty()) ::unlink(path_.c_str());
}

}  // namespace dubsar
