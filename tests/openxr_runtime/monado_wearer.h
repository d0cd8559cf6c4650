#pragma once
// Who wears the headset of Monado's "remote" driver: both controllers and their fingers, told over its socket on this
// machine (Monado 25, src/xrt/drivers/remote/r_interface.h: packets "mndrmt3", host's byte order).

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <thread>
#include <type_traits>

#include "tests/openxr_runtime/made_headset.h"

namespace dubsar::testing {

/// Frame: the driver's stage, metres, its floor at 0; LOCAL lies kMonadoEyes_m above it (target_builder_remote.c).
inline constexpr double kMonadoEyes_m = 1.6;

struct MonadoPose {
  float x = 0, y = 0, z = 0, w = 1;
  float at[3]{};
};
struct MonadoController {
  MonadoPose pose;
  float linear_velocity[3]{}, angular_velocity[3]{};
  float curl[5]{};  ///< little to thumb, 0 open to 1 closed
  float trigger = 0, squeeze = 0, squeeze_force = 0, thumbstick[2]{}, trackpad_force = 0, trackpad[2]{};
  std::uint8_t hand_tracking_active = 0, active = 0;
  std::uint8_t buttons[11]{}, padding[3]{};
};
struct MonadoEye {
  float fov[4]{};
  MonadoPose pose;
  std::uint32_t padding = 0;
};
struct MonadoPacket {
  char header[8]{};
  MonadoEye eyes[2];
  MonadoPose head;
  std::uint8_t per_view_data = 0, padding[3]{};
  MonadoController left, right;
};
static_assert(sizeof(MonadoController) == 120 && sizeof(MonadoPacket) == 376);
static_assert(std::is_trivially_copyable_v<MonadoPacket>);

/// Tells the driver the newest packet a hundred times a second, from when it listens until this goes.
class MonadoWearer {
 public:
  explicit MonadoWearer(std::uint16_t port) : port_(port), thread_([this] { run(); }) {}
  ~MonadoWearer() {
    over_ = true;
    thread_.join();
  }
  /// `change(MonadoPacket&)`: what is told from now on.
  template <class F>
  void tell(F change) {
    const std::lock_guard lock(mutex_);
    if (met_) change(packet_);
  }
  bool met() const noexcept { return met_; }            ///< the driver answered, with packets of this version
  bool stranger() const noexcept { return stranger_; }  ///< it did, with others

 private:
  static bool whole(int fd, char* to, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t got = ::recv(fd, to + done, size - done, 0);
      if (got <= 0) return false;
      done += static_cast<std::size_t>(got);
    }
    return true;
  }
  void run() {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port_);
    int fd = -1;
    while (!over_) {
      fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0) break;
      ::close(fd);
      fd = -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (fd >= 0) talk(fd);
    if (fd >= 0) ::close(fd);
  }
  void talk(int fd) {
    MonadoPacket first, latest;  // as after a reset, and as it is
    if (!whole(fd, reinterpret_cast<char*>(&first), sizeof(first)) || std::memcmp(first.header, "mndrmt3", 8) != 0 ||
        !whole(fd, reinterpret_cast<char*>(&latest), sizeof(latest))) {
      stranger_ = true;
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      packet_ = first;
      met_ = true;
    }
    while (!over_) {
      MonadoPacket now;
      {
        const std::lock_guard lock(mutex_);
        now = packet_;
      }
      if (::send(fd, &now, sizeof(now), MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof(now))) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  const std::uint16_t port_;
  std::atomic<bool> over_{false}, met_{false}, stranger_{false};
  std::mutex mutex_;
  MonadoPacket packet_;
  std::thread thread_;  // last: it uses the others
};

/// A pose of LOCAL as the driver is told it.
inline MonadoPose monado_pose(const MadePose& local) {
  const glm::dquat& q = local.rotation;
  return {static_cast<float>(q.x),
          static_cast<float>(q.y),
          static_cast<float>(q.z),
          static_cast<float>(q.w),
          {static_cast<float>(local.position.x), static_cast<float>(local.position.y + kMonadoEyes_m),
           static_cast<float>(local.position.z)}};
}

}  // namespace dubsar::testing
