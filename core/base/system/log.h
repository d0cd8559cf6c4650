#pragma once
// Messages for people. Libraries never print: they call log(), and the program installs a handler.

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace dubsar {

enum class LogLevel { kDebug, kInfo, kWarning, kError };
using LogHandler = std::function<void(LogLevel, std::string_view)>;

/// Installs the handler for the whole process (default: messages are dropped). Call before threads start.
void set_log_handler(LogHandler handler);

/// Passes one message, as plain_text() without a trailing newline, to the handler. Any thread; calls are serialised.
void log(LogLevel level, std::string_view message);

template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
  log(LogLevel::kDebug, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace dubsar
