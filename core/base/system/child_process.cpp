#include "core/base/system/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <utility>

extern char** environ;

namespace dubsar {

Result<ChildProcess> ChildProcess::start(std::vector<std::string> words) {
  ChildProcess out;
  std::array<std::array<int, 2>, 2> pipes{};
  for (auto& pipe : pipes)
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return fail_errno(errno, "cannot start " + words[0]);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (int stream = 0; stream < 2; ++stream)
    ::posix_spawn_file_actions_adddup2(&actions, pipes[static_cast<std::size_t>(stream)][1], stream + 1);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int error = ::posix_spawn(&out.id_, words[0].c_str(), &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  for (std::size_t stream = 0; stream < 2; ++stream) {
    ::close(pipes[stream][1]);
    out.streams_[stream] = {pipes[stream][0], POLLIN, 0};
  }
  if (error != 0) {
    out.id_ = -1;
    return fail_errno(error, "cannot start " + words[0]);
  }
  return out;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : id_(std::exchange(other.id_, -1)), streams_(other.streams_) {
  for (pollfd& stream : other.streams_) stream.fd = -1;
}

ChildProcess::~ChildProcess() {
  if (id_ > 0) {
    ::kill(id_, SIGTERM);
    wait();
  }
  for (const pollfd& stream : streams_)
    if (stream.fd >= 0) ::close(stream.fd);
}

bool ChildProcess::read(std::array<std::string, 2>& came) {
  constexpr int kPollMs = 200;
  ::poll(streams_.data(), streams_.size(), kPollMs);
  bool open = false;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    pollfd& stream = streams_[i];
    if (stream.fd < 0) continue;
    if ((stream.revents & (POLLIN | POLLHUP | POLLERR)) == 0) {
      open = true;
      continue;
    }
    std::array<char, 4096> part;
    const ssize_t got = ::read(stream.fd, part.data(), part.size());
    if (got > 0) came[i].append(part.data(), static_cast<std::size_t>(got));
    if (got > 0 || (got < 0 && errno == EINTR)) {
      open = true;
      continue;
    }
    ::close(stream.fd);
    stream.fd = -1;
  }
  return open;
}

void ChildProcess::kill() {
  if (id_ > 0) ::kill(id_, SIGKILL);
}

int ChildProcess::wait() {
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace dubsar
