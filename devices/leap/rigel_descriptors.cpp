// USB descriptors of the simulated Rigel. Public are the ids, the two extension units 4 and 224 and the GUID
// of the second; everything else is a plain video class camera of our own making.

#include <array>
#include <initializer_list>

#include "devices/leap/rigel_simulator.h"

namespace dubsar {
namespace {

constexpr std::array<uvc::FrameSize, 3> kSizes{
    {{1, 1, 640, 480, 16, 166666}, {1, 2, 640, 240, 16, 83333}, {1, 3, 384, 384, 16, 111111}}};

constexpr std::size_t kControlBytes = 13 + 18 + 12 + 28 + 28 + 9;
constexpr std::size_t kStreamBytes = 14 + 27 + 30 * kSizes.size();
constexpr std::size_t kAllBytes = 9 + 8 + 9 + kControlBytes + 7 + 5 + 9 + kStreamBytes + 7;

class Writer {
 public:
  constexpr void bytes(std::initializer_list<unsigned> values) {
    for (const unsigned value : values) out_[at_++] = static_cast<std::uint8_t>(value);
  }
  constexpr void u16(unsigned value) { bytes({value & 0xffU, value >> 8 & 0xffU}); }
  constexpr void u32(std::uint32_t value) {
    bytes({value & 0xffU, value >> 8 & 0xffU, value >> 16 & 0xffU, value >> 24});
  }
  constexpr std::array<std::uint8_t, kAllBytes> finish() const {
    if (at_ != kAllBytes) throw "the descriptors do not add up";
    return out_;
  }

 private:
  std::array<std::uint8_t, kAllBytes> out_{};
  std::size_t at_ = 0;
};

constexpr void extension_unit(Writer& w, unsigned unit, const uvc::Guid& guid, unsigned source) {
  w.bytes({28, 36, 6, unit});
  for (const std::uint8_t byte : guid) w.bytes({byte});
  w.bytes({29, 1, source, 3, 0xff, 0xff, 0xff, 0});
}

constexpr auto kConfiguration = [] {
  constexpr uvc::Guid kOther{0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08,
                             0x09, 0x0a, 0x0b, 0x0c, 0x0d, 0x0e, 0x0f, 0x10};
  Writer w;
  w.bytes({9, 2});
  w.u16(kAllBytes);
  w.bytes({2, 1, 0, 0x80, 250});
  w.bytes({8, 11, 0, 2, 14, 3, 0, 0});
  w.bytes({9, 4, 0, 0, 1, 14, 1, 0, 0});  // video control
  w.bytes({13, 36, 1, 0x00, 0x01});
  w.u16(kControlBytes);
  w.u32(48'000'000);
  w.bytes({1, 1});
  w.bytes({18, 36, 2, 1, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0});  // camera terminal 1
  w.bytes({12, 36, 5, 2, 1, 0, 0, 3, 0x00, 0x02, 0, 0});                    // processing unit 2: gain
  extension_unit(w, 4, kOther, 2);
  extension_unit(w, rigel::kUsualExtensionUnit, rigel::kExtensionGuid, 2);
  w.bytes({9, 36, 3, 3, 0x01, 0x01, 0, 2, 0});  // output terminal 3
  w.bytes({7, 5, 0x81, 3, 64, 0, 8});
  w.bytes({5, 37, 3, 64, 0});
  w.bytes({9, 4, 1, 0, 1, 14, 2, 0, 0});  // video streaming
  w.bytes({14, 36, 1, 1});
  w.u16(kStreamBytes);
  w.bytes({0x82, 0, 3, 0, 0, 0, 1, 0});
  w.bytes({27,   36,   4,    1,    static_cast<unsigned>(kSizes.size()),
           0x59, 0x55, 0x59, 0x32, 0,
           0,    0x10, 0,    0x80, 0,
           0,    0xaa, 0,    0x38, 0x9b,
           0x71, 16,   1,    0,    0,
           0,    0});
  for (const uvc::FrameSize& size : kSizes) {
    const auto bits_per_s =
        static_cast<std::uint32_t>(8.0e7 * static_cast<double>(size.frame_bytes()) / size.interval_100ns);
    w.bytes({30, 36, 5, size.frame_index, 0});
    w.u16(static_cast<unsigned>(size.width));
    w.u16(static_cast<unsigned>(size.height));
    w.u32(bits_per_s);
    w.u32(bits_per_s);
    w.u32(static_cast<std::uint32_t>(size.frame_bytes()));
    w.u32(size.interval_100ns);
    w.bytes({1});
    w.u32(size.interval_100ns);
  }
  w.bytes({7, 5, 0x82, 2, 0x00, 0x02, 0});
  return w.finish();
}();

}  // namespace

std::array<std::uint8_t, 18> RigelSimulator::device_descriptor(std::uint16_t product) noexcept {
  return {18,
          1,
          0x00,
          0x02,
          0xef,
          2,
          1,
          64,
          0x36,
          0x29,
          static_cast<std::uint8_t>(product & 0xffU),
          static_cast<std::uint8_t>(product >> 8),
          0x00,
          0x01,
          0,
          0,
          0,
          1};
}
std::span<const std::uint8_t> RigelSimulator::configuration_descriptor() noexcept { return kConfiguration; }
std::span<const uvc::FrameSize> RigelSimulator::sizes() noexcept { return kSizes; }

}  // namespace dubsar
