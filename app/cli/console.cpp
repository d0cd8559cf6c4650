#include "app/cli/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "app/cli/fit_columns.h"
#include "core/base/progress.h"

namespace dubsar::app {
namespace {

std::atomic<Progress*> g_signal_target{nullptr};

void on_signal(int) {
  Progress* const target = g_signal_target.load();
  if (target == nullptr || target->cancelled()) ::_exit(exit_code(ErrorKind::kCancelled));
  target->cancel();
}

/// Of the terminal that it is; none: it is no terminal, or that does not say.
std::optional<int> columns_of(int stream) {
  winsize size{};
  if (::ioctl(stream, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return std::nullopt;
  return size.ws_col;
}

}  // namespace

void put_on_stderr(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

bool stderr_is_terminal() {
  const char* const terminal = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && (terminal == nullptr || std::strcmp(terminal, "dumb") != 0);
}

int stderr_columns() { return columns_of(STDERR_FILENO).value_or(80); }

std::optional<int> stdout_columns() {
  if (const auto columns = columns_of(STDOUT_FILENO)) return columns;
  const char* const told = std::getenv("COLUMNS");
  const int columns = told != nullptr ? std::atoi(told) : 0;
  return columns > 0 ? std::optional<int>(columns) : std::nullopt;
}

bool stderr_has_colour() {
  const char* const no_colour = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (no_colour == nullptr || *no_colour == '\0');
}

void install_log(const ConsoleOptions& options) {
  const bool colour = stderr_has_colour();
  set_log_handler([options, colour](LogLevel level, std::string_view message) {
    if (level == LogLevel::kDebug && !options.verbose) return;
    if (level != LogLevel::kError && options.quiet) return;
    const std::string_view prefix = level == LogLevel::kError     ? "error: "
                                    : level == LogLevel::kWarning ? "warning: "
                                                                  : "";
    const std::string_view on = !colour                       ? ""
                                : level == LogLevel::kError   ? "\x1b[31m"
                                : level == LogLevel::kWarning ? "\x1b[33m"
                                                              : "";
    const bool terminal = stderr_is_terminal();
    std::string text = fmt::format("{}{}", prefix, message);
    if (terminal) text = fit_columns(text, stderr_columns());
    put_on_stderr(fmt::format("{}{}{}{}{}\n", terminal ? "\r\x1b[K" : "", on, text.substr(0, prefix.size()),
                              on.empty() ? "" : "\x1b[0m", text.substr(prefix.size())));
  });
}

void cancel_on_signals(Progress& progress) {
  g_signal_target.store(&progress);
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error of write(2), not a death
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace dubsar::app
