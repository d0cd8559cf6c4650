#include "devices/leap/rigel_protocol.h"

#include <algorithm>
#include <cstring>

namespace dubsar::rigel {
namespace {

constexpr std::uint8_t kLastLineFormat = 2;  // LEAP_EMBLINE_FORMAT_TYPE_LASTLINE
constexpr std::uint16_t kNotPresent = 0xff;

// Where the offsets of the numbers lie: type, reserved, then cycle label, frame label, exposure, gain, left
// and right shift, frame count, clock, 16 bits each.
struct Field {
  std::size_t offset_at;
  std::optional<std::uint16_t> EmbeddedLine::*offset;
  std::uint32_t Metadata::*value;
};
constexpr std::array<Field, 4> kFields{{{4, &EmbeddedLine::frame_label, &Metadata::frame_label},
                                        {6, &EmbeddedLine::exposure, &Metadata::exposure_us},
                                        {8, &EmbeddedLine::gain, &Metadata::gain},
                                        {14, &EmbeddedLine::frame_count, &Metadata::frame_count}}};

uvc::ControlWrite write(const Units& units, Selector selector, std::uint32_t value, std::size_t bytes) noexcept {
  return uvc::control_write(set_extension(units, selector), value, bytes);
}

}  // namespace

Result<Units> find_units(const uvc::VideoFunction& camera) {
  Units units;
  units.control_interface = camera.control_interface;
  units.processing = camera.processing_unit.value_or(0);
  const auto by = [&](const auto& is) {
    return std::find_if(camera.extension_units.begin(), camera.extension_units.end(), is);
  };
  auto found = by([](const uvc::ExtensionUnit& u) { return u.guid == kExtensionGuid; });
  if (found == camera.extension_units.end())
    found = by([](const uvc::ExtensionUnit& u) { return u.unit == kUsualExtensionUnit; });
  if (found == camera.extension_units.end())
    return fail(ErrorKind::kBadData,
                "rigel: the camera has {} extension units and none of Leap Motion's, expected unit {}",
                camera.extension_units.size(), kUsualExtensionUnit);
  units.extension = found->unit;
  return units;
}

ControlRequest set_extension(const Units& units, Selector selector) noexcept {
  return uvc::set_current(units.control_interface, units.extension, static_cast<std::uint8_t>(selector));
}
ControlRequest get_extension(const Units& units, Selector selector) noexcept {
  return uvc::get_current(units.control_interface, units.extension, static_cast<std::uint8_t>(selector));
}

Result<uvc::ControlWrite> exposure_us(const Units& units, int us) {
  if (us < 10 || us > 4000) return fail(ErrorKind::kUsage, "rigel: exposure of {} us, expected 10 to 4000", us);
  return write(units, Selector::kExposure, static_cast<std::uint32_t>(us), 2);
}

Result<uvc::ControlWrite> gain(const Units& units, int step) {
  if (step < 0 || step > 64) return fail(ErrorKind::kUsage, "rigel: gain step {}, expected 0 to 64", step);
  if (units.processing == 0)
    return fail(ErrorKind::kBadData, "rigel: the camera has no processing unit, which sets the gain");
  const auto value = static_cast<std::uint32_t>(step == 0 ? 0 : step + 15);
  return uvc::control_write(uvc::set_current(units.control_interface, units.processing, kGainSelector), value, 2);
}

Result<uvc::ControlWrite> dark_frame_interval(const Units& units, int n) {
  // The register: 0 none, 1 all, 2 every other one, k >= 3: one dark frame and then k lit ones.
  if (n < 0 || n == 3 || n > 128)
    return fail(ErrorKind::kUsage, "rigel: every {}th frame dark, expected 0, 1, 2 or 4 to 128", n);
  return write(units, Selector::kStrobeInterval, static_cast<std::uint32_t>(n < 3 ? n : n - 1), 1);
}

std::array<uvc::ControlWrite, 2> leds(const Units& units, bool on) noexcept {
  const std::uint32_t value = on ? 1 : 0;
  return {write(units, Selector::kStrobeControl, value, 1), write(units, Selector::kLedCharge, value, 4)};
}

void split_rows(std::span<const std::byte> frame, int width, std::span<std::uint8_t> left,
                std::span<std::uint8_t> right) {
  const auto row = static_cast<std::size_t>(width);
  DUBSAR_CHECK(row > 0 && frame.size() % (2 * row) == 0 && left.size() == frame.size() / 2 &&
               right.size() == left.size());
  for (std::size_t at = 0; at < left.size(); at += row) {
    std::memcpy(left.data() + at, frame.data() + 2 * at, row);
    std::memcpy(right.data() + at, frame.data() + 2 * at + row, row);
  }
}

std::optional<EmbeddedLine> decode_embedded_line(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kEmbeddedLineBytes || bytes[0] != std::byte{kLastLineFormat}) return std::nullopt;
  EmbeddedLine line;
  for (const Field& field : kFields) {
    std::uint16_t offset = 0;
    std::memcpy(&offset, bytes.data() + field.offset_at, sizeof offset);
    if (offset != kNotPresent) line.*field.offset = offset;
  }
  return line;
}

std::array<std::byte, kEmbeddedLineBytes> encode(const EmbeddedLine& line) noexcept {
  std::array<std::byte, kEmbeddedLineBytes> bytes{std::byte{kLastLineFormat}};
  for (std::size_t at = 2; at < bytes.size(); at += 2) std::memcpy(bytes.data() + at, &kNotPresent, sizeof kNotPresent);
  for (const Field& field : kFields)
    if (const auto offset = line.*field.offset) std::memcpy(bytes.data() + field.offset_at, &*offset, sizeof *offset);
  return bytes;
}

Metadata decode_metadata(const EmbeddedLine& where, std::span<const std::byte> line) noexcept {
  Metadata metadata;
  for (const Field& field : kFields)
    if (const auto offset = where.*field.offset; offset && *offset + sizeof(std::uint32_t) <= line.size())
      std::memcpy(&(metadata.*field.value), line.data() + *offset, sizeof(std::uint32_t));
  return metadata;
}

void encode_metadata(const Metadata& metadata, const EmbeddedLine& where, std::span<std::byte> line) noexcept {
  for (const Field& field : kFields)
    if (const auto offset = where.*field.offset; offset && *offset + sizeof(std::uint32_t) <= line.size())
      std::memcpy(line.data() + *offset, &(metadata.*field.value), sizeof(std::uint32_t));
}

}  // namespace dubsar::rigel
