#pragma once
// A service manager for tests: its side of sd_notify(3).

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace dubsar::app::test {

/// One thread. The kernel keeps ten datagrams that nobody has read: ask often.
class ServiceManager {
 public:
  ServiceManager() {
    static int made = 0;
    const std::string name = "dubsar_notify_" + std::to_string(::getpid()) + "_" + std::to_string(++made);
    path_ = std::filesystem::temp_directory_path() / name;
    descriptor_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::strncpy(at.sun_path, path_.c_str(), sizeof at.sun_path - 1);
    ::unlink(path_.c_str());
    bound_ = ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
  }
  ~ServiceManager() {
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  bool bound() const { return bound_; }
  /// All so far.
  const std::vector<std::string>& heard() {
    char text[512];
    for (ssize_t n; (n = ::recv(descriptor_, text, sizeof text, 0)) >= 0;) heard_.emplace_back(text, text + n);
    return heard_;
  }
  /// The same at `now_s`. From READY=1 on a watchdog runs as systemd's does: whoever is silent for longer than
  /// `watchdog_s` would be killed and started again.
  void watch(double now_s, double watchdog_s) {
    const std::size_t before = heard_.size();
    for (std::size_t i = before; i < heard().size(); ++i)
      if (heard_[i] == "READY=1" || (heard_[i] == "WATCHDOG=1" && sign_s_ >= 0.0)) sign_s_ = now_s;
    if (sign_s_ < 0.0) return;
    longest_s_ = std::max(longest_s_, now_s - sign_s_);
    if (now_s - sign_s_ <= watchdog_s) return;
    ++restarts_;
    sign_s_ = now_s;
  }
  int restarts() const { return restarts_; }  ///< that a missing watchdog would have led to
  double longest_silence_s() const { return longest_s_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<std::string> heard_;
  int descriptor_ = -1, restarts_ = 0;
  double sign_s_ = -1.0, longest_s_ = 0.0;
  bool bound_ = false;
};

}  // namespace dubsar::app::test
