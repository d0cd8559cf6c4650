#include "core/base/files/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

namespace dubsar {

Result<ScratchFile> ScratchFile::create(const std::filesystem::path& folder) {
  int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {  // file systems without nameless files
    std::string name = (folder / "dubsar-XXXXXX").string();
    descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor >= 0) ::unlink(name.c_str());
  }
  if (descriptor < 0) return fail_errno(errno, fmt::format("cannot create a scratch file in {}", folder.string()));
  return ScratchFile(descriptor);
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

ScratchFile& ScratchFile::operator=(ScratchFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> ScratchFile::write_at(std::int64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ::ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      return fail(ErrorKind::kIo, "cannot write a scratch file: {}", std::generic_category().message(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += count;
  }
  return {};
}

Result<void> ScratchFile::read_at(std::int64_t offset, std::span<std::byte> out) const {
  std::int64_t read = 0;
  while (!out.empty()) {
    const ::ssize_t count = ::pread(descriptor_, out.data(), out.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      return fail(ErrorKind::kIo, "cannot read back a scratch file: {}", std::generic_category().message(errno));
    if (count == 0)
      return fail(ErrorKind::kIo, "a scratch file ends too early: {} bytes found behind byte {}, expected {}", read,
                  offset - read, read + static_cast<std::int64_t>(out.size()));
    out = out.subspan(static_cast<std::size_t>(count));
    offset += count;
    read += count;
  }
  return {};
}

}  // namespace dubsar
