#include "devices/leap/lmc1_protocol.h"

#include <algorithm>
#include <cstring>

namespace dubsar::lmc1 {
namespace {

constexpr std::uint8_t kClassToInterface = 0x21;
constexpr std::uint8_t kClassFromInterface = 0xa1;

ControlRequest unit_request(std::uint8_t type, std::uint8_t request, std::uint8_t unit, std::uint8_t interface,
                            std::uint8_t selector) noexcept {
  return {type, request, static_cast<std::uint16_t>(selector << 8), static_cast<std::uint16_t>(unit << 8 | interface)};
}

ControlWrite write_u16(std::uint8_t unit, std::uint8_t selector, int value) noexcept {
  return {set_current(unit, selector), {std::byte(value & 0xff), std::byte(value >> 8 & 0xff)}};
}

ControlWrite write_processing(Selector selector, int value) noexcept {
  return write_u16(kProcessingUnit, static_cast<std::uint8_t>(selector), value);
}

Result<void> check_range(const char* what, int value, int low, int high) {
  if (value < low || value > high)
    return fail(ErrorKind::kUsage, "leap: {} of {}, expected {} to {}", what, value, low, high);
  return {};
}

template <class T>
void put(std::span<std::byte> bytes, std::size_t at, T value) noexcept {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
T get(std::span<const std::byte> bytes, std::size_t at) noexcept {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

const Mode* find_mode(int width, int height) noexcept {
  for (const Mode& mode : kModes)
    if (mode.width == width && mode.height == height) return &mode;
  return nullptr;
}

const Mode* find_mode(std::uint8_t frame_index) noexcept {
  for (const Mode& mode : kModes)
    if (mode.frame_index == frame_index) return &mode;
  return nullptr;
}

ControlRequest set_current(std::uint8_t unit, std::uint8_t selector) noexcept {
  return unit_request(kClassToInterface, kSetCurrent, unit, kControlInterface, selector);
}
ControlRequest get_current(std::uint8_t unit, std::uint8_t selector) noexcept {
  return unit_request(kClassFromInterface, kGetCurrent, unit, kControlInterface, selector);
}
ControlRequest set_stream(std::uint8_t selector) noexcept {
  return unit_request(kClassToInterface, kSetCurrent, 0, kStreamInterface, selector);
}
ControlRequest get_stream(std::uint8_t selector) noexcept {
  return unit_request(kClassFromInterface, kGetCurrent, 0, kStreamInterface, selector);
}

Result<ControlWrite> exposure_us(int us) {
  DUBSAR_TRY(check_range("exposure in us", us, 10, 65535));
  return write_u16(kCameraTerminal, kZoomAbsolute, us);
}

Result<ControlWrite> analog_gain(int sixteenths) {
  DUBSAR_TRY(check_range("analog gain in sixteenths", sixteenths, 16, 63));
  return write_processing(Selector::kGain, sixteenths);
}

Result<ControlWrite> digital_gain(int quarters) {
  DUBSAR_TRY(check_range("digital gain in quarters", quarters, 0, 16));
  return write_processing(Selector::kBrightness, quarters);
}

ControlWrite gamma(bool square_root) noexcept { return write_processing(Selector::kGamma, square_root ? 1 : 0); }

ControlWrite switch_on(Switch which, bool on) noexcept {
  return write_processing(Selector::kContrast, static_cast<int>(which) | (on ? 1 : 0) << 6);
}

Result<ControlWrite> dark_frame_interval(int n) {
  DUBSAR_TRY(check_range("dark frame interval", n, 0, 0x3fff));
  return write_processing(Selector::kWhiteBalance, n);
}

std::array<std::byte, kStreamBlockBytes> encode(const StreamBlock& block) noexcept {
  std::array<std::byte, kStreamBlockBytes> bytes{};
  put(bytes, 0, block.hint);
  put(bytes, 2, block.format_index);
  put(bytes, 3, block.frame_index);
  put(bytes, 4, block.interval_100ns);
  put(bytes, 8, block.key_frame_rate);
  put(bytes, 10, block.p_frame_rate);
  put(bytes, 12, block.compression_quality);
  put(bytes, 14, block.compression_window);
  put(bytes, 16, block.delay_ms);
  put(bytes, 18, block.max_frame_bytes);
  put(bytes, 22, block.max_transfer_bytes);
  return bytes;
}

Result<StreamBlock> decode_stream_block(std::span<const std::byte> bytes) {
  if (bytes.size() != kStreamBlockBytes)
    return fail(ErrorKind::kBadData, "leap: video probe block of {} bytes, expected {}", bytes.size(), kStreamBlockBytes);
  StreamBlock block;
  block.hint = get<std::uint16_t>(bytes, 0);
  block.format_index = get<std::uint8_t>(bytes, 2);
  block.frame_index = get<std::uint8_t>(bytes, 3);
  block.interval_100ns = get<std::uint32_t>(bytes, 4);
  block.key_frame_rate = get<std::uint16_t>(bytes, 8);
  block.p_frame_rate = get<std::uint16_t>(bytes, 10);
  block.compression_quality = get<std::uint16_t>(bytes, 12);
  block.compression_window = get<std::uint16_t>(bytes, 14);
  block.delay_ms = get<std::uint16_t>(bytes, 16);
  block.max_frame_bytes = get<std::uint32_t>(bytes, 18);
  block.max_transfer_bytes = get<std::uint32_t>(bytes, 22);
  return block;
}

StreamBlock request_mode(const Mode& mode) noexcept {
  StreamBlock block;
  block.hint = 1;  // keep the frame interval, adjust the rest
  block.frame_index = mode.frame_index;
  block.interval_100ns = mode.interval_100ns;
  block.max_frame_bytes = static_cast<std::uint32_t>(mode.frame_bytes());
  block.max_transfer_bytes = kMaxTransferBytes;
  return block;
}

void deinterleave(std::span<const std::byte> frame, std::span<std::uint8_t> left, std::span<std::uint8_t> right) {
  DUBSAR_CHECK(frame.size() == 2 * left.size() && left.size() == right.size());
  const std::byte* from = frame.data();
  for (std::size_t i = 0; i < left.size(); ++i) {
    left[i] = static_cast<std::uint8_t>(from[2 * i]);
    right[i] = static_cast<std::uint8_t>(from[2 * i + 1]);
  }
}

FrameMetadata decode_metadata(std::span<const std::byte, kMetadataBytes> tail) noexcept {
  const auto at = [&](std::size_t i) { return static_cast<int>(tail[i]); };
  FrameMetadata metadata;
  metadata.exposure_us = (at(6) & 15) << 5 | (at(8) & 31);
  metadata.gain = at(10) & 31;
  metadata.label = std::max(at(6) >> 4 & 1, (at(2) & 15) << 4 | (at(4) & 15)) & 127;
  return metadata;
}

void encode_metadata(const FrameMetadata& metadata, std::span<std::byte, kMetadataBytes> tail) noexcept {
  const auto set = [&](std::size_t i, int mask, int value) {
    tail[i] = std::byte((static_cast<int>(tail[i]) & ~mask) | (value & mask));
  };
  set(2, 15, metadata.label >> 4);
  set(4, 15, metadata.label);
  set(6, 31, metadata.exposure_us >> 5 & 15);
  set(8, 31, metadata.exposure_us);
  set(10, 31, metadata.gain);
}

}  // namespace dubsar::lmc1
