#include "devices/leap/lmc1_protocol.h"

#include <algorithm>
#include <cstring>

namespace dubsar::lmc1 {
namespace {

ControlWrite write_u16(std::uint8_t unit, std::uint8_t selector, int value) noexcept {
  return uvc::control_write(set_current(unit, selector), static_cast<std::uint32_t>(value), 2);
}

ControlWrite write_processing(Selector selector, int value) noexcept {
  return write_u16(kProcessingUnit, static_cast<std::uint8_t>(selector), value);
}

Result<void> check_range(const char* what, int value, int low, int high) {
  if (value < low || value > high)
    return fail(ErrorKind::kUsage, "leap: {} of {}, expected {} to {}", what, value, low, high);
  return {};
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
  return uvc::set_current(kControlInterface, unit, selector);
}
ControlRequest get_current(std::uint8_t unit, std::uint8_t selector) noexcept {
  return uvc::get_current(kControlInterface, unit, selector);
}

Result<ControlWrite> exposure_us(int us) {
  DUBSAR_TRY(check_range("exposure in us", us, 10, 65535));
  return write_u16(kCameraTerminal, kZoomAbsolute, us);
}

Result<ControlWrite> analog_gain(int sixteenths) {
  DUBSAR_TRY(check_range("analog gain in sixteenths", sixteenths, 16, 63));
  return write_processing(Selector::kGain, sixteenths);
}

ControlWrite gamma(bool square_root) noexcept { return write_processing(Selector::kGamma, square_root ? 1 : 0); }

ControlWrite switch_on(Switch which, bool on) noexcept {
  return write_processing(Selector::kContrast, static_cast<int>(which) | (on ? 1 : 0) << 6);
}

Result<ControlWrite> dark_frame_interval(int n) {
  DUBSAR_TRY(check_range("dark frame interval", n, 0, 0x3fff));
  return write_processing(Selector::kWhiteBalance, n);
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
