#include "devices/touch/evdev_event.h"

#include <string>

#include "core/base/numbers/bytes.h"

namespace dubsar {
namespace {

constexpr std::int64_t kLatestS = 4'000'000'000, kUsPerS = 1'000'000, kNsPerUs = 1000;
constexpr std::size_t kAxisHead = 1 + 4 * 3;

ByteReader reader_of(std::span<const std::byte> bytes) {
  return ByteReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = as_bytes(text);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::optional<std::vector<EvdevEvent>> parse_evdev(std::span<const std::byte> bytes) {
  if (bytes.empty() || bytes.size() % kEvdevEventBytes != 0) return std::nullopt;
  std::vector<EvdevEvent> out(bytes.size() / kEvdevEventBytes);
  ByteReader reader = reader_of(bytes);
  for (EvdevEvent& event : out) {
    const auto seconds = reader.little<std::int64_t>(), us = reader.little<std::int64_t>();
    if (seconds < 0 || seconds > kLatestS || us < 0 || us >= kUsPerS) return std::nullopt;
    event.time = (seconds * kUsPerS + us) * kNsPerUs;
    event.type = reader.little<std::uint16_t>();
    event.code = reader.little<std::uint16_t>();
    event.value = reader.little<std::int32_t>();
  }
  return out;
}

std::vector<std::byte> format_evdev(std::span<const EvdevEvent> events) {
  std::string out;
  for (const EvdevEvent& event : events) {
    const std::int64_t us = event.time / kNsPerUs;
    append_little(out, us / kUsPerS);
    append_little(out, us % kUsPerS);
    append_little(out, event.type);
    append_little(out, event.code);
    append_little(out, event.value);
  }
  return bytes_of(out);
}

std::optional<EvdevAxis> parse_evdev_axis(std::uint8_t code, std::span<const std::byte> report) {
  if (report.size() < kAxisHead || report.size() > kMostAxisBytes || (report.size() - kAxisHead) % 4 != 0)
    return std::nullopt;
  ByteReader reader = reader_of(report);
  if (reader.little<std::uint8_t>() != code) return std::nullopt;
  EvdevAxis out;
  out.value = reader.little<std::int32_t>();
  out.minimum = reader.little<std::int32_t>();
  out.maximum = reader.little<std::int32_t>();
  while (reader.left() > 0) out.slots.push_back(reader.little<std::int32_t>());
  return out;
}

std::vector<std::byte> format_evdev_axis(std::uint8_t code, const EvdevAxis& axis) {
  std::string out;
  append_little(out, code);
  for (const std::int32_t number : {axis.value, axis.minimum, axis.maximum}) append_little(out, number);
  for (const std::int32_t number : axis.slots) append_little(out, number);
  return bytes_of(out);
}

}  // namespace dubsar
