// SpaceMouse reports, and one that comes and goes.

#include <dirent.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/system/second.h"
#include "devices/driver.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/transport/record_transport.h"
#include "devices/transport/replay_transport.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

using Ids = std::initializer_list<std::uint16_t>;

TEST(SpaceMouse, GoldenReportsOfEveryForm) {
  using R = SpaceMouseReport;
  const glm::ivec3 t(350, -16, 5), r(-350, 2, 256);
  EXPECT_EQ(parse_spacemouse(from_hex("01 5e01 f0ff 0500")), (R{t, {}, {}, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("02 a2fe 0200 0001")), (R{{}, r, {}, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("01 5e01 f0ff 0500 a2fe 0200 0001")), (R{t, r, {}, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("03 03")), (R{{}, {}, 3, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("03 01800000")), (R{{}, {}, 0x8001, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("03 000000000080")), (R{{}, {}, std::uint64_t{1} << 47, {}}));
  EXPECT_EQ(parse_spacemouse(from_hex("17 5a 00")), (R{{}, {}, {}, 90}));
  EXPECT_EQ(to_hex(spacemouse_led_report(true)), "0401");
}

TEST(SpaceMouse, RefusesOtherLengthsNumbersAndValues) {
  const std::vector<std::byte> combined = from_hex("01 5e01 f0ff 0500 a2fe 0200 0001");
  for (std::size_t length = 0; length < combined.size(); ++length)
    EXPECT_EQ(parse_spacemouse(std::span(combined).first(length)).has_value(), length == 7) << length;
  for (const char* bad : {"", "01", "03", "04 00", "00 000000000000", "17 65 00", "01 ff7f 0000 0000",
                          "02 0000 0080 0000", "01 0000 0000 0000 0000 0000 0080", "03 00000000000000000000"})
    EXPECT_FALSE(parse_spacemouse(from_hex(bad))) << bad;
}

TEST(SpaceMouse, FormattedReportsParseToThemselves) {
  for (const bool combined : {false, true}) {
    const SpaceMouseReport report{glm::ivec3(1, -2, 3), glm::ivec3(-350, 350, 0), 0x80000001U, 55};
    SpaceMouseReport together;
    for (const auto& bytes : format_spacemouse(report, combined)) {
      const auto part = parse_spacemouse(bytes);
      ASSERT_TRUE(part);
      if (part->translation) together.translation = part->translation;
      if (part->rotation) together.rotation = part->rotation;
      if (part->buttons) together.buttons = part->buttons;
      if (part->battery_percent) together.battery_percent = part->battery_percent;
    }
    EXPECT_EQ(together, report);
  }
}

TEST(SpaceMouse, CapPulledUpMovesUpOnTheScreen) {
  for (const bool combined : {false, true}) {
    SpaceMouseSim sim(combined);
    Driver<SpaceMouseProtocol> driver([&] { return sim.device().open(); }, SpaceMouseProtocol());
    EXPECT_FALSE(driver.poll(0));
    EXPECT_TRUE(sim.light_is_on());
    sim.move({0, 0, -350}, {0, 0, 35});  // device z points down
    sim.press(2);
    const auto sample = driver.poll(10);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->translation, glm::dvec3(0, 1, 0));
    EXPECT_EQ(sample->rotation, glm::dvec3(0, -0.1, 0));
    EXPECT_EQ(sample->buttons, 2U);
    EXPECT_EQ(sample->time, 10);
    EXPECT_FALSE(driver.poll(20));
  }
}

// spacenavd's table (src/dev.c): these three have neither DF_SWAPYZ nor DF_INVYZ, so that their raw axes are the
// daemon's: x right, y up, z away from the user.
TEST(SpaceMouse, PlusXtClassicAndNuLooqCountYUp) {
  for (const std::uint16_t product : Ids{0xc603, 0xc606, 0xc640}) {
    SpaceMouseSim sim(false, {0x046d, product});
    Driver<SpaceMouseProtocol> driver([&] { return sim.device().open(); }, SpaceMouseProtocol());
    driver.poll(0);
    sim.move({35, 350, 70}, {0, 35, -350});
    const auto sample = driver.poll(10);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->translation, glm::dvec3(0.1, 1, -0.2));
    EXPECT_EQ(sample->rotation, glm::dvec3(0, 0.1, 1));
  }
}

TEST(SpaceMouse, ARecordingTellsWhichModelItWas) {
  ManualClock clock;
  const auto path = std::filesystem::path(::testing::TempDir()) / "plus_xt.txt";
  SpaceMouseSim sim(false, {0x046d, 0xc603});
  {
    const auto writer = RecordingWriter::create(path, "spacemouse", "", clock).value();
    Driver<SpaceMouseProtocol> driver(
        [&]() -> Result<std::unique_ptr<Transport>> {
          DUBSAR_ASSIGN(auto below, sim.device().open());
          return make_record_transport(std::move(below), writer);
        },
        SpaceMouseProtocol());
    driver.poll(0);
    sim.move({0, 350, 0}, {0, 0, 0});
    ASSERT_EQ(driver.poll(1)->translation, glm::dvec3(0, 1, 0));
    ASSERT_TRUE(writer->finish());
  }
  ReplaySession session(read_recording(path).value(), clock, 0.0);
  Driver<SpaceMouseProtocol> driver([&] { return session.open(); }, SpaceMouseProtocol());
  EXPECT_EQ(driver.poll(0)->translation, glm::dvec3(0, 1, 0));
  std::filesystem::remove(path);
}

TEST(SpaceMouse, ADeviceThatSendsOnlyRubbishIsOpenedAgain) {
  SpaceMouseSim sim;
  Driver<SpaceMouseProtocol> driver([&] { return sim.device().open(); }, SpaceMouseProtocol());
  driver.poll(0);
  for (int i = 0; i < 1000; ++i) sim.device().send(from_hex("ff00"));
  driver.poll(1);
  EXPECT_FALSE(driver.connected());
  EXPECT_EQ(driver.counts().refused, 1000U);
  driver.poll(kSecondNs);
  EXPECT_TRUE(driver.connected());
}

int entries_of(const char* folder) {
  DIR* const open = ::opendir(folder);
  int count = 0;
  while (::readdir(open)) ++count;
  ::closedir(open);
  return count;
}

TEST(SpaceMouse, AThousandUnpluggingsLeaveNoThreadNoDescriptorAndTakeLessThanASecondToReturn) {
  SpaceMouseSim sim;
  ManualClock clock;
  Driver<SpaceMouseProtocol> driver([&] { return sim.device().open(); }, SpaceMouseProtocol());
  driver.poll(clock.now());
  const int descriptors = entries_of("/proc/self/fd"), threads = entries_of("/proc/self/task");
  TimestampNs longest = 0;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    sim.device().unplug();
    const TimestampNs away = (cycle % 40) * kSecondNs / 2;
    for (TimestampNs waited = 0; waited <= away; waited += kSecondNs / 20, clock.advance(kSecondNs / 20))
      ASSERT_FALSE(driver.poll(clock.now()));
    ASSERT_FALSE(driver.connected());
    sim.device().plug();
    if (cycle % 2 == 0) driver.wake();  // as HotplugWatch does; without it only short losses are quick
    const TimestampNs replugged = clock.now();
    std::optional<SpaceMouseSample> sample;
    while (!sample && clock.now() - replugged < 20 * kSecondNs) {
      sim.move({cycle % 350, 0, 0}, {0, 0, 0});
      sample = driver.poll(clock.now());
      clock.advance(kSecondNs / 60);
    }
    ASSERT_TRUE(sample) << cycle;
    if (cycle % 2 == 0 || away == 0) longest = std::max(longest, clock.now() - replugged);
    ASSERT_EQ(sim.device().open_count(), 1);
  }
  EXPECT_LT(longest, kSecondNs);
  EXPECT_EQ(driver.counts().losses, 1000U);
  EXPECT_EQ(entries_of("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries_of("/proc/self/task"), threads);
}

}  // namespace
}  // namespace dubsar
