#pragma once
// VRPN's server side without I/O: one tracker with one sensor for one client, for simulated servers.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "devices/head_tracker/vrpn_protocol.h"

namespace dubsar {

/// The port in a client's call "HOST PORT" with its closing zero byte, which asks for a connection to it. HOST is not
/// looked at: who called is called back. Nothing when the datagram is no such call.
std::optional<std::uint16_t> parse_vrpn_call(std::span<const std::byte> datagram) noexcept;

class VrpnServerSide {
 public:
  explicit VrpnServerSide(std::string tracker) : tracker_(std::move(tracker)) {}

  /// Takes what the client wrote, cut anywhere, and gives what is answered: cookie and names once its cookie is there,
  /// and a pong for each ping of this tracker. kBadData: not a client of version 07, or a damaged stream.
  Result<std::vector<std::byte>> accept(std::span<const std::byte> bytes);
  /// The message of a pose measured at `time`; empty before the client has greeted.
  std::vector<std::byte> pose(TimestampNs time, const Pose& pose) const;

 private:
  std::string tracker_;
  VrpnStream stream_;
  bool answered_ = false;
  std::map<std::int32_t, std::string> senders_, types_;  ///< the client's numbers
};

}  // namespace dubsar
