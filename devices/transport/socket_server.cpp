#include "devices/transport/socket_server.h"

#include <array>

#include "devices/transport/socket_detail.h"
#include "devices/transport/socket_transport.h"

namespace dubsar {
namespace {
using namespace socket_detail;

class Listener final : public StreamServer {
 public:
  Listener(Socket socket, std::string name, std::uint16_t port, std::string unlink_path)
      : socket_(std::move(socket)), name_(std::move(name)), port_(port), unlink_path_(std::move(unlink_path)) {}
  ~Listener() override {
    if (!unlink_path_.empty()) ::unlink(unlink_path_.c_str());
  }
  std::unique_ptr<Transport> accept(milliseconds timeout) override {
    if (!wait_for(socket_, POLLIN, timeout.count())) return nullptr;
    Socket client(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (client.get() < 0) return nullptr;
    send_at_once(client);
    return std::make_unique<StreamTransport>(std::move(client), name_);
  }
  std::uint16_t port() const noexcept override { return port_; }

 private:
  Socket socket_;
  std::string name_;
  std::uint16_t port_;
  std::string unlink_path_;
};

/// Listens on TCP and UDP of one port.
class CalledListener final : public StreamServer {
 public:
  using CalledPort = std::function<std::optional<std::uint16_t>(std::span<const std::byte>)>;
  CalledListener(std::unique_ptr<StreamServer> tcp, Socket udp, CalledPort called_port)
      : tcp_(std::move(tcp)), udp_(std::move(udp)), called_port_(std::move(called_port)) {}

  std::unique_ptr<Transport> accept(milliseconds timeout) override {
    if (auto client = tcp_->accept(timeout)) return client;
    std::array<std::byte, 512> datagram;
    Address caller;
    const ::ssize_t length =
        ::recvfrom(udp_.get(), datagram.data(), datagram.size(), MSG_DONTWAIT, caller.get(), &caller.length);
    if (length <= 0) return nullptr;
    const auto port = called_port_(std::span(datagram).first(static_cast<std::size_t>(length)));
    if (!port) return nullptr;
    reinterpret_cast<sockaddr_in&>(caller.storage).sin_port = htons(*port);
    Socket client(::socket(caller.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const std::string name = fmt::format("caller at port {}", *port);
    if (client.get() < 0 || !connect_within(client, caller, kCallTimeout, name)) return nullptr;
    send_at_once(client);
    return std::make_unique<StreamTransport>(std::move(client), name);
  }
  std::uint16_t port() const noexcept override { return tcp_->port(); }

 private:
  static constexpr milliseconds kCallTimeout{200};
  std::unique_ptr<StreamServer> tcp_;
  Socket udp_;
  CalledPort called_port_;
};

class UdpSender final : public Transport {
 public:
  UdpSender(Socket socket, std::string name) : socket_(std::move(socket)), name_(std::move(name)) {}
  Result<std::size_t> read(std::span<std::byte>, milliseconds) override { return std::size_t{0}; }
  Result<void> write(std::span<const std::byte> datagram) override {
    if (::send(socket_.get(), datagram.data(), datagram.size(), MSG_NOSIGNAL) >= 0) return {};
    if (errno == ECONNREFUSED || errno == EAGAIN || errno == EINTR) return {};  // nobody listens yet
    return fail_errno(errno, "udp: cannot send to " + name_);
  }

 private:
  Socket socket_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<StreamServer>> listen_unix(const std::string& path) {
  DUBSAR_ASSIGN(const Address address, unix_address(path));
  Socket socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "socket: cannot make a socket");
  if (::bind(socket.get(), address.get(), address.length) != 0)
    return fail(ErrorKind::kCannotCreate, "socket: cannot listen at {}: {}", path, std::strerror(errno));
  if (::listen(socket.get(), 4) != 0) return fail_errno(errno, "socket: cannot listen at " + path);
  return std::make_unique<Listener>(std::move(socket), path, std::uint16_t{0}, path);
}

Result<std::unique_ptr<StreamServer>> listen_tcp(const std::string& text, std::uint16_t port, bool allow_remote) {
  DUBSAR_TRY(check_listen_address(text, allow_remote));
  DUBSAR_ASSIGN(const Address address, parse_address(text, port));
  Socket socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "socket: cannot make a socket");
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(socket.get(), address.get(), address.length) != 0 || ::listen(socket.get(), 4) != 0)
    return fail(ErrorKind::kUnavailable, "socket: cannot listen on {} port {}: {}", text, port, std::strerror(errno));
  DUBSAR_ASSIGN(const std::uint16_t chosen, bound_port(socket));
  return std::make_unique<Listener>(std::move(socket), fmt::format("{} port {}", text, chosen), chosen, std::string());
}

Result<std::unique_ptr<StreamServer>> listen_tcp_and_calls(
    const std::string& text, std::uint16_t port, bool allow_remote,
    std::function<std::optional<std::uint16_t>(std::span<const std::byte>)> called_port) {
  DUBSAR_ASSIGN(auto tcp, listen_tcp(text, port, allow_remote));
  DUBSAR_ASSIGN(const Address address, parse_address(text, tcp->port()));
  Socket udp(::socket(address.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (udp.get() < 0) return fail_errno(errno, "socket: cannot make a socket");
  if (::bind(udp.get(), address.get(), address.length) != 0)
    return fail(ErrorKind::kUnavailable, "socket: cannot listen for datagrams on {} port {}: {}", text, tcp->port(),
                std::strerror(errno));
  return std::make_unique<CalledListener>(std::move(tcp), std::move(udp), std::move(called_port));
}

Result<std::unique_ptr<Transport>> open_udp_sender(const std::string& text, std::uint16_t port) {
  DUBSAR_ASSIGN(const Address address, parse_address(text, port));
  Socket socket(::socket(address.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return fail_errno(errno, "udp: cannot make a socket");
  if (::connect(socket.get(), address.get(), address.length) != 0)
    return fail(ErrorKind::kUnavailable, "udp: cannot send to {} port {}: {}", text, port, std::strerror(errno));
  return std::make_unique<UdpSender>(std::move(socket), fmt::format("{} port {}", text, port));
}

}  // namespace dubsar
