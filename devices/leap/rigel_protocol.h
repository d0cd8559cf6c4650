#pragma once
// Wire protocol of the Leap cameras "Rigel" (USB 2936:1202) and Stereo IR 170 (2936:1203, taken to be alike):
// video class cameras whose own settings are controls of an extension unit. Sources: the extension unit's
// header and the camera class of the maker's public library librealuvc. Not public, and therefore read from
// the device's descriptors: the picture sizes, rates and the endpoint.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "devices/uvc/uvc_descriptors.h"
#include "devices/uvc/uvc_protocol.h"

namespace dubsar::rigel {

inline constexpr std::uint16_t kVendorId = 0x2936;
inline constexpr std::uint16_t kRigel = 0x1202, kSir170 = 0x1203;

/// {9ada33bc-8b9b-4b7f-a9d1-f3bc8c639029} as it stands in a descriptor; the unit's number is 224 on the
/// devices that were looked at, which have a second extension unit 4.
inline constexpr uvc::Guid kExtensionGuid{0xbc, 0x33, 0xda, 0x9a, 0x9b, 0x8b, 0x7f, 0x4b,
                                          0xa9, 0xd1, 0xf3, 0xbc, 0x8c, 0x63, 0x90, 0x29};
inline constexpr std::uint8_t kUsualExtensionUnit = 224;

/// Controls of the extension unit that are used; sizes in bytes.
enum class Selector : std::uint8_t {
  kStrobeInterval = 3,  ///< 1: dark frames
  kLedCharge = 6,       ///< 4: 0 or 1
  kHardwareClock = 15,  ///< 4, us
  kEmbeddedLine = 17,   ///< 18: where the last line of a picture carries numbers
  kFrameInterval = 18,  ///< 4; its unit is doubtful (the header says 0.1 us, its examples fit 1 us): not used
  kCalibration = 25,    ///< 156, as the LMC1's
  kStrobeControl = 27,  ///< 1: LED pulses on or off
  kExposure = 30,       ///< 2, us
};
inline constexpr std::uint8_t kGainSelector = 4;  ///< of the processing unit, 2 bytes

/// Where the requests go.
struct Units {
  std::uint8_t control_interface = 0;
  std::uint8_t extension = kUsualExtensionUnit;
  std::uint8_t processing = 0;
};
/// kBadData: the camera has no such extension unit.
Result<Units> find_units(const uvc::VideoFunction& camera);

ControlRequest set_extension(const Units& units, Selector selector) noexcept;
ControlRequest get_extension(const Units& units, Selector selector) noexcept;

Result<uvc::ControlWrite> exposure_us(const Units& units, int us);  ///< 10 to 4000
/// Steps 0 to 64; the register's values 1 to 15, which the maker's library never uses, are left out.
Result<uvc::ControlWrite> gain(const Units& units, int step);
/// Every n-th frame dark: 0 none, 1 all, 2, or 4 to 128 (the device cannot do 3).
Result<uvc::ControlWrite> dark_frame_interval(const Units& units, int n);
/// Both are needed.
std::array<uvc::ControlWrite, 2> leds(const Units& units, bool on) noexcept;

/// Every line holds the left eye's row, then the right eye's. `frame` is 2 * width * height.
void split_rows(std::span<const std::byte> frame, int width, std::span<std::uint8_t> left,
                std::span<std::uint8_t> right);

/// Offsets in the last line of a picture, in bytes; nothing where the device has no such number.
struct EmbeddedLine {
  std::optional<std::uint16_t> frame_label, exposure, gain, frame_count;
  bool operator==(const EmbeddedLine&) const = default;
};
inline constexpr std::size_t kEmbeddedLineBytes = 18;
/// Nothing: the device writes no numbers into its pictures, or in a way that is not known.
std::optional<EmbeddedLine> decode_embedded_line(std::span<const std::byte> bytes) noexcept;
std::array<std::byte, kEmbeddedLineBytes> encode(const EmbeddedLine& line) noexcept;

/// What the last line says; 32-bit numbers.
struct Metadata {
  std::uint32_t frame_label = 0, exposure_us = 0, gain = 0, frame_count = 0;
  bool operator==(const Metadata&) const = default;
};
/// Numbers that lie outside the line are 0.
Metadata decode_metadata(const EmbeddedLine& where, std::span<const std::byte> line) noexcept;
void encode_metadata(const Metadata& metadata, const EmbeddedLine& where, std::span<std::byte> line) noexcept;

}  // namespace dubsar::rigel
