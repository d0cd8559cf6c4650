#pragma once
// 3Dconnexion SpaceMouse reports: bytes to motion and back. Facts: FreeSpacenav/spacenavd src/dev.c and src/hotplug*,
// JakubAndrysek/PySpaceMouse devices.toml.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/spacemouse/spacemouse_sample.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// What one report says; parts that it does not carry are empty. Raw device units and axes (see SpaceMouseAxes).
struct SpaceMouseReport {
  std::optional<glm::ivec3> translation, rotation;  ///< about -350..350
  std::optional<std::uint64_t> buttons;             ///< bit i: button i is down
  std::optional<int> battery_percent;
  bool operator==(const SpaceMouseReport&) const = default;
};

inline constexpr int kSpaceMouseFullScale = 350;  ///< deflection of the cap at its stop
inline constexpr int kSpaceMouseLimit = 1024;     ///< larger values are not a SpaceMouse's

/// Report 1 (7 bytes: translation; 13: with rotation), 2 (7: rotation), 3 (2..9: button bits), 0x17 (2 or 3: battery).
/// The form follows from the length, never from the product. Anything else: nothing.
std::optional<SpaceMouseReport> parse_spacemouse(std::span<const std::byte> report) noexcept;

/// The bytes that a device sends for it. `combined`: translation and rotation in one report, as wireless models do.
std::vector<std::vector<std::byte>> format_spacemouse(const SpaceMouseReport& report, bool combined);

/// Output report that switches the ring light.
std::vector<std::byte> spacemouse_led_report(bool on);

/// Which way a model counts: x is to the right for all.
enum class SpaceMouseAxes {
  kZDown,  ///< y to the user, z down
  kYUp,    ///< y up, z away from the user: the first models by cable
};
SpaceMouseAxes spacemouse_axes(UsbId id) noexcept;

/// For Driver: puts the parts together and lights the ring.
class SpaceMouseProtocol {
 public:
  using Sample = SpaceMouseSample;
  Result<void> start(Transport& transport, TimestampNs now);
  Result<void> keep_up(Transport&, TimestampNs) { return {}; }
  bool accept(std::span<const std::byte> report, TimestampNs now);
  std::optional<Sample> newest();
  std::optional<int> battery_percent() const noexcept { return battery_percent_; }

 private:
  Sample sample_;
  SpaceMouseAxes axes_ = SpaceMouseAxes::kZDown;
  std::optional<int> battery_percent_;
  bool changed_ = false;
};

}  // namespace dubsar
