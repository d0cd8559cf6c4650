#pragma once
// The daemon's side of spacenavd's socket without I/O: one client and one made-up SpaceMouse, for simulated daemons.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "devices/spacemouse/spacenav_protocol.h"

namespace dubsar {

class SpacenavServerSide {
 public:
  /// Takes what the client wrote, cut anywhere, and gives what the daemon answers: the version; the SpaceMouse's name,
  /// path, axes, buttons, numbers and type; settings as they were set, or their defaults.
  std::vector<std::byte> accept(std::span<const std::byte> bytes);
  /// The bytes of an event, empty when the client has masked its kind.
  std::vector<std::byte> tell(const SpacenavEvent& event) const;

  int version() const noexcept { return version_; }

 private:
  using Words = std::array<std::int32_t, 8>;
  void answer(const Words& request, std::vector<std::byte>& out);
  bool settings(std::int32_t number, Words& words);

  int version_ = 0;
  std::vector<std::byte> pending_;
  std::int32_t mask_ = 7;                       ///< motion, buttons, devices
  std::int32_t sensitivity_bits_ = 0x3f800000;  ///< a float
  std::map<std::int32_t, Words> set_;           ///< by the number of the request and, where it has one, the index
};

}  // namespace dubsar
