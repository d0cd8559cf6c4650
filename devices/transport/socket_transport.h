#pragma once
// Trackers that speak through sockets: datagrams, and byte streams over TCP or a UNIX socket.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

struct UdpOptions {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6 address in numbers
  std::uint16_t port = 4242;          ///< 0: any free one
  bool allow_remote = false;          ///< addresses other than the loopback ones are refused without it
  /// Which datagrams are taken at all; others are dropped before they can lock the sender. Empty: all.
  std::function<bool(std::span<const std::byte>)> accept;
  double max_rate_hz = 1000.0;  ///< datagrams beyond it are dropped (burst of 50)
  /// The first sender of a taken datagram is the only one heard, until it has been silent for so long.
  TimestampNs lock_ns = 2'000'000'000;
};

struct UdpCounts {
  std::uint64_t taken = 0, refused = 0, foreign = 0, too_fast = 0;
};

/// Listens for datagrams; write() answers the locked sender.
class UdpTransport : public Transport {
 public:
  virtual std::uint16_t port() const noexcept = 0;
  virtual UdpCounts counts() const noexcept = 0;
};

/// kUsage: not an address in numbers, or one that other machines reach without `allow_remote`.
Result<void> check_listen_address(const std::string& address, bool allow_remote);
/// kUsage: neither an address in numbers nor letters of a host's name. Asks no name server.
Result<void> check_host(const std::string& text);

/// kUsage: not a numeric address, or a remote one without allow_remote; kUnavailable: the port is taken.
Result<std::unique_ptr<UdpTransport>> open_udp(const UdpOptions& options, const Clock& clock);

/// Connects to a UNIX stream socket. kUnavailable: nobody listens; kPermission.
Result<std::unique_ptr<Transport>> open_unix_stream(const std::string& path);

/// How our end of a connection is closed when it is closed first. kAtOnce: by a reset (SO_LINGER 0), which leaves no
/// TIME_WAIT on the server's port; servers that do not set SO_REUSEADDR could not listen there again for a minute.
enum class TcpClosing { kOrderly, kAtOnce };

/// Connects by TCP to a host by name or address, waiting at most `timeout` for each of its addresses, and as long as
/// the name server takes. kUsage, kUnavailable.
Result<std::unique_ptr<Transport>> open_tcp_stream(const std::string& host, std::uint16_t port, milliseconds timeout,
                                                   TcpClosing closing = TcpClosing::kOrderly);

}  // namespace dubsar
