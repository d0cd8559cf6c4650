#include "core/base/files/file_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kAgain(5);
constexpr int kTries = 400;
constexpr std::time_t kForgottenS = 60;  // nobody writes for so long

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "?";
}

struct Owner {
  long pid = 0;
  std::string host;
};

std::optional<Owner> parse_owner(const std::string& text) {
  std::istringstream words(text);
  Owner out;
  if (!(words >> out.pid >> out.host) || out.pid <= 0) return std::nullopt;
  return out;
}

/// A lock that nobody holds any more: its process is gone, or it is old. What is no lock is not ours to take away; an
/// empty one is of a process that ended before it wrote its name.
bool left_alone(const fs::path& lock, const std::string& text, const std::optional<Owner>& owner) {
  if (!owner && !text.empty()) return false;
  if (owner && owner->host == host_name() && ::kill(static_cast<pid_t>(owner->pid), 0) != 0 && errno == ESRCH)
    return true;
  struct stat info {};
  return ::stat(lock.c_str(), &info) == 0 && ::time(nullptr) - info.st_mtime > kForgottenS;
}

/// Takes a lock that was left alone away. Another process may have done so and made its own meanwhile: that is put
/// back.
void break_lock(const fs::path& lock, const std::string& expected) {
  const std::string away = fmt::format("{}.{}", lock.string(), ::getpid());
  if (::rename(lock.c_str(), away.c_str()) != 0) return;
  if (const auto text = read_text_file(away); text && *text != expected)
    static_cast<void>(::link(away.c_str(), lock.c_str()) == 0);
  ::unlink(away.c_str());
}

}  // namespace

Result<FileLock> FileLock::take(const fs::path& file) {
  FileLock out;
  const fs::path lock = file.parent_path() / fmt::format(".{}.lock", file.filename().string());
  const std::string mine = fmt::format("{} {}\n", ::getpid(), host_name());
  std::optional<Owner> owner;
  for (int i = 0; i < kTries; ++i) {
    const int descriptor = ::open(lock.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      out.lock_ = lock;
      const auto written = ::write(descriptor, mine.data(), mine.size());
      const int error = errno;
      ::close(descriptor);
      if (written != static_cast<ssize_t>(mine.size()))
        return fail_errno(written < 0 ? error : ENOSPC, fmt::format("cannot write {}", file.string()));
      return out;
    }
    if (errno != EEXIST) {
      auto error = fail_errno(errno, fmt::format("cannot create {}", file.string()));
      if (error.value().kind == ErrorKind::kNoInput) error.value().kind = ErrorKind::kCannotCreate;
      return error;
    }
    if (const auto text = read_text_file(lock)) {
      owner = parse_owner(*text);
      if (left_alone(lock, *text, owner)) {
        break_lock(lock, *text);
        continue;
      }
    }
    std::this_thread::sleep_for(kAgain);
  }
  if (!owner) return fail(ErrorKind::kTryAgain, "{} is being written by another program", file.string());
  return fail(ErrorKind::kTryAgain, "{} is being written by process {} on {}", file.string(), owner->pid, owner->host);
}

FileLock::FileLock(FileLock&& other) noexcept : lock_(std::exchange(other.lock_, fs::path())) {}

FileLock::~FileLock() {
  if (!lock_.empty()) ::unlink(lock_.c_str());
}

}  // namespace dubsar
