#pragma once
// Events and axes of the kernel's input devices as bytes and back: struct input_event of 64-bit Linux, and what its
// ioctls say of one axis. Facts: include/uapi/linux/input.h and Documentation/input/event-codes.rst of the kernel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/system/clock.h"

namespace dubsar {

inline constexpr std::size_t kEvdevEventBytes = 24;

/// Types and codes that touch panels need.
inline constexpr std::uint16_t kEvSyn = 0, kEvAbs = 3;
inline constexpr std::uint16_t kSynReport = 0, kSynDropped = 3;
inline constexpr std::uint16_t kMtSlot = 0x2f, kMtX = 0x35, kMtY = 0x36, kMtToolType = 0x37, kMtTrackingId = 0x39;
inline constexpr std::int32_t kToolPalm = 2;

struct EvdevEvent {
  TimestampNs time = 0;  ///< on the device's clock, whole microseconds
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
  bool operator==(const EvdevEvent&) const = default;
};

/// Whole events, one after the other. Nothing: no event, a part of one, or times that the kernel does not make.
std::optional<std::vector<EvdevEvent>> parse_evdev(std::span<const std::byte> bytes);
std::vector<std::byte> format_evdev(std::span<const EvdevEvent> events);

/// One axis as a feature report of a transport: the code of the axis (one byte), then its value, its minimum and its
/// maximum, and of axes of contacts the value in each slot (four bytes each, little-endian).
struct EvdevAxis {
  std::int32_t value = 0, minimum = 0, maximum = 0;
  std::vector<std::int32_t> slots{};
  bool operator==(const EvdevAxis&) const = default;
};
inline constexpr std::size_t kMostSlots = 64;
inline constexpr std::size_t kMostAxisBytes = 1 + 4 * (3 + kMostSlots);

/// Nothing: another axis, a part of one.
std::optional<EvdevAxis> parse_evdev_axis(std::uint8_t code, std::span<const std::byte> report);
std::vector<std::byte> format_evdev_axis(std::uint8_t code, const EvdevAxis& axis);

}  // namespace dubsar
