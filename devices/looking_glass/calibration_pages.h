#pragma once
// The calibration that older Looking Glass displays (8.9", 15.6", 8K) keep behind their HID interface: JSON text in
// pages of 64 bytes. Facts: lonetech/LookingGlass, newhouseb/linuxholoplayjs, surf-visualization/looking-glass.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::uint16_t kLookingGlassVendor = 0x04d8, kLookingGlassProduct = 0xef7e;
/// The numbers are those of a maker of chips; only devices of this name are displays (lonetech/LookingGlass).
inline constexpr std::string_view kLookingGlassProductName = "HoloPlay";
inline constexpr std::size_t kLookingGlassPageBytes = 64;
inline constexpr std::size_t kLookingGlassReportBytes = 68;
inline constexpr std::size_t kLookingGlassMaxJsonBytes = 16384;  ///< real ones have about 700

struct LookingGlassPage {
  std::uint8_t buttons = 0;
  std::uint16_t number = 0;
  std::array<std::byte, kLookingGlassPageBytes> data{};
  bool operator==(const LookingGlassPage&) const = default;
};

/// Feature report that asks for a page: report 0, command 0 (read), page number big-endian, zeros.
std::array<std::byte, kLookingGlassReportBytes> looking_glass_request(std::uint16_t page) noexcept;
/// Input report of 68 bytes: buttons, command, page number, data. Another length or command: nothing.
std::optional<LookingGlassPage> parse_looking_glass(std::span<const std::byte> report) noexcept;
std::array<std::byte, kLookingGlassReportBytes> format_looking_glass(const LookingGlassPage& page) noexcept;

/// Reads the whole JSON text; it is not parsed here. Reports may come in one piece of 68 bytes or in two of 64 and 4,
/// with stale pages and button presses between. kBadData: blank memory or an impossible length; kUnavailable: the
/// device is lost, or has not answered within `time_limit` of the clock in all. Blocks.
Result<std::string> read_looking_glass_calibration(Transport& transport, const Clock& clock,
                                                   TimestampNs time_limit = 2'000'000'000);

}  // namespace dubsar
