#pragma once
// How the program talks: results on stdout, everything else on stderr, and one way to be stopped.

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/system/log.h"

namespace dubsar::app {

enum class ProgressStyle { kAuto, kBar, kJson, kNone };

struct ConsoleOptions {
  ProgressStyle progress = ProgressStyle::kAuto;
  bool quiet = false;    ///< errors only
  bool verbose = false;  ///< debug messages and tables too
};

void put_on_stderr(const std::string& text);  ///< at once

/// True when stderr is a terminal that understands cursor movement, and NO_COLOR is not set for colours.
bool stderr_is_terminal();
int stderr_columns();  ///< of the terminal; 80 where it does not say
/// Of the terminal that stdout is, or COLUMNS where that is set; none: nobody counts.
std::optional<int> stdout_columns();
bool stderr_has_colour();

/// Installs the log handler (stderr, prefix by level, colours where allowed).
void install_log(const ConsoleOptions& options);

/// SIGINT, SIGTERM and SIGHUP cancel `progress`; the second signal ends the program at once. Call once.
void cancel_on_signals(Progress& progress);

}  // namespace dubsar::app
