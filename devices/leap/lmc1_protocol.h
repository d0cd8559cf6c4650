#pragma once
// Wire protocol of the Leap Motion Controller (LMC1, USB f182:0003): bytes and structs, no input or output. The device
// is a USB Video Class 1.00 camera that sends both infrared pictures as one fake YUY2 stream over a bulk endpoint and
// hides its own settings behind the controls of ordinary cameras. Sources: a public `lsusb -v` dump, the LeapUVC manual
// and its Python sample. Where the manual and a real device might differ, the comment says "not checked".

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "devices/transport/transport.h"
#include "devices/uvc/uvc_protocol.h"

namespace dubsar::lmc1 {

inline constexpr std::uint16_t kVendorId = 0xf182;
inline constexpr std::uint16_t kProductId = 0x0003;
inline constexpr std::uint8_t kControlInterface = 0;
inline constexpr std::uint8_t kStreamInterface = 1;
inline constexpr std::uint8_t kBulkEndpoint = 0x83;
inline constexpr std::size_t kMaxTransferBytes = 16384;  ///< of one bulk transfer, payload header included

// --- video modes ---

struct Mode {
  std::uint8_t frame_index;  ///< bFrameIndex, from 1
  int width, height;         ///< of one eye
  std::uint32_t interval_100ns;
  std::size_t frame_bytes() const noexcept {
    return 2U * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

inline constexpr std::array<Mode, 6> kModes{{{1, 640, 480, 173913},
                                             {2, 640, 240, 86956},
                                             {3, 640, 120, 46728},
                                             {4, 752, 480, 200000},
                                             {5, 752, 240, 100000},
                                             {6, 752, 120, 52631}}};
inline constexpr std::uint8_t kDefaultFrameIndex = 4;

/// nullptr where the device has no such mode.
const Mode* find_mode(int width, int height) noexcept;
const Mode* find_mode(std::uint8_t frame_index) noexcept;

// --- UVC requests ---

using uvc::kGetCurrent;
using uvc::kSetCurrent;
inline constexpr std::uint8_t kCameraTerminal = 2;
inline constexpr std::uint8_t kProcessingUnit = 5;

enum class Selector : std::uint8_t {
  kBrightness = 0x02,    ///< digital gain
  kContrast = 0x03,      ///< switches: HDR, rotation, LEDs
  kGain = 0x04,          ///< analog gain
  kSaturation = 0x07,    ///< read: the byte chosen by sharpness
  kSharpness = 0x08,     ///< address of a calibration byte
  kGamma = 0x09,         ///< 0 or 1, about a square root
  kWhiteBalance = 0x0a,  ///< dark frame interval
};
inline constexpr std::uint8_t kZoomAbsolute = 0x0b;  ///< of the camera terminal: exposure in us
using uvc::kCommitControl;
using uvc::kProbeControl;

/// Requests to unit `unit` of the control interface: wValue = selector << 8, wIndex = unit << 8 | interface.
ControlRequest set_current(std::uint8_t unit, std::uint8_t selector) noexcept;
ControlRequest get_current(std::uint8_t unit, std::uint8_t selector) noexcept;

using uvc::ControlWrite;  ///< all settings have 2 bytes

enum class Switch : std::uint8_t { kHdr = 0, kRotate180 = 1, kLedLeft = 2, kLedCentre = 3, kLedRight = 4 };

Result<ControlWrite> exposure_us(int us);          ///< 10..65535
Result<ControlWrite> analog_gain(int sixteenths);  ///< 16..63: gain 1 to 3.94
ControlWrite gamma(bool square_root) noexcept;
ControlWrite switch_on(Switch which,
                       bool on) noexcept;  ///< switches 5 and 6 of the device crash it and do not exist here
/// 0: no dark frames, 1: only dark ones, n: every n-th. Up to 0x3fff.
Result<ControlWrite> dark_frame_interval(int n);

using uvc::decode_stream_block;
using uvc::encode;
using uvc::kStreamBlockBytes;
using uvc::StreamBlock;

/// The block that asks for `mode`.
StreamBlock request_mode(const Mode& mode) noexcept;

// --- pixels ---

/// Splits a frame of 2-byte pixels: even bytes are the left eye, odd ones the right. All three the right size.
void deinterleave(std::span<const std::byte> frame, std::span<std::uint8_t> left, std::span<std::uint8_t> right);

/// What the device writes over the last 12 bytes of a frame.
struct FrameMetadata {
  int exposure_us = 0;  ///< modulo 512
  int gain = 0;         ///< modulo 32
  int label = 0;        ///< 0..127; what it counts is not documented
  bool operator==(const FrameMetadata&) const = default;
};
inline constexpr std::size_t kMetadataBytes = 12;
FrameMetadata decode_metadata(std::span<const std::byte, kMetadataBytes> tail) noexcept;
/// For simulators: sets only the bits that carry metadata.
void encode_metadata(const FrameMetadata& metadata, std::span<std::byte, kMetadataBytes> tail) noexcept;

}  // namespace dubsar::lmc1
