#pragma once
// Another program that runs, and what it says.

#include <poll.h>
#include <sys/types.h>

#include <array>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// Is asked to end (SIGTERM) and waited for when it goes out of scope. One thread.
class ChildProcess {
 public:
  /// `words`: the program's path and its arguments. Its input is ours. Errors: those of posix_spawn().
  static Result<ChildProcess> start(std::vector<std::string> words);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// Adds what it says within .2 s to `came`, first standard output, then standard error; false when both have ended.
  bool read(std::array<std::string, 2>& came);
  /// Ends it at once, whatever it does (SIGKILL); for other people's code that hangs.
  void kill();
  /// Its exit code; 128 + signal when a signal ended it.
  int wait();

 private:
  ChildProcess() = default;
  pid_t id_ = -1;
  std::array<pollfd, 2> streams_{{{-1, 0, 0}, {-1, 0, 0}}};
};

}  // namespace dubsar
