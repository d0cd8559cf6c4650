#include "core/base/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/base/system/budget.h"

namespace dubsar {

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  InputFile file;
  file.path_ = path;
  file.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file.descriptor_ < 0) return fail_errno(errno, fmt::format("cannot open {}", path.string()));
  struct stat info {};
  if (::fstat(file.descriptor_, &info) != 0) return fail_errno(errno, fmt::format("cannot inspect {}", path.string()));
  if (!S_ISREG(info.st_mode))
    return fail(ErrorKind::kBadData, "{} is {}, expected a regular file", path.string(),
                S_ISDIR(info.st_mode) ? "a folder" : "a pipe, socket or device");
  file.size_ = info.st_size;
  return file;
}

InputFile::InputFile(InputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_), path_(std::move(other.path_)) {}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(path_, other.path_);
  return *this;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> InputFile::read_at(std::int64_t offset, std::span<std::byte> out) const {
  constexpr std::size_t kAtOnce = std::size_t{1} << 30;  // Linux transfers at most 2^31 - 4096 bytes in one call
  while (!out.empty()) {
    const ssize_t count = ::pread(descriptor_, out.data(), std::min(out.size(), kAtOnce), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail_errno(errno, fmt::format("cannot read {}", path_.string()));
    if (count == 0)
      return fail(ErrorKind::kBadData,
                  "{} ends at byte {}, expected {} more bytes: it was cut or is still being written", path_.string(),
                  offset, out.size());
    out = out.subspan(static_cast<std::size_t>(count));
    offset += count;
  }
  return {};
}

void InputFile::will_read(std::int64_t offset, std::int64_t bytes) const noexcept {
  ::posix_fadvise(descriptor_, offset, bytes, POSIX_FADV_WILLNEED);
}

Result<std::string> read_bytes(const InputFile& file, std::int64_t offset, std::int64_t count) {
  if (offset < 0 || count < 0 || offset > file.size() || count > file.size() - offset)
    return fail(ErrorKind::kBadData, "{}: {} bytes wanted at {}, but the file has {}", file.path().string(), count,
                offset, file.size());
  constexpr std::int64_t kSmall = 64 << 20;  // below this the look at free memory is not worth it
  if (count > kSmall) DUBSAR_TRY(check_memory(file.path().string(), static_cast<std::uint64_t>(count)));
  std::string bytes(static_cast<std::size_t>(count), '\0');
  DUBSAR_TRY(file.read_at(offset, std::as_writable_bytes(std::span(bytes.data(), bytes.size()))));
  return bytes;
}

Result<std::string> read_file_bytes(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile file, InputFile::open(path));
  return read_bytes(file, 0, file.size());
}

}  // namespace dubsar
