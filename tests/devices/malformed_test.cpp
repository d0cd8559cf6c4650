// Ten million reports that are not what they seem: none is accepted, none is read beyond its end (run under ASan too).
// A random report may by chance be valid, so each case breaks one thing that makes it invalid for certain.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/head_tracker/xreal_protocol.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/spacemouse/spacenav_protocol.h"

namespace dubsar {
namespace {

/// xorshift64*: one multiplication per number, so that the bytes cost less than the parsing.
class FastRandom {
 public:
  explicit FastRandom(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return state_ * 0x2545F4914F6CDD1DULL;
  }
  std::size_t below(std::size_t limit) { return next() % limit; }
  void fill(std::span<std::byte> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
      const std::uint64_t word = next();
      std::memcpy(bytes.data() + i, &word, std::min<std::size_t>(8, bytes.size() - i));
    }
  }

 private:
  std::uint64_t state_;
};

template <class Parse, class Break>
std::int64_t accepted_of(std::int64_t count, std::uint64_t seed, const Break& make_broken, const Parse& parse) {
  FastRandom random(seed);
  std::array<std::byte, 128> buffer;
  std::int64_t accepted = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::size_t length = make_broken(random, std::span(buffer));
    accepted += parse(std::span<const std::byte>(buffer).first(length)) ? 1 : 0;
  }
  return accepted;
}

/// A random length that is none of the valid ones.
template <std::size_t N>
std::size_t wrong_length(FastRandom& random, const std::array<std::size_t, N>& valid) {
  while (true) {
    const std::size_t length = random.below(97);
    if (std::find(valid.begin(), valid.end(), length) == valid.end()) return length;
  }
}

constexpr std::int64_t kEach = 2'000'000;

TEST(Malformed, TwoMillionSpaceMouseReports) {
  EXPECT_EQ(accepted_of(
                kEach, 1,
                [](FastRandom& random, std::span<std::byte> out) -> std::size_t {
                  random.fill(out.first(16));
                  switch (random.below(3)) {
                    case 0:  // a number that no SpaceMouse has
                      out[0] = std::byte{0x40};
                      return random.below(16);
                    case 1:  // a motion report of a length it cannot have
                      out[0] = static_cast<std::byte>(1 + random.below(2));
                      return wrong_length(random, std::array<std::size_t, 2>{7, 13});
                    default:  // a value far beyond the stops
                      out[0] = std::byte{1};
                      out[2] = static_cast<std::byte>(0x05 + random.below(0xF0));
                      return 7;
                  }
                },
                [](auto report) { return parse_spacemouse(report).has_value(); }),
            0);
}

TEST(Malformed, TwoMillionOpentrackDatagrams) {
  EXPECT_EQ(accepted_of(
                kEach, 2,
                [](FastRandom& random, std::span<std::byte> out) -> std::size_t {
                  random.fill(out.first(48));
                  if (random.below(2) == 0) return random.below(48);
                  // sign and exponent of one number so that it is beyond 200, infinite or none at all
                  const std::size_t field = random.below(6);
                  out[8 * field + 7] = static_cast<std::byte>(random.below(2) * 0x80 + 0x41 + random.below(0x3F));
                  return 48;
                },
                [](auto datagram) { return parse_opentrack(datagram).has_value(); }),
            0);
}

TEST(Malformed, TwoMillionHeadsetReports) {
  const auto parse = [](auto report) { return parse_rift(report).has_value() || parse_xreal(report).has_value(); };
  EXPECT_EQ(accepted_of(
                kEach, 3,
                [](FastRandom& random, std::span<std::byte> out) -> std::size_t {
                  random.fill(out.first(72));
                  switch (random.below(4)) {
                    case 0:
                      return wrong_length(random, std::array<std::size_t, 2>{62, 64});
                    case 1:
                      out[0] = std::byte{0x33};
                      return random.below(2) == 0 ? 62 : 64;
                    case 2:  // no readings
                      out[0] = std::byte{11};
                      out[3] = std::byte{0};
                      return 64;
                    default:  // the same of the first model, in both its lengths
                      out[0] = std::byte{1};
                      out[1] = std::byte{0};
                      return random.below(2) == 0 ? 62 : 64;
                  }
                },
                parse),
            0);
}

TEST(Malformed, TwoMillionReportsOfGlassesWithoutADivisor) {
  EXPECT_EQ(accepted_of(
                kEach, 6,
                [](FastRandom& random, std::span<std::byte> out) -> std::size_t {
                  random.fill(out.first(64));
                  out[0] = std::byte{1};
                  out[1] = std::byte{2};
                  std::fill_n(out.begin() + (random.below(2) == 0 ? 14 : 29), 4, std::byte{0});
                  return 64;
                },
                [](auto report) { return parse_xreal(report).has_value(); }),
            0);
}

TEST(Malformed, TwoMillionSpacenavEventsAndCalibrationPages) {
  EXPECT_EQ(accepted_of(
                kEach, 4,
                [](FastRandom& random, std::span<std::byte> out) -> std::size_t {
                  random.fill(out.first(72));
                  if (random.below(2) == 0) return wrong_length(random, std::array<std::size_t, 2>{32, 68});
                  out[1] = std::byte{0x7f};  // an unknown kind of event, an unknown command
                  out[3] = std::byte{0x11};  // and no answer to a request
                  return random.below(2) == 0 ? 32 : 68;
                },
                [](auto r) { return parse_spacenav(r).has_value() || parse_looking_glass(r).has_value(); }),
            0);
}

/// Takes what a protocol writes and gives nothing.
class Sink final : public Transport {
 public:
  Result<std::size_t> read(std::span<std::byte>, milliseconds) override { return std::size_t{0}; }
  Result<void> write(std::span<const std::byte>) override { return {}; }
};

TEST(Malformed, TwoMillionPiecesOfVrpn) {
  // a right start, so that poses would be understood, then pose messages of a wrong size or with impossible numbers
  std::vector<std::byte> start;
  const auto add = [&](std::span<const std::byte> bytes) { start.insert(start.end(), bytes.begin(), bytes.end()); };
  add(vrpn_cookie());
  add(format_vrpn(vrpn_name_message(-2, 7, "vrpn_Tracker Pos_Quat")));
  FastRandom random(5);
  Sink sink;
  VrpnProtocol protocol;
  std::int64_t poses = 0;
  std::array<std::byte, 96> message;
  for (std::int64_t piece = 0; piece < kEach; ++piece) {
    if (piece % 64 == 0) {  // as a new connection
      ASSERT_TRUE(protocol.start(sink, 0));
      ASSERT_TRUE(protocol.accept(start, 0));
    }
    random.fill(message);
    std::size_t length = 96;
    if (random.below(4) != 0) {
      const std::size_t payload = random.below(3) == 0 ? 64 : random.below(64);
      std::fill_n(message.begin(), 24, std::byte{0});
      message[3] = static_cast<std::byte>(24 + payload);
      message[19] = std::byte{7};
      std::fill_n(message.begin() + 24, 8, std::byte{0});  // sensor 0
      message[32] = std::byte{0x7f};                       // x beyond any box, or none at all
      length = (24 + payload + 7) / 8 * 8;
    }
    protocol.accept(std::span(message).first(length), piece);
    poses += protocol.newest() ? 1 : 0;
  }
  EXPECT_EQ(poses, 0);
}

}  // namespace
}  // namespace dubsar
