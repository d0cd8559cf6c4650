#include "core/base/numbers/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/text/lower_text.h"

namespace dubsar {
namespace {
std::string lower_trimmed(std::string_view text) {
  std::string out = lower_text(text);
  std::erase_if(out, [](unsigned char c) { return std::isspace(c) != 0; });
  return out;
}

/// The number in front of a unit, as of "1e-6 m", "10^-6 m" and "0.5*um"; 1 where there is none.
double take_factor(std::string_view& unit) {
  double value = 1.0;
  const auto number = [&](double& out) {
    const auto [end, error] = std::from_chars(unit.data(), unit.data() + unit.size(), out);
    if (error != std::errc() || !std::isfinite(out)) return false;
    unit.remove_prefix(static_cast<std::size_t>(end - unit.data()));
    return true;
  };
  if (unit.empty() || (!std::isdigit(static_cast<unsigned char>(unit.front())) && unit.front() != '.')) return 1.0;
  const std::string_view before = unit;
  if (!number(value)) return 1.0;
  for (const std::string_view power : {"^", "**"})
    if (double exponent = 0.0; unit.starts_with(power)) {
      unit.remove_prefix(power.size());
      if (number(exponent)) value = std::pow(value, exponent);
    }
  if (unit.starts_with('*')) unit.remove_prefix(1);
  if (value > 0.0 && std::isfinite(value)) return value;
  unit = before;
  return 1.0;
}
}  // namespace

std::optional<double> mm_per_unit(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 46> kUnits{{
      {"m", 1e3},
      {"meter", 1e3},
      {"meters", 1e3},
      {"metre", 1e3},
      {"metres", 1e3},
      {"cm", 10.0},
      {"centimeter", 10.0},
      {"centimeters", 10.0},
      {"centimetre", 10.0},
      {"centimetres", 10.0},
      {"mm", 1.0},
      {"millimeter", 1.0},
      {"millimeters", 1.0},
      {"millimetre", 1.0},
      {"millimetres", 1.0},
      {"um", 1e-3},
      {"\xc2\xb5m", 1e-3},
      {"\xce\xbcm", 1e-3},
      {"\xb5m", 1e-3},
      {"micron", 1e-3},
      {"microns", 1e-3},
      {"micrometer", 1e-3},
      {"micrometers", 1e-3},
      {"micrometre", 1e-3},
      {"micrometres", 1e-3},
      {"\\u00b5m", 1e-3},
      {"nm", 1e-6},
      {"nanometer", 1e-6},
      {"nanometers", 1e-6},
      {"nanometre", 1e-6},
      {"nanometres", 1e-6},
      {"in", 25.4},
      {"inch", 25.4},
      {"inches", 25.4},
      {"dm", 100.0},
      {"km", 1e6},
      {"pm", 1e-9},
      {"angstrom", 1e-7},
      {"angstroms", 1e-7},
      {"\xc3\x85", 1e-7},
      {"\xc3\xa5", 1e-7},
      {"\xe2\x84\xab", 1e-7},
      {"\xc3\x85ngstr\xc3\xb6m", 1e-7},
      {"\xc3\xa5ngstr\xc3\xb6m", 1e-7},
      {"\xc3\x82\xb5m", 1e-3},
      {"mikrometer", 1e-3},
  }};
  const std::string all = lower_trimmed(unit);
  std::string_view key = all;
  const double factor = take_factor(key);
  for (const auto& [name, mm] : kUnits)
    if (key == name) return factor * mm;
  return std::nullopt;
}

Result<double> parse_length_mm(std::string_view text) {
  const std::string compact = lower_trimmed(text);
  double value = 0.0;
  const char* const last = compact.data() + compact.size();
  const auto [end, error] = std::from_chars(compact.data(), last, value);
  const auto unit = mm_per_unit(std::string_view(end, static_cast<std::size_t>(last - end)));
  if (error != std::errc() || !unit || !std::isfinite(value))
    return fail(ErrorKind::kUsage,
                "length \"{}\" not understood, expected a number with a unit such as 38um or 0.038mm", text);
  return value * *unit;
}

Result<std::uint64_t> parse_bytes(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, int>, 15> kShifts{{
      {"", 0},
      {"b", 0},
      {"k", 10},
      {"kb", 10},
      {"kib", 10},
      {"m", 20},
      {"mb", 20},
      {"mib", 20},
      {"g", 30},
      {"gb", 30},
      {"gib", 30},
      {"t", 40},
      {"tb", 40},
      {"tib", 40},
      {"bytes", 0},
  }};
  constexpr double kMost = 0x1p60;
  const std::string compact = lower_trimmed(text);
  double value = 0.0;
  const char* const last = compact.data() + compact.size();
  const auto [end, error] = std::from_chars(compact.data(), last, value);
  const std::string_view unit(end, static_cast<std::size_t>(last - end));
  const auto* const shift =
      std::find_if(kShifts.begin(), kShifts.end(), [&](const auto& known) { return known.first == unit; });
  if (error == std::errc() && shift != kShifts.end()) value = std::ldexp(value, shift->second);
  if (error != std::errc() || shift == kShifts.end() || !(value >= 1.0 && value <= kMost))
    return fail(ErrorKind::kUsage, "size \"{}\" not understood, expected a number with a unit such as 6G or 512M",
                text);
  return static_cast<std::uint64_t>(value);
}

std::string memory_text(double bytes) {
  return gib_of(bytes) < 1.0 ? fmt::format("{:.0f} MiB", mib_of(bytes)) : fmt::format("{:.1f} GiB", gib_of(bytes));
}

}  // namespace dubsar
