#include "core/base/result.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace dubsar {

tl::unexpected<Error> fail_errno(int error_number, std::string_view what) {
  ErrorKind kind = ErrorKind::kIo;
  if (error_number == EACCES || error_number == EPERM || error_number == EROFS) kind = ErrorKind::kPermission;
  if (error_number == ENOENT || error_number == ENOTDIR) kind = ErrorKind::kNoInput;
  if (error_number == ENOMEM) kind = ErrorKind::kTryAgain;
  return fail(kind, "{}: {}", what, std::generic_category().message(error_number));
}

void check_failed(const char* condition, const char* file, int line) {
  throw std::logic_error(fmt::format("{}:{}: check failed: {}", file, line, condition));
}

}  // namespace dubsar
