#pragma once
// Result<T>: a value, or an Error that the outside world caused. Our own mistakes are DUBSAR_CHECK.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace dubsar {

/// What went wrong; the number is the exit code of the program (after sysexits.h).
enum class ErrorKind : int {
  kUsage = 64,         ///< a wrong option or argument
  kBadData = 65,       ///< the input is damaged, hostile or not what was asked for
  kNoInput = 66,       ///< the input does not exist or cannot be opened
  kUnavailable = 69,   ///< a device, service, plug-in or GL context is missing
  kInternal = 70,      ///< our own mistake
  kCannotCreate = 73,  ///< an output cannot be created
  kIo = 74,            ///< reading or writing failed, disk full
  kTryAgain = 75,      ///< out of memory or interrupted: can be run again or resumed
  kPermission = 77,    ///< not allowed to read or write
  kConfig = 78,        ///< a configuration or profile file is wrong
  kCancelled = 130,    ///< the user stopped it
};

/// One sentence: what was found, what was expected, what to do. Starts with the module, e.g. "import_hdf5: ...".
struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string message;
};

constexpr int exit_code(ErrorKind kind) noexcept { return static_cast<int>(kind); }

template <class T>
using Result = tl::expected<T, Error>;

/// `return fail(ErrorKind::kBadData, "ply: {} vertices announced, {} found", a, b);`
template <class... Args>
tl::unexpected<Error> fail(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{kind, fmt::format(format, std::forward<Args>(args)...)});
}

/// The error for a failed system call: EACCES and EPERM are kPermission, ENOENT kNoInput, ENOSPC, EDQUOT, EIO
/// and others kIo. `what` reads "cannot open /path/file".
tl::unexpected<Error> fail_errno(int error_number, std::string_view what);

[[noreturn]] void check_failed(const char* condition, const char* file, int line);

/// For our own mistakes only: throws std::logic_error, which the program reports as internal error (70).
#define DUBSAR_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::dubsar::check_failed(#condition, __FILE__, __LINE__))

/// Evaluates an expression of type Result<T>; returns its error from the enclosing function, if any.
#define DUBSAR_TRY(expression)                                                     \
  do {                                                                             \
    if (auto dubsar_result_ = (expression); !dubsar_result_)                       \
      return ::tl::unexpected<::dubsar::Error>(std::move(dubsar_result_).error()); \
  } while (false)

#define DUBSAR_CONCAT_INNER(a, b) a##b
#define DUBSAR_CONCAT(a, b) DUBSAR_CONCAT_INNER(a, b)
/// `DUBSAR_ASSIGN(auto volume, read_volume(path));`
#define DUBSAR_ASSIGN(declaration, expression) \
  DUBSAR_ASSIGN_INNER(DUBSAR_CONCAT(dubsar_value_, __LINE__), declaration, expression)
#define DUBSAR_ASSIGN_INNER(name, declaration, expression)                      \
  auto name = (expression);                                                     \
  if (!name) return ::tl::unexpected<::dubsar::Error>(std::move(name).error()); \
  declaration = *std::move(name)

}  // namespace dubsar
