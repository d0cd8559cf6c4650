#pragma once
// EDIDs as monitors would send them, for tests.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace dubsar::test {

struct MadeEdid {
  std::string_view manufacturer = "ACR";
  int product = 0, width_px = 3840, height_px = 2160, width_mm = 345, height_mm = 194;
  std::string_view name = "Monitor", serial = "S1";
};

/// A base block of E-EDID 1.4 with one detailed timing, a name and a serial, and the right checksum.
inline std::string made_edid(const MadeEdid& of) {
  std::array<std::uint8_t, 128> b{0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0};
  int maker = 0;
  for (const char c : of.manufacturer) maker = maker << 5 | (c - 'A' + 1);
  const auto put = [&](std::size_t at, int value) { b[at] = static_cast<std::uint8_t>(value); };
  put(8, maker >> 8);
  put(9, maker & 255);
  put(10, of.product & 255);
  put(11, of.product >> 8);
  put(12, 42);
  put(17, 33);
  put(18, 1);
  put(19, 4);
  put(21, of.width_mm / 10);
  put(22, of.height_mm / 10);
  constexpr std::size_t kTiming = 54;
  put(kTiming, 1);
  put(kTiming + 1, 1);
  put(kTiming + 2, of.width_px & 255);
  put(kTiming + 4, of.width_px >> 8 << 4);
  put(kTiming + 5, of.height_px & 255);
  put(kTiming + 7, of.height_px >> 8 << 4);
  put(kTiming + 12, of.width_mm & 255);
  put(kTiming + 13, of.height_mm & 255);
  put(kTiming + 14, of.width_mm >> 8 << 4 | of.height_mm >> 8);
  const auto text = [&](std::size_t at, int kind, std::string_view words) {
    put(at + 3, kind);
    for (std::size_t i = 0; i < 13; ++i) put(at + 5 + i, i < words.size() ? words[i] : i == words.size() ? '\n' : ' ');
  };
  text(72, 0xFC, of.name);
  text(90, 0xFF, of.serial);
  unsigned sum = 0;
  for (const std::uint8_t value : b) sum += value;
  put(127, static_cast<int>((256 - sum % 256) % 256));
  return {b.begin(), b.end()};
}

}  // namespace dubsar::test
