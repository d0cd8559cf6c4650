#include "core/base/files/write_all.h"

#include <unistd.h>

#include <cerrno>

namespace dubsar {
namespace fs = std::filesystem;

Result<void> write_all(int descriptor, std::span<const std::byte> bytes, std::int64_t offset, const fs::path& name) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail_errno(errno, fmt::format("cannot write {}", name.string()));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += written;
  }
  return {};
}

}  // namespace dubsar
