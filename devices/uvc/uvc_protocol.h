#pragma once
// Requests of the USB Video Class 1.0 and its probe and commit block: bytes and structs, no input or output.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "devices/transport/transport.h"

namespace dubsar::uvc {

inline constexpr std::uint8_t kSetCurrent = 0x01;
inline constexpr std::uint8_t kGetCurrent = 0x81;
inline constexpr std::uint8_t kProbeControl = 0x01;
inline constexpr std::uint8_t kCommitControl = 0x02;

/// Requests to a terminal or unit of the control interface (wValue = selector << 8, wIndex = unit << 8 |
/// interface); to the streaming interface with unit 0.
ControlRequest set_current(std::uint8_t interface, std::uint8_t unit, std::uint8_t selector) noexcept;
ControlRequest get_current(std::uint8_t interface, std::uint8_t unit, std::uint8_t selector) noexcept;

/// The standard request for the 18 bytes of the device descriptor.
inline constexpr ControlRequest kGetDevice{0x80, 0x06, 0x0100, 0};
/// The standard request for configuration descriptor 0 with everything behind it.
inline constexpr ControlRequest kGetConfiguration{0x80, 0x06, 0x0200, 0};

/// A setting of at most 4 bytes and where it goes.
struct ControlWrite {
  ControlRequest request{};
  std::array<std::byte, 4> data{};
  std::size_t bytes = 0;
  bool operator==(const ControlWrite&) const = default;
};
/// `value` in 1, 2 or 4 bytes, little-endian.
ControlWrite control_write(const ControlRequest& request, std::uint32_t value, std::size_t bytes) noexcept;

/// The 26-byte video probe and commit block.
struct StreamBlock {
  std::uint16_t hint = 0;
  std::uint8_t format_index = 1;
  std::uint8_t frame_index = 1;
  std::uint32_t interval_100ns = 0;
  std::uint16_t key_frame_rate = 0, p_frame_rate = 0, compression_quality = 0, compression_window = 0, delay_ms = 0;
  std::uint32_t max_frame_bytes = 0;
  std::uint32_t max_transfer_bytes = 0;
  bool operator==(const StreamBlock&) const = default;
};
inline constexpr std::size_t kStreamBlockBytes = 26;
std::array<std::byte, kStreamBlockBytes> encode(const StreamBlock& block) noexcept;
Result<StreamBlock> decode_stream_block(std::span<const std::byte> bytes);

/// Probe, read back, commit. Returns what the device agreed to; kBadData when it is another frame than the
/// one asked for.
Result<StreamBlock> commit_stream(Transport& transport, std::uint8_t stream_interface, const StreamBlock& asked);

Result<void> send(Transport& transport, const ControlWrite& write);

}  // namespace dubsar::uvc
