// The real hidapi against a simulated hidraw node. Run with libumockdev-preload.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <thread>

#include "devices/device_list.h"
#include "devices/driver.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/spacemouse/spacemouse_protocol.h"
#include "devices/transport/hid_transport.h"
#include "tests/devices/device_bytes.h"
#include "tests/devices/transport/hidraw_testbed.h"

namespace dubsar {
namespace {

constexpr milliseconds kSoon{1000};

class Hidraw : public ::testing::Test {
 protected:
  void SetUp() override {
    testbed_ = std::make_unique<HidrawTestbed>(identity());
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0) GTEST_SKIP() << "no pseudo-terminals here (mount /dev/pts): umockdev makes its nodes from them";
    ::close(terminal);
    if (!umockdev_in_mock_environment()) GTEST_SKIP() << "run it under umockdev-wrapper (ctest does the same)";
    testbed_->plug();
  }
  virtual HidIdentity identity() const { return {}; }
  std::unique_ptr<HidrawTestbed> testbed_;
  SteadyClock clock_;
};

TEST_F(Hidraw, TheDeviceIsListedWithItsNameAndSerial) {
  const auto devices = list_hid_devices();
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_EQ(devices[0].driver, "spacemouse");
  EXPECT_EQ(devices[0].path, "/dev/hidraw0");
  EXPECT_EQ(devices[0].name, "SpaceMouse Compact");
  EXPECT_EQ(devices[0].serial, "SIM1");
  EXPECT_EQ(devices[0].vendor_id, 0x256f);
  EXPECT_EQ(devices[0].state, DeviceState::kUsable);
  testbed_->unplug();
  EXPECT_TRUE(list_hid_devices().empty());
}

TEST_F(Hidraw, ReportsFeaturesAndTheLightPassThroughHidapi) {
  auto transport = open_hid("/dev/hidraw0", clock_);
  ASSERT_TRUE(transport) << transport.error().message;
  std::array<std::byte, 64> buffer;
  EXPECT_EQ((*transport)->read(buffer, milliseconds(5)).value(), 0U);
  ASSERT_TRUE(testbed_->send(from_hex("015e01f0ff0500a2fe02000001")));
  ASSERT_TRUE(testbed_->send(from_hex("0303")));
  EXPECT_EQ((*transport)->read(buffer, kSoon).value(), 13U);
  EXPECT_EQ((*transport)->read(buffer, kSoon).value(), 2U);
  EXPECT_EQ(to_hex(std::span(buffer).first(2)), "0303");
  EXPECT_EQ((*transport)->get_feature(2, std::span(buffer).first(7)).value(), 7U);
  EXPECT_EQ(to_hex(std::span(buffer).first(7)), "02a1a2a3a4a5a6");
  EXPECT_TRUE((*transport)->set_feature(from_hex("02010203040506")));
  ASSERT_EQ(testbed_->features_set().size(), 1U);
  EXPECT_EQ(to_hex(testbed_->features_set()[0]), "02010203040506");
  EXPECT_TRUE((*transport)->write(spacemouse_led_report(true)));
  ASSERT_EQ(testbed_->written().size(), 1U);
  EXPECT_EQ(to_hex(testbed_->written()[0]), "0401");
}

TEST_F(Hidraw, TheDriverComesBackAfterUnpluggingWithinASecond) {
  Driver<SpaceMouseProtocol> driver([&] { return open_hid_device("spacemouse", clock_); }, SpaceMouseProtocol());
  driver.poll(clock_.now());
  ASSERT_TRUE(driver.connected()) << driver.reason();
  for (int cycle = 0; cycle < 3; ++cycle) {
    ASSERT_TRUE(testbed_->send(from_hex("015e0100000000")));
    auto sample = driver.poll(clock_.now(), kSoon);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->translation.x, 1.0);
    testbed_->unplug();
    const TimestampNs unplugged = clock_.now();
    while (driver.connected() && clock_.now() - unplugged < 2'000'000'000) driver.poll(clock_.now(), milliseconds(20));
    EXPECT_FALSE(driver.connected());
    EXPECT_LT(clock_.now() - unplugged, 1'000'000'000);
    testbed_->plug();
    driver.wake();
    const TimestampNs replugged = clock_.now();
    sample.reset();
    while (!sample && clock_.now() - replugged < 2'000'000'000) {
      ASSERT_TRUE(testbed_->send(from_hex("015e0100000000")));
      sample = driver.poll(clock_.now(), milliseconds(10));
    }
    EXPECT_TRUE(sample);
    EXPECT_LT(clock_.now() - replugged, 1'000'000'000);
  }
}

/// A Looking Glass of the first generation: report 0, 68 bytes each way.
class HidrawLookingGlass : public Hidraw {
 protected:
  HidIdentity identity() const override {
    return {kLookingGlassVendor,
            kLookingGlassProduct,
            "Looking Glass Factory",
            "HoloPlay",
            "LKG-4K-00017",
            {0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08,
             0x95, 0x44, 0x09, 0x01, 0x81, 0x02, 0x95, 0x44, 0x09, 0x02, 0xb1, 0x02, 0xc0}};
  }
};

TEST_F(HidrawLookingGlass, ItsCalibrationComesThroughHidapi) {
  std::string json = R"({"serial": "LKG-4K-00017", "pitch": {"value": 50.07}, "note": ")";
  while (json.size() < 700) json += static_cast<char>('a' + json.size() % 26);
  json += "\"}";
  std::string memory{'\0', '\0', static_cast<char>(json.size() >> 8), static_cast<char>(json.size() & 255)};
  memory += json;
  testbed_->on_feature_set([&](std::span<const std::byte> request) {
    LookingGlassPage page;
    page.number =
        static_cast<std::uint16_t>(std::to_integer<unsigned>(request[2]) << 8 | std::to_integer<unsigned>(request[3]));
    for (std::size_t i = 0; i < page.data.size() && page.number * page.data.size() + i < memory.size(); ++i)
      page.data[i] = static_cast<std::byte>(memory[page.number * page.data.size() + i]);
    const auto report = format_looking_glass(page);
    testbed_->send(std::span(report).first(64));  // the kernel hands it on in two pieces
    testbed_->send(std::span(report).subspan(64));
  });
  const auto listed = list_hid_devices();
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].driver, "looking_glass");
  auto transport = open_hid_device("looking_glass", clock_);
  ASSERT_TRUE(transport) << transport.error().message;
  EXPECT_EQ(read_looking_glass_calibration(**transport, clock_).value(), json);
}

TEST_F(Hidraw, AMissingNodeIsUnavailable) {
  EXPECT_EQ(open_hid("/dev/hidraw9", clock_).error().kind, ErrorKind::kUnavailable);
}

}  // namespace
}  // namespace dubsar
