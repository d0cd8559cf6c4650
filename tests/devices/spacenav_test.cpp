// The stream of spacenavd, from both sides.

#include <gtest/gtest.h>

#include "core/base/system/second.h"
#include "devices/driver.h"
#include "devices/spacemouse/spacenav_server.h"
#include "devices/transport/sim_transport.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

TEST(Spacenav, GoldenEvents) {
  SpacenavEvent motion;
  motion.translation = {10, 20, -30};
  motion.rotation = {1, 2, 3};
  motion.period_ms = 16;
  const auto bytes = from_hex("00000000 0a000000 14000000 e2ffffff 01000000 02000000 03000000 10000000");
  EXPECT_EQ(parse_spacenav(bytes), motion);
  EXPECT_EQ(format_spacenav(motion), bytes);
  EXPECT_EQ(to_hex(spacenav_hello(1)), "0155aa7f");
  for (std::size_t length = 0; length < 32; ++length) EXPECT_FALSE(parse_spacenav(std::span(bytes).first(length)));
  auto bad = bytes;
  bad[0] = std::byte{9};
  EXPECT_FALSE(parse_spacenav(bad));
  bad = bytes;
  bad[6] = std::byte{1};  // 65546
  EXPECT_FALSE(parse_spacenav(bad));
}

TEST(Spacenav, EventsAreFoundHoweverTheStreamIsCutAndWithOrWithoutGreeting) {
  SpacenavEvent motion, press;
  motion.translation = {50, 100, -150};
  press.kind = SpacenavEvent::Kind::kPress;
  press.button = 5;
  for (const bool greeting : {true, false}) {
    std::vector<std::byte> stream = greeting ? spacenav_hello(1) : std::vector<std::byte>();
    for (const auto& event : {motion, press}) {
      const auto bytes = format_spacenav(event);
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
    for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
      SimDevice device("spacenavd", false);
      Driver<SpacenavProtocol> driver([&] { return device.open(); }, SpacenavProtocol());
      driver.poll(0);
      for (std::size_t at = 0; at < stream.size(); at += piece)
        device.send(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
      const auto sample = driver.poll(5);
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->translation, glm::dvec3(0.1, 0.2, 0.3));
      EXPECT_EQ(sample->buttons, 32U);
      EXPECT_EQ(driver.counts().refused, 0U);
    }
  }
}

/// A daemon that has greeted, and its client.
struct SpacenavBench {
  SpacenavBench() {
    driver.poll(0);
    device.send(spacenav_hello(1));
  }
  std::optional<SpaceMouseSample> say(const char* hex, TimestampNs now) {
    device.send(from_hex(hex));
    return driver.poll(now);
  }
  SimDevice device{"spacenavd", false};
  Driver<SpacenavProtocol> driver{[this] { return device.open(); }, SpacenavProtocol()};
};

constexpr const char* kPushedRight = "00000000 f4010000 00000000 00000000 00000000 00000000 00000000 10000000";

TEST(Spacenav, FiveHundredIsFullDeflection) {
  SpacenavBench bench;
  EXPECT_EQ(bench.say(kPushedRight, 1)->translation, glm::dvec3(1, 0, 0));
  EXPECT_EQ(bench.say("00000000 5e010000 00000000 06ffffff 00000000 00000000 00000000 10000000", 2)->translation,
            glm::dvec3(0.7, 0, 0.5));
}

// UEV_DEV, DEV_RM, id 0, SpaceMouse Compact, 256f:c635, as spacenavd's send_uevent packs it
TEST(Spacenav, ASpaceMouseThatIsUnpluggedWhilePushedLetsGo) {
  SpacenavBench bench;
  bench.say(kPushedRight, 1);
  ASSERT_EQ(bench.say("01000000 02000000 00000000 00000000 00000000 00000000 00000000 00000000", 2)->buttons, 4U);
  EXPECT_FALSE(
      bench.say("03000000 00000000 01000000 0f020000 6f250000 35c60000 00000000 00000000", 3));  // another came
  const auto gone = bench.say("03000000 01000000 00000000 0f020000 6f250000 35c60000 00000000 00000000", 4);
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->translation, glm::dvec3(0.0));
  EXPECT_EQ(gone->buttons, 0U);
  EXPECT_EQ(gone->time, 4);
  EXPECT_EQ(bench.driver.counts().refused, 0U);
}

TEST(Spacenav, NoDeflectionIsOlderThanASecond) {
  SpacenavBench bench;
  bench.say(kPushedRight, kSecondNs);
  EXPECT_FALSE(bench.driver.poll(2 * kSecondNs));
  const auto still = bench.driver.poll(2 * kSecondNs + 1'000'000);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->translation, glm::dvec3(0.0));
  EXPECT_FALSE(bench.driver.poll(5 * kSecondNs));
  EXPECT_EQ(bench.say(kPushedRight, 6 * kSecondNs)->translation, glm::dvec3(1, 0, 0));
}

TEST(Spacenav, AnswersAndSettingsInTheStreamAreNoMotionAndNoFault) {
  SpacenavBench bench;
  EXPECT_FALSE(bench.say("0310aa7f 07000000 00000000 00000000 00000000 00000000 00000000 00000000", 1));
  EXPECT_FALSE(bench.say("04000000 01000000 00000000 00000000 00000000 00000000 00000000 00000000", 2));
  EXPECT_EQ(bench.driver.counts().refused, 0U);
  EXPECT_TRUE(bench.driver.connected());
}

TEST(SpacenavServer, AnswersHoweverTheRequestsAreCut) {
  std::vector<std::byte> asked = spacenav_hello(3);
  const auto add = [&](const char* hex) {
    const auto bytes = from_hex(hex);
    asked.insert(asked.end(), bytes.begin(), bytes.end());
  };
  add("0420aa7f 00000000 00000000 00000000 00000000 00000000 00000000 00000000");  // USB id
  add("7777aa7f 00000000 00000000 00000000 00000000 00000000 00000000 00000000");  // no request
  for (std::size_t piece = 1; piece <= asked.size(); piece += 5) {
    SpacenavServerSide side;
    std::vector<std::byte> answers;
    for (std::size_t at = 0; at < asked.size(); at += piece) {
      const auto some = side.accept(std::span(asked).subspan(at, std::min(piece, asked.size() - at)));
      answers.insert(answers.end(), some.begin(), some.end());
    }
    EXPECT_EQ(to_hex(answers),
              "0155aa7f"
              "0420aa7f6f25000035c6000000000000000000000000000000000000"
              "00000000"
              "7777aa7f000000000000000000000000000000000000000000000000"
              "ffffffff");
  }
}

}  // namespace
}  // namespace dubsar
