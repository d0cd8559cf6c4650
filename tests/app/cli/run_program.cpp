#include "tests/app/cli/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dubsar::test {
namespace {

/// Reads what is there without waiting; false at the end of the stream.
bool drain(int descriptor, std::string& text) {
  char buffer[65536];
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer, sizeof buffer);
    if (count > 0)
      text.append(buffer, static_cast<std::size_t>(count));
    else
      return count < 0;
  }
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const RunOptions& options, int out,
                                 int err) {
  ::dup2(options.out.empty() ? out : ::open(options.out.c_str(), O_WRONLY), STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  if (options.file_size_limit >= 0) {
    const rlimit limit{static_cast<rlim_t>(options.file_size_limit), static_cast<rlim_t>(options.file_size_limit)};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
  std::vector<char*> argv{const_cast<char*>(DUBSAR_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(DUBSAR_PROGRAM, argv.data());
  ::_exit(127);
}

}  // namespace

ProgramRun run_dubsar(const std::vector<std::string>& arguments, const RunOptions& options) {
  int out_pipe[2], err_pipe[2];
  ProgramRun run;
  if (::pipe2(out_pipe, O_CLOEXEC) != 0 || ::pipe2(err_pipe, O_CLOEXEC) != 0) return run;
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) become_program(arguments, options, out_pipe[1], err_pipe[1]);
  ::close(out_pipe[1]);
  ::close(err_pipe[1]);
  for (const int d : {out_pipe[0], err_pipe[0]}) ::fcntl(d, F_SETFL, O_NONBLOCK);
  int status = 0;
  bool signalled = false;
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  while (::waitpid(child, &status, WNOHANG) == 0) {
    pollfd streams[2] = {{out_pipe[0], POLLIN, 0}, {err_pipe[0], POLLIN, 0}};
    ::poll(streams, 2, 10);
    drain(out_pipe[0], run.out);
    drain(err_pipe[0], run.err);
    if (options.watch && !signalled)
      if (const int signal = options.watch(run.err); signal != 0) {
        signalled = true;
        ::kill(child, signal);
      }
    if (elapsed() > options.timeout_s) ::kill(child, SIGKILL);
  }
  run.seconds = elapsed();
  drain(out_pipe[0], run.out);
  drain(err_pipe[0], run.err);
  ::close(out_pipe[0]);
  ::close(err_pipe[0]);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

}  // namespace dubsar::test
