// USB descriptors of the LMC1, composed from a public `lsusb -v` listing: video control 0x50 bytes, video streaming
// 0xdd bytes, in all 0x163. Five of them the listing does not show: they are taken as the class-specific interrupt
// endpoint that UVC 1.0 demands.

#include <algorithm>
#include <array>
#include <initializer_list>

#include "devices/leap/lmc1_simulator.h"

namespace dubsar {
namespace {

constexpr std::array<std::uint8_t, 18> kDevice{18,   1,    0x00, 0x02, 0xef, 2, 1, 64, 0x82,
                                               0xf1, 0x03, 0,    0x00, 0x00, 1, 2, 0,  1};

constexpr std::size_t kConfigurationBytes = 0x163;

class Writer {
 public:
  constexpr void bytes(std::initializer_list<unsigned> values) {
    for (const unsigned value : values) out_[at_++] = static_cast<std::uint8_t>(value);
  }
  constexpr void u32(std::uint32_t value) {
    bytes({value & 0xffU, value >> 8 & 0xffU, value >> 16 & 0xffU, value >> 24});
  }
  constexpr void u16(unsigned value) { bytes({value & 0xffU, value >> 8 & 0xffU}); }
  constexpr std::array<std::uint8_t, kConfigurationBytes> finish() const {
    if (at_ != kConfigurationBytes) throw "the descriptors do not add up";
    return out_;
  }

 private:
  std::array<std::uint8_t, kConfigurationBytes> out_{};
  std::size_t at_ = 0;
};

constexpr auto kConfiguration = [] {
  constexpr std::array<std::uint32_t, 6> kBitRates{282624000, 282624000, 262963200, 288768000, 288768000, 274329600};
  Writer w;
  w.bytes({9, 2, 0x63, 0x01, 2, 1, 0, 0x80, 250});
  w.bytes({8, 11, 0, 2, 14, 3, 0, 0});                                            // interface association
  w.bytes({9, 4, 0, 0, 1, 14, 1, 0, 0});                                          // video control
  w.bytes({13, 36, 1, 0x00, 0x01, 0x50, 0x00, 0xe8, 0x03, 0, 0, 1, 1});           // clock of 1 kHz
  w.bytes({18, 36, 2, 2, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0x28, 0x02, 0});  // camera terminal 2
  w.bytes({12, 36, 5, 5, 2, 0, 0, 3, 0x7b, 0x02, 0, 0});                          // processing unit 5
  w.bytes({28, 36, 6, 6});                                                        // extension unit 6
  for (int i = 0; i < 16; ++i) w.bytes({0xff});
  w.bytes({0, 1, 5, 3, 0, 0, 0, 0});
  w.bytes({9, 36, 3, 3, 0x01, 0x01, 0, 6, 0});  // output terminal 3
  w.bytes({7, 5, 0x82, 3, 64, 0, 8});
  w.bytes({5, 37, 3, 64, 0});
  w.bytes({9, 4, 1, 0, 1, 14, 2, 0, 0});  // video streaming
  w.bytes({14, 36, 1, 1, 0xdd, 0x00, 0x83, 0, 3, 0, 0, 0, 1, 0});
  w.bytes({27, 36, 4,    1, 6,    0x59, 0x55, 0x59, 0x32, 0, 0, 0x10, 0, 0x80,
           0,  0,  0xaa, 0, 0x38, 0x9b, 0x71, 16,   4,    0, 0, 0,    0});
  for (std::size_t i = 0; i < lmc1::kModes.size(); ++i) {
    const lmc1::Mode& mode = lmc1::kModes[i];
    w.bytes({30, 36, 5, mode.frame_index, 0});
    w.u16(static_cast<unsigned>(mode.width));
    w.u16(static_cast<unsigned>(mode.height));
    w.u32(kBitRates[i]);
    w.u32(kBitRates[i]);
    w.u32(static_cast<std::uint32_t>(2 * mode.width * mode.height));
    w.u32(mode.interval_100ns);
    w.bytes({1});
    w.u32(mode.interval_100ns);
  }
  w.bytes({7, 5, 0x83, 2, 0x00, 0x02, 1});
  return w.finish();
}();

}  // namespace

std::span<const std::uint8_t> Lmc1Simulator::device_descriptor() noexcept { return kDevice; }
std::span<const std::uint8_t> Lmc1Simulator::configuration_descriptor() noexcept { return kConfiguration; }

}  // namespace dubsar
