#pragma once
// A SpaceMouse in memory, byte for byte.

#include <atomic>
#include <memory>

#include "devices/spacemouse/spacemouse_protocol.h"
#include "devices/transport/sim_transport.h"

namespace dubsar {

class SpaceMouseSim {
 public:
  /// `combined`: sends all six axes in one report, as wireless models do.
  explicit SpaceMouseSim(bool combined = false, UsbId id = {0x256f, 0xc635});
  /// Raw device axes, as the cap would send them.
  void move(const glm::ivec3& translation, const glm::ivec3& rotation);
  void press(std::uint64_t buttons);
  bool light_is_on() const noexcept { return *light_; }
  SimDevice& device() noexcept { return device_; }

 private:
  bool combined_;
  std::shared_ptr<std::atomic<bool>> light_ = std::make_shared<std::atomic<bool>>(false);
  SimDevice device_;
};

}  // namespace dubsar
