// SpaceMouse reports and the spacenavd stream.

#include <dirent.h>
#include <gtest/gtest.h>

#include <fstream>

#include "devices/driver.h"
#include "devices/enumerate.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

constexpr TimestampNs kSecond = 1'000'000'000;

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

TEST(SpaceMouse, ADeviceThatSendsOnlyRubbishIsOpenedAgain) {
  SpaceMouseSim sim;
  Driver<SpaceMouseProtocol> driver([&] { return sim.device().open(); }, SpaceMouseProtocol());
  driver.poll(0);
  for (int i = 0; i < 1000; ++i) sim.device().send(from_hex("ff00"));
  driver.poll(1);
  EXPECT_FALSE(driver.connected());
  EXPECT_EQ(driver.counts().refused, 1000U);
  driver.poll(kSecond);
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
    const TimestampNs away = (cycle % 40) * kSecond / 2;
    for (TimestampNs waited = 0; waited <= away; waited += kSecond / 20, clock.advance(kSecond / 20))
      ASSERT_FALSE(driver.poll(clock.now()));
    ASSERT_FALSE(driver.connected());
    sim.device().plug();
    if (cycle % 2 == 0) driver.wake();  // as HotplugWatch does; without it only short losses are quick
    const TimestampNs replugged = clock.now();
    std::optional<SpaceMouseSample> sample;
    while (!sample && clock.now() - replugged < 20 * kSecond) {
      sim.move({cycle % 350, 0, 0}, {0, 0, 0});
      sample = driver.poll(clock.now());
      clock.advance(kSecond / 60);
    }
    ASSERT_TRUE(sample) << cycle;
    if (cycle % 2 == 0 || away == 0) longest = std::max(longest, clock.now() - replugged);
    ASSERT_EQ(sim.device().open_count(), 1);
  }
  EXPECT_LT(longest, kSecond);
  EXPECT_EQ(driver.counts().losses, 1000U);
  EXPECT_EQ(entries_of("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries_of("/proc/self/task"), threads);
}

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
  motion.translation = {35, 70, -105};
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

TEST(Enumerate, SaysWhyADeviceCannotBeUsedAndNamesTheRule) {
  const std::vector<HidNode> nodes{{"/dev/hidraw0", 0x256f, 0xc635, 1, 8, 0, "3Dconnexion", "SpaceMouse Compact", "S1"},
                                   {"/dev/hidraw1", 0x256f, 0xc650, 1, 2, 0, "3Dconnexion", "CadMouse", ""},
                                   {"/dev/hidraw2", 0x1234, 0x5678, 1, 2, 0, "", "Keyboard", ""},
                                   {"/dev/hidraw3", 0x3318, 0x0424, 0xff00, 1, 3, "", "XREAL Air", ""},
                                   {"/dev/hidraw4", 0x3318, 0x0424, 0xff00, 1, 4, "", "XREAL Air", ""},
                                   {"/dev/hidraw5", 0x256f, 0xc652, 1, 6, 0, "", "Universal Receiver", ""},
                                   {"/dev/hidraw6", 0x04d8, 0xef7e, 0, 0, 0, "", "HoloPlay", ""}};
  const auto found = known_hid_devices(nodes, [](const std::string& path) {
    return path == "/dev/hidraw0" ? EACCES : path == "/dev/hidraw6" ? EBUSY : 0;
  });
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].driver, "spacemouse");
  EXPECT_EQ(found[0].state, DeviceState::kNoPermission);
  EXPECT_NE(found[0].remedy.find(R"(SUBSYSTEM=="hidraw", ATTRS{idVendor}=="256f", ATTRS{idProduct}=="c635")"),
            std::string::npos);
  EXPECT_EQ(found[1].state, DeviceState::kIgnored);
  EXPECT_EQ(found[2].path, "/dev/hidraw3");
  EXPECT_EQ(found[2].state, DeviceState::kUsable);
  EXPECT_EQ(found[2].reason, "");
  EXPECT_EQ(found[3].driver, "looking_glass");
  EXPECT_EQ(found[3].state, DeviceState::kBusy);
}

}  // namespace
}  // namespace dubsar
