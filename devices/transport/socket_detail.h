#pragma once
// What both sides of sockets share. For socket_transport.cpp and socket_server.cpp only.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include "devices/transport/transport.h"

namespace dubsar::socket_detail {

class Socket {
 public:
  explicit Socket(int descriptor) noexcept : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

struct Address {
  sockaddr_storage storage{};
  socklen_t length = sizeof(sockaddr_storage);
  sockaddr* get() noexcept { return reinterpret_cast<sockaddr*>(&storage); }
  const sockaddr* get() const noexcept { return reinterpret_cast<const sockaddr*>(&storage); }
  /// Same family, address and port.
  bool operator==(const Address& other) const noexcept {
    if (storage.ss_family != other.storage.ss_family) return false;
    if (storage.ss_family == AF_INET) {
      const auto& a = reinterpret_cast<const sockaddr_in&>(storage);
      const auto& b = reinterpret_cast<const sockaddr_in&>(other.storage);
      return a.sin_port == b.sin_port && a.sin_addr.s_addr == b.sin_addr.s_addr;
    }
    const auto& a = reinterpret_cast<const sockaddr_in6&>(storage);
    const auto& b = reinterpret_cast<const sockaddr_in6&>(other.storage);
    return a.sin6_port == b.sin6_port && std::memcmp(&a.sin6_addr, &b.sin6_addr, sizeof a.sin6_addr) == 0;
  }
};

inline Result<Address> parse_address(const std::string& text, std::uint16_t port) {
  Address address;
  auto& four = reinterpret_cast<sockaddr_in&>(address.storage);
  auto& six = reinterpret_cast<sockaddr_in6&>(address.storage);
  if (::inet_pton(AF_INET, text.c_str(), &four.sin_addr) == 1) {
    four.sin_family = AF_INET;
    four.sin_port = htons(port);
    address.length = sizeof(sockaddr_in);
  } else if (::inet_pton(AF_INET6, text.c_str(), &six.sin6_addr) == 1) {
    six.sin6_family = AF_INET6;
    six.sin6_port = htons(port);
    address.length = sizeof(sockaddr_in6);
  } else {
    return fail(ErrorKind::kUsage, "socket: \"{}\" found, expected an address in numbers such as 127.0.0.1 or ::1",
                text);
  }
  return address;
}

inline Result<Address> unix_address(const std::string& path) {
  Address address;
  auto& named = reinterpret_cast<sockaddr_un&>(address.storage);
  if (path.empty() || path.size() >= sizeof named.sun_path)
    return fail(ErrorKind::kUsage, "socket: path of {} bytes, expected 1 to {}", path.size(),
                sizeof named.sun_path - 1);
  named.sun_family = AF_UNIX;
  path.copy(named.sun_path, path.size());
  address.length = sizeof named;
  return address;
}

/// The port that the system chose for one bound to port 0.
inline Result<std::uint16_t> bound_port(const Socket& socket) {
  Address bound;
  if (::getsockname(socket.get(), bound.get(), &bound.length) != 0) return fail_errno(errno, "socket: getsockname");
  return ntohs(reinterpret_cast<const sockaddr_in&>(bound.storage).sin_port);  // at one place for both families
}
static_assert(offsetof(sockaddr_in, sin_port) == offsetof(sockaddr_in6, sin6_port));

/// Small messages leave at once; refused for UNIX sockets, which need none.
inline void send_at_once(const Socket& socket) {
  const int on = 1;
  ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

inline bool is_loopback(const Address& address) {
  if (address.storage.ss_family == AF_INET)
    return ntohl(reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr) >> 24 == 127;
  return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr) != 0;
}

/// Waits until the socket can be read (or written); false when the time is over.
inline bool wait_for(const Socket& socket, short events, std::int64_t timeout_ms) {
  pollfd waiting{socket.get(), events, 0};
  return ::poll(&waiting, 1, static_cast<int>(std::clamp<std::int64_t>(timeout_ms, 0, 3'600'000))) > 0;
}

/// Connects without blocking for longer than `timeout`.
inline Result<void> connect_within(const Socket& socket, const Address& address, milliseconds timeout,
                                   const std::string& name) {
  if (::connect(socket.get(), address.get(), address.length) == 0) return {};
  int error = errno;
  if (error == EINPROGRESS) {
    error = ETIMEDOUT;
    if (wait_for(socket, POLLOUT, timeout.count())) {
      socklen_t size = sizeof error;
      if (::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
    }
  }
  if (error == 0) return {};
  if (error == EACCES || error == EPERM) return fail_errno(error, "cannot connect to " + name);
  return fail(ErrorKind::kUnavailable, "{}: cannot connect: {}", name, std::strerror(error));
}

class StreamTransport final : public Transport {
 public:
  StreamTransport(Socket socket, std::string name) : socket_(std::move(socket)), name_(std::move(name)) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    if (lost_) return gone();
    if (timeout.count() > 0) wait_for(socket_, POLLIN, timeout.count());
    const ::ssize_t length = ::recv(socket_.get(), report.data(), report.size(), MSG_DONTWAIT);
    if (length > 0) return static_cast<std::size_t>(length);
    if (length < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
    lost_ = !report.empty();
    if (lost_) return gone();
    return std::size_t{0};
  }

  Result<void> write(std::span<const std::byte> report) override {
    while (!lost_ && !report.empty()) {
      const ::ssize_t sent = ::send(socket_.get(), report.data(), report.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent >= 0)
        report = report.subspan(static_cast<std::size_t>(sent));
      else if (errno == EAGAIN)
        lost_ = !wait_for(socket_, POLLOUT, kWriteTimeoutMs);
      else if (errno != EINTR)
        lost_ = true;
    }
    if (lost_) return gone();
    return {};
  }

 private:
  static constexpr std::int64_t kWriteTimeoutMs = 1000;
  tl::unexpected<Error> gone() const {
    return fail(ErrorKind::kUnavailable, "{}: the other side has closed the connection", name_);
  }
  Socket socket_;
  std::string name_;
  bool lost_ = false;
};

}  // namespace dubsar::socket_detail
