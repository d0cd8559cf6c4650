#pragma once
// Runs the built program as a user would, with its streams caught.

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace dubsar::test {

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal when killed
  std::string out, err;
  double seconds = 0.0;
};

struct RunOptions {
  /// Called with what stderr holds so far, every 10 ms; returns a signal to send, or 0.
  std::function<int(const std::string& err)> watch;
  long file_size_limit = -1;  ///< RLIMIT_FSIZE in bytes
  double timeout_s = 120.0;   ///< then the program is killed
  std::string out{};          ///< a file or device for stdout; empty: it is caught
  std::string folder{};       ///< where it runs; empty: here
};

/// Runs the program `dubsar` of this build with `arguments`.
ProgramRun run_dubsar(const std::vector<std::string>& arguments, const RunOptions& options = {});

}  // namespace dubsar::test
