#include "devices/spacemouse/spacemouse_protocol.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace dubsar {
namespace {

constexpr std::byte kTranslationId{1}, kRotationId{2}, kButtonsId{3}, kBatteryId{0x17};
// spacenavd src/dev.c: Plus XT, Classic, NuLOOQ.
constexpr std::array<UsbId, 3> kYUpSpaceMice{{{0x046d, 0xc603}, {0x046d, 0xc606}, {0x046d, 0xc640}}};

int axis_at(std::span<const std::byte> report, std::size_t at) noexcept {
  return static_cast<std::int16_t>(std::to_integer<unsigned>(report[at]) | std::to_integer<unsigned>(report[at + 1])
                                                                               << 8);
}

std::optional<glm::ivec3> axes_at(std::span<const std::byte> report, std::size_t at) noexcept {
  const glm::ivec3 axes(axis_at(report, at), axis_at(report, at + 2), axis_at(report, at + 4));
  for (int i = 0; i < 3; ++i)
    if (std::abs(axes[i]) > kSpaceMouseLimit) return std::nullopt;
  return axes;
}

void append_axes(std::vector<std::byte>& out, const glm::ivec3& axes) {
  for (int i = 0; i < 3; ++i) {
    const auto bits = static_cast<std::uint16_t>(std::clamp(axes[i], -32768, 32767));
    out.push_back(static_cast<std::byte>(bits & 0xFFU));
    out.push_back(static_cast<std::byte>(bits >> 8));
  }
}

/// Device axes to screen axes, as a share of the full deflection.
glm::dvec3 screen_from_device(const glm::ivec3& raw, SpaceMouseAxes axes) {
  const auto share = [](int v) { return std::clamp(static_cast<double>(v) / kSpaceMouseFullScale, -1.0, 1.0); };
  if (axes == SpaceMouseAxes::kYUp) return {share(raw.x), share(raw.y), share(-raw.z)};
  return {share(raw.x), share(-raw.z), share(raw.y)};
}

}  // namespace

std::optional<SpaceMouseReport> parse_spacemouse(std::span<const std::byte> report) noexcept {
  if (report.size() < 2) return std::nullopt;
  SpaceMouseReport parsed;
  if (report[0] == kTranslationId && (report.size() == 7 || report.size() == 13)) {
    parsed.translation = axes_at(report, 1);
    if (!parsed.translation) return std::nullopt;
    if (report.size() == 13 && !(parsed.rotation = axes_at(report, 7))) return std::nullopt;
    return parsed;
  }
  if (report[0] == kRotationId && report.size() == 7) {
    parsed.rotation = axes_at(report, 1);
    if (!parsed.rotation) return std::nullopt;
    return parsed;
  }
  if (report[0] == kButtonsId && report.size() <= 9) {
    std::uint64_t bits = 0;
    for (std::size_t i = 1; i < report.size(); ++i) bits |= std::to_integer<std::uint64_t>(report[i]) << (8 * (i - 1));
    parsed.buttons = bits;
    return parsed;
  }
  if (report[0] == kBatteryId && report.size() <= 3 && std::to_integer<int>(report[1]) <= 100) {
    parsed.battery_percent = std::to_integer<int>(report[1]);
    return parsed;
  }
  return std::nullopt;
}

std::vector<std::vector<std::byte>> format_spacemouse(const SpaceMouseReport& report, bool combined) {
  std::vector<std::vector<std::byte>> reports;
  if (report.translation) {
    auto& bytes = reports.emplace_back(1, kTranslationId);
    append_axes(bytes, *report.translation);
    if (combined) append_axes(bytes, report.rotation.value_or(glm::ivec3(0)));
  }
  if (report.rotation && !(combined && report.translation)) {
    auto& bytes = reports.emplace_back(1, kRotationId);
    append_axes(bytes, *report.rotation);
  }
  if (report.buttons) {
    auto& bytes = reports.emplace_back(1, kButtonsId);
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::byte>((*report.buttons >> shift) & 0xFFU));
  }
  if (report.battery_percent)
    reports.push_back({kBatteryId, static_cast<std::byte>(*report.battery_percent), std::byte{0}});
  return reports;
}

std::vector<std::byte> spacemouse_led_report(bool on) { return {std::byte{4}, on ? std::byte{1} : std::byte{0}}; }

SpaceMouseAxes spacemouse_axes(UsbId id) noexcept {
  const bool y_up = std::find(kYUpSpaceMice.begin(), kYUpSpaceMice.end(), id) != kYUpSpaceMice.end();
  return y_up ? SpaceMouseAxes::kYUp : SpaceMouseAxes::kZDown;
}

Result<void> SpaceMouseProtocol::start(Transport& transport, TimestampNs now) {
  sample_ = {};
  sample_.time = now;
  axes_ = spacemouse_axes(transport.usb_id());
  // a model without a ring light refuses the report, which is no reason not to use it
  if (auto lit = transport.write(spacemouse_led_report(true)); !lit && lit.error().kind == ErrorKind::kUnavailable)
    return lit;
  return {};
}

bool SpaceMouseProtocol::accept(std::span<const std::byte> report, TimestampNs now) {
  const auto parsed = parse_spacemouse(report);
  if (!parsed) return false;
  if (parsed->translation) sample_.translation = screen_from_device(*parsed->translation, axes_);
  if (parsed->rotation) sample_.rotation = screen_from_device(*parsed->rotation, axes_);
  if (parsed->buttons) sample_.buttons = *parsed->buttons;
  if (parsed->battery_percent) battery_percent_ = parsed->battery_percent;
  sample_.time = now;
  changed_ = true;
  return true;
}

std::optional<SpaceMouseSample> SpaceMouseProtocol::newest() {
  if (!std::exchange(changed_, false)) return std::nullopt;
  return sample_;
}

}  // namespace dubsar
