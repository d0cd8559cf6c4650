#include "core/image_io/srgb_profile.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace dubsar {
namespace {

constexpr std::size_t kHeaderBytes = 128;
constexpr int kCurvePoints = 1024;

/// Big-endian bytes.
class Bytes {
 public:
  Bytes& u32(std::uint32_t value) { return number(value, 4); }
  Bytes& u16(std::uint32_t value) { return number(value, 2); }
  Bytes& text(std::string_view letters) { return text_.append(letters), *this; }
  Bytes& zeros(std::size_t count) { return text_.append(count, '\0'), *this; }
  Bytes& padded() { return zeros((4 - text_.size() % 4) % 4); }
  const std::string& bytes() const { return text_; }

 private:
  Bytes& number(std::uint32_t value, int count) {
    for (int k = count - 1; k >= 0; --k) text_.push_back(static_cast<char>(value >> (8 * k) & 0xff));
    return *this;
  }
  std::string text_;
};

/// Three s15Fixed16 numbers, as integers.
std::string xyz(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return Bytes().text("XYZ ").u32(0).u32(x).u32(y).u32(z).bytes();
}

std::string description(std::string_view words) {
  const auto length = static_cast<std::uint32_t>(words.size() + 1);
  return Bytes().text("desc").u32(0).u32(length).text(words).zeros(1).u32(0).u32(0).u16(0).zeros(68).padded().bytes();
}

std::string copyright(std::string_view words) {
  return Bytes().text("text").u32(0).text(words).zeros(1).padded().bytes();
}

/// IEC 61966-2-1: from coded values to light.
std::string transfer_curve() {
  Bytes curve;
  curve.text("curv").u32(0).u32(kCurvePoints);
  for (int k = 0; k < kCurvePoints; ++k) {
    const double coded = static_cast<double>(k) / (kCurvePoints - 1);
    const double light = coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
    curve.u16(static_cast<std::uint32_t>(std::lround(65535.0 * light)));
  }
  return curve.bytes();
}

std::string make_profile() {
  struct Tag {
    std::string_view name;
    std::size_t data;  ///< which of `data`
  };
  // Primaries and white of IEC 61966-2-1, adapted to D50 by Bradford's matrix: the figures of every sRGB profile.
  const std::array<std::string, 7> data{description("sRGB IEC61966-2.1"),
                                        copyright("No copyright, use freely"),
                                        xyz(0xf6d6, 0x10000, 0xd32d),
                                        xyz(0x6fa2, 0x38f5, 0x0390),
                                        xyz(0x6299, 0xb785, 0x18da),
                                        xyz(0x24a0, 0x0f84, 0xb6cf),
                                        transfer_curve()};
  const std::array<Tag, 9> tags{{{"desc", 0},
                                 {"cprt", 1},
                                 {"wtpt", 2},
                                 {"rXYZ", 3},
                                 {"gXYZ", 4},
                                 {"bXYZ", 5},
                                 {"rTRC", 6},
                                 {"gTRC", 6},
                                 {"bTRC", 6}}};
  std::array<std::size_t, data.size()> at{};
  std::size_t end = kHeaderBytes + 4 + 12 * tags.size();
  for (std::size_t k = 0; k < data.size(); ++k) at[k] = end, end += data[k].size();

  Bytes out;
  out.u32(static_cast<std::uint32_t>(end)).u32(0).u32(0x02400000).text("mntrRGB XYZ ");
  for (const int part : {2024, 1, 1, 0, 0, 0}) out.u16(static_cast<std::uint32_t>(part));
  out.text("acsp").u32(0).u32(0).u32(0).u32(0).u32(0).u32(0).u32(0);
  out.u32(0xf6d6).u32(0x10000).u32(0xd32d);
  out.zeros(kHeaderBytes - out.bytes().size());
  out.u32(static_cast<std::uint32_t>(tags.size()));
  for (const Tag& tag : tags)
    out.text(tag.name)
        .u32(static_cast<std::uint32_t>(at[tag.data]))
        .u32(static_cast<std::uint32_t>(data[tag.data].size()));
  for (const std::string& bytes : data) out.text(bytes);
  return out.bytes();
}

}  // namespace

std::span<const std::byte> srgb_profile() {
  static const std::string profile = make_profile();
  return std::as_bytes(std::span(profile.data(), profile.size()));
}

}  // namespace dubsar
