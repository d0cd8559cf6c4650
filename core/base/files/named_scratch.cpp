#include "core/base/files/named_scratch.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>

#include "core/base/files/write_all.h"

namespace dubsar {
namespace fs = std::filesystem;

Result<std::shared_ptr<const NamedScratch>> NamedScratch::create(std::string_view stem, std::string_view suffix,
                                                                 std::string_view text) {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) return fail_errno(error.value(), "cannot find the folder for temporary files");
  std::string name = (folder / fmt::format("{}_XXXXXX{}", stem, suffix)).string();
  const int descriptor = ::mkostemps(name.data(), static_cast<int>(suffix.size()), O_CLOEXEC);
  if (descriptor < 0) return fail_errno(errno, fmt::format("cannot create {}", name));
  std::shared_ptr<const NamedScratch> out(new NamedScratch(name));
  const Result<void> written = write_all(descriptor, std::as_bytes(std::span(text)), 0, name);
  if (::close(descriptor) != 0 && written) return fail_errno(errno, fmt::format("cannot write {}", name));
  DUBSAR_TRY(written);
  return out;
}

NamedScratch::~NamedScratch() {
  std::error_code gone;
  fs::remove(path_, gone);
}

}  // namespace dubsar
