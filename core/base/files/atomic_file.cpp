#include "core/base/files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <random>

#include "core/base/files/write_all.h"

namespace dubsar {
namespace fs = std::filesystem;

namespace {
constexpr long kTemporaryBytes = 22;  // ".NAME.tmp-PID-RANDOM" with a process number of 7 digits

/// Where a chain of links ends, also when nothing is there yet. Fails after 40 links, as the system does.
Result<fs::path> behind_links(const fs::path& name) {
  fs::path at = name;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, error)); ++links) {
    const fs::path next = fs::read_symlink(at, error);
    if (error || links == 40)
      return fail(ErrorKind::kCannotCreate, "cannot create {}: its link leads nowhere, expected a file name",
                  name.string());
    at = next.is_absolute() ? next : at.parent_path() / next;
  }
  return at;
}
}  // namespace

Result<void> check_output_kind(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  const char* found = nullptr;
  if (target.filename().empty() || fs::is_directory(status)) found = "a folder";
  if (fs::is_fifo(status)) found = "a pipe";
  if (fs::is_socket(status)) found = "a socket";
  if (fs::is_block_file(status) || fs::is_character_file(status)) found = "a device";
  if (!found) {
    DUBSAR_ASSIGN(const fs::path file, behind_links(target));
    const long most = ::pathconf(file.has_parent_path() ? file.parent_path().c_str() : ".", _PC_NAME_MAX);
    const auto bytes = static_cast<long>(file.filename().string().size());
    if (most > 0 && bytes + kTemporaryBytes > most)
      return fail(ErrorKind::kCannotCreate, "cannot create {}: its name has {} bytes, expected at most {}",
                  target.string(), bytes, most - kTemporaryBytes);
    return {};
  }
  return fail(ErrorKind::kCannotCreate, "cannot create {}: it is {}, expected a file name", target.string(), found);
}

Result<AtomicFile> AtomicFile::create(const fs::path& name, std::int64_t expected_bytes) {
  DUBSAR_TRY(check_output_kind(name));
  DUBSAR_ASSIGN(const fs::path target, behind_links(name));
  AtomicFile file;
  file.target_ = target;
  std::random_device random;
  for (int attempt = 0; attempt < 16 && file.descriptor_ < 0; ++attempt) {
    file.temporary_ =
        target.parent_path() / fmt::format(".{}.tmp-{}-{:08x}", target.filename().string(), ::getpid(), random());
    file.descriptor_ = ::open(file.temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file.descriptor_ < 0 && errno != EEXIST) break;
  }
  if (file.descriptor_ < 0) {
    auto error = fail_errno(errno, fmt::format("cannot create {}", target.string()));
    if (error.value().kind == ErrorKind::kNoInput) error.value().kind = ErrorKind::kCannotCreate;
    file.temporary_.clear();
    return error;
  }
  if (struct stat old{}; ::stat(target.c_str(), &old) == 0)
    if (::fchmod(file.descriptor_, old.st_mode & 0777) != 0)
      return fail_errno(errno, fmt::format("cannot give {} the rights of the old file", target.string()));
  if (expected_bytes > 0) {
    // EOPNOTSUPP and EINVAL: the file system cannot reserve; the write itself will tell.
    const int error = ::posix_fallocate(file.descriptor_, 0, expected_bytes);
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
      return fail_errno(error, fmt::format("cannot reserve {} bytes for {}", expected_bytes, target.string()));
    file.owns_size_ = true;
  }
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      owns_size_(other.owns_size_),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, fs::path())) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  DUBSAR_TRY(write_all(descriptor_, bytes, size_, target_));
  size_ += static_cast<std::int64_t>(bytes.size());
  return {};
}

Result<void> AtomicFile::commit() {
  const auto failed = [&](std::string_view verb) {
    return fail_errno(errno, fmt::format("cannot {} {}", verb, target_.string()));
  };
  if (owns_size_ && ::ftruncate(descriptor_, size_) != 0) return failed("cut");
  if (::fsync(descriptor_) != 0) return failed("sync");
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return failed("rename to");
  temporary_.clear();
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (const int parent = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); parent >= 0) {
    ::fsync(parent);  // some file systems refuse to sync a folder; the rename is done all the same
    ::close(parent);
  }
  return {};
}

Result<void> write_file_atomically(const fs::path& target, std::span<const std::byte> bytes) {
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(target, static_cast<std::int64_t>(bytes.size())));
  DUBSAR_TRY(file.write(bytes));
  return file.commit();
}

Result<void> write_file_atomically(const fs::path& target, std::string_view text) {
  return write_file_atomically(target, std::as_bytes(std::span(text.data(), text.size())));
}

Result<std::string> read_text_file(const fs::path& path, std::int64_t max_bytes) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return fail_errno(errno, fmt::format("cannot open {}", path.string()));
  struct Closer {
    int fd;
    ~Closer() { ::close(fd); }
  } closer{descriptor};
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) return fail_errno(errno, fmt::format("cannot inspect {}", path.string()));
  if (!S_ISREG(info.st_mode)) return fail(ErrorKind::kBadData, "{} is not a regular file, expected one", path.string());
  if (info.st_size > max_bytes)
    return fail(ErrorKind::kBadData, "{} has {} bytes, expected at most {}", path.string(), info.st_size, max_bytes);
  std::string text(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::read(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail_errno(errno, fmt::format("cannot read {}", path.string()));
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  text.resize(done);
  return text;
}

}  // namespace dubsar
