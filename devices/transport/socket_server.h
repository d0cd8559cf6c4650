#pragma once
// The other side of socket_transport.h, for simulated trackers: servers of byte streams, and senders of
// datagrams.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "devices/transport/transport.h"

namespace dubsar {

/// Listens; one client at a time is talked to. One thread.
class StreamServer {
 public:
  virtual ~StreamServer() = default;
  /// The next client as a byte stream, waiting at most `timeout`; null when none came. A client that leaves
  /// is kUnavailable on its transport.
  virtual std::unique_ptr<Transport> accept(milliseconds timeout) = 0;
  virtual std::uint16_t port() const noexcept = 0;  ///< of TCP
};

/// A UNIX socket at `path`, removed again at the end. kCannotCreate: something is at that path, or no such
/// folder.
Result<std::unique_ptr<StreamServer>> listen_unix(const std::string& path);

/// TCP on an address in numbers; port 0: any free one. kUsage: an address that other machines reach without
/// `allow_remote`; kUnavailable: the port is taken.
Result<std::unique_ptr<StreamServer>> listen_tcp(const std::string& address, std::uint16_t port, bool allow_remote);

/// The same, and on the same port datagrams that call for a connection: `called_port` finds the port in one, and the
/// caller's own address is connected to there, within 200 ms. Other datagrams are dropped.
Result<std::unique_ptr<StreamServer>> listen_tcp_and_calls(
    const std::string& address, std::uint16_t port, bool allow_remote,
    std::function<std::optional<std::uint16_t>(std::span<const std::byte>)> called_port);

/// Every write() is one datagram to an address in numbers; nobody needs to listen. kUsage.
Result<std::unique_ptr<Transport>> open_udp_sender(const std::string& address, std::uint16_t port);

}  // namespace dubsar
