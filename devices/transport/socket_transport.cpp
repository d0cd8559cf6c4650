#include "devices/transport/socket_transport.h"

#include <netdb.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "devices/transport/socket_detail.h"

namespace dubsar {
namespace {
using namespace socket_detail;

class UdpListener final : public UdpTransport {
 public:
  UdpListener(Socket socket, const UdpOptions& options, std::uint16_t bound_port, const Clock& clock)
      : socket_(std::move(socket)), options_(options), port_(bound_port), clock_(&clock), refilled_(clock.now()) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    if (timeout.count() > 0) wait_for(socket_, POLLIN, timeout.count());
    for (int looked = 0; looked < kMaxDatagramsPerRead; ++looked) {
      Address sender;
      const ::ssize_t length =
          ::recvfrom(socket_.get(), report.data(), report.size(), MSG_TRUNC, sender.get(), &sender.length);
      if (length < 0) {
        if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return std::size_t{0};
        return fail(ErrorKind::kUnavailable, "udp: port {}: {}", port_, std::strerror(errno));
      }
      const TimestampNs now = clock_->now();
      const bool whole = static_cast<std::size_t>(length) <= report.size();
      if (!whole || length == 0 ||
          (options_.accept && !options_.accept(report.first(static_cast<std::size_t>(length))))) {
        ++counts_.refused;
        refused_bytes_ = static_cast<std::size_t>(length);
        continue;
      }
      if (peer_ && now - heard_ < options_.lock_ns && *peer_ != sender) {
        ++counts_.foreign;
        continue;
      }
      if (!take_token(now)) {
        ++counts_.too_fast;
        continue;
      }
      peer_ = sender;
      heard_ = now;
      ++counts_.taken;
      return static_cast<std::size_t>(length);
    }
    return std::size_t{0};
  }

  Result<void> write(std::span<const std::byte> report) override {
    if (!peer_) return fail(ErrorKind::kIo, "udp: port {}: nobody to answer yet", port_);
    if (::sendto(socket_.get(), report.data(), report.size(), MSG_NOSIGNAL, peer_->get(), peer_->length) < 0)
      return fail_errno(errno, fmt::format("udp: port {}: cannot answer", port_));
    return {};
  }

  std::uint16_t port() const noexcept override { return port_; }
  UdpCounts counts() const noexcept override { return counts_; }
  DroppedInput dropped() const noexcept override { return {counts_.refused, refused_bytes_}; }

 private:
  std::size_t refused_bytes_ = 0;                   ///< of the last datagram that was refused
  static constexpr int kMaxDatagramsPerRead = 256;  ///< a flood of rubbish cannot hold the reader
  static constexpr double kBurst = 50.0;

  bool take_token(TimestampNs now) {
    tokens_ = std::min(kBurst, tokens_ + static_cast<double>(now - refilled_) * 1e-9 * options_.max_rate_hz);
    refilled_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

  Socket socket_;
  UdpOptions options_;
  std::uint16_t port_;
  const Clock* clock_;
  std::optional<Address> peer_;
  TimestampNs heard_ = 0;
  TimestampNs refilled_;
  double tokens_ = kBurst;
  UdpCounts counts_;
};

/// All addresses of a host, in the order in which they should be tried. Blocks while a name server is asked.
Result<std::vector<Address>> resolve(const std::string& host, std::uint16_t port) {
  if (const auto numeric = parse_address(host, port)) return std::vector{*numeric};
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) return fail(ErrorKind::kUnavailable, "{}: no address found: {}", host, ::gai_strerror(error));
  std::vector<Address> addresses;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    if ((one->ai_family != AF_INET && one->ai_family != AF_INET6) || one->ai_addrlen > sizeof(sockaddr_storage))
      continue;
    Address address;
    std::memcpy(&address.storage, one->ai_addr, one->ai_addrlen);
    address.length = one->ai_addrlen;
    addresses.push_back(address);
  }
  ::freeaddrinfo(found);
  if (addresses.empty()) return fail(ErrorKind::kUnavailable, "{}: no internet address found", host);
  return addresses;
}

Result<std::unique_ptr<Transport>> connect_tcp(const Address& address, const std::string& name, milliseconds timeout,
                                               TcpClosing closing) {
  Socket socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "socket: cannot make a socket");
  send_at_once(socket);
  const linger at_once{1, 0};
  if (closing == TcpClosing::kAtOnce) ::setsockopt(socket.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  DUBSAR_TRY(connect_within(socket, address, timeout, name));
  return std::make_unique<StreamTransport>(std::move(socket), name);
}

}  // namespace

Result<void> check_host(const std::string& text) {
  if (parse_address(text, 0)) return {};
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           c == '_';
  };
  if (text.empty() || text.size() > 253 || !std::all_of(text.begin(), text.end(), allowed))
    return fail(ErrorKind::kUsage, "socket: \"{}\" found, expected the name of a host, or an address such as 127.0.0.1",
                text);
  return {};
}

Result<void> check_listen_address(const std::string& text, bool allow_remote) {
  DUBSAR_ASSIGN(const Address address, parse_address(text, 0));
  if (!allow_remote && !is_loopback(address))
    return fail(ErrorKind::kUsage, "udp: {} can be reached from other machines; say so explicitly to allow it", text);
  return {};
}

Result<std::unique_ptr<UdpTransport>> open_udp(const UdpOptions& options, const Clock& clock) {
  DUBSAR_TRY(check_listen_address(options.address, options.allow_remote));
  DUBSAR_ASSIGN(Address address, parse_address(options.address, options.port));
  Socket socket(::socket(address.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "udp: cannot make a socket");
  if (::bind(socket.get(), address.get(), address.length) != 0)
    return fail(ErrorKind::kUnavailable, "udp: cannot listen on {} port {}: {}; another program may use it",
                options.address, options.port, std::strerror(errno));
  DUBSAR_ASSIGN(const std::uint16_t port, bound_port(socket));
  return std::make_unique<UdpListener>(std::move(socket), options, port, clock);
}

Result<std::unique_ptr<Transport>> open_unix_stream(const std::string& path) {
  DUBSAR_ASSIGN(const Address address, unix_address(path));
  Socket socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "socket: cannot make a socket");
  DUBSAR_TRY(connect_within(socket, address, milliseconds(0), path));
  return std::make_unique<StreamTransport>(std::move(socket), path);
}

Result<std::unique_ptr<Transport>> open_tcp_stream(const std::string& host, std::uint16_t port, milliseconds timeout,
                                                   TcpClosing closing) {
  DUBSAR_TRY(check_host(host));
  DUBSAR_ASSIGN(const std::vector<Address> addresses, resolve(host, port));
  const std::string name = fmt::format("{} port {}", host, port);
  Result<std::unique_ptr<Transport>> opened = fail(ErrorKind::kUnavailable, "{}: no address to connect to", name);
  for (const Address& address : addresses)
    if ((opened = connect_tcp(address, name, timeout, closing))) break;
  return opened;
}

}  // namespace dubsar
