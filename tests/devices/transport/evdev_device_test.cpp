// Touch panels as the kernel tells them, in a simulated /sys and /dev. Run with libumockdev-preload.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "devices/device_list.h"
#include "devices/driver.h"
#include "devices/touch/touch_protocol.h"
#include "tests/devices/transport/evdev_testbed.h"

namespace dubsar {
namespace {

constexpr milliseconds kSoon{1000};

class Evdev : public ::testing::Test {
 protected:
  void SetUp() override {
    testbed_ = std::make_unique<EvdevTestbed>();
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0) GTEST_SKIP() << "no pseudo-terminals here (mount /dev/pts): umockdev makes its nodes from them";
    ::close(terminal);
    if (!umockdev_in_mock_environment()) GTEST_SKIP() << "run it under umockdev-wrapper (ctest does the same)";
  }
  static const DriverEntry& touch() { return **find_driver("touch", "test", driver_table()); }
  static std::vector<DeviceInfo> listed() {
    return known_touch_panels(list_evdev_nodes(),
                              [](const std::string& path) { return ::access(path.c_str(), R_OK) == 0 ? 0 : errno; });
  }
  void put_finger(int slot, int id, int x, int y) {
    testbed_->set_slot(slot, id, x, y);
    EXPECT_TRUE(testbed_->send(EV_ABS, ABS_MT_SLOT, slot) && testbed_->send(EV_ABS, ABS_MT_TRACKING_ID, id) &&
                testbed_->send(EV_ABS, ABS_MT_POSITION_X, x) && testbed_->send(EV_ABS, ABS_MT_POSITION_Y, y) &&
                testbed_->send(EV_SYN, SYN_REPORT, 0));
  }
  void lift(int slot) {
    testbed_->set_slot(slot, -1, 0, 0);
    EXPECT_TRUE(testbed_->send(EV_ABS, ABS_MT_SLOT, slot) && testbed_->send(EV_ABS, ABS_MT_TRACKING_ID, -1) &&
                testbed_->send(EV_SYN, SYN_REPORT, 0));
  }
  std::unique_ptr<EvdevTestbed> testbed_;
  SteadyClock clock_;
};

TEST_F(Evdev, APanelIsFoundByWhatItCanDoAndNothingElseIs) {
  testbed_->plug({"Keyboard", 1, 2, "0", "0"});
  EXPECT_TRUE(listed().empty());
  testbed_->unplug();
  testbed_->plug({"Touchpad", 1, 2, "5", "260800000000003"});  // a pointer, whose places are not those of the picture
  EXPECT_TRUE(listed().empty());
  testbed_->unplug();
  testbed_->plug({"Old panel", 1, 2, "2", "3"});
  auto found = listed();
  ASSERT_EQ(found.size(), 0U) << "no ABS_MT_POSITION_X";
  testbed_->unplug();
  testbed_->plug({"Type A", 1, 2, "2", "60000000000003"});
  found = listed();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].state, DeviceState::kIgnored);
  EXPECT_NE(found[0].reason.find("multi-touch type A"), std::string::npos);
  EXPECT_NE(open_touch_panel(touch(), "").error().message.find("type A"), std::string::npos);
  testbed_->unplug();
  testbed_->plug({"eGalax", 0x0eef, 0x7200, "2", "260800000000003"});
  found = listed();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].driver, "touch");
  EXPECT_EQ(found[0].name, "eGalax");
  EXPECT_EQ(found[0].vendor_id, 0x0eef);
  EXPECT_EQ(found[0].product_id, 0x7200);
  EXPECT_EQ(found[0].path, testbed_->node());
  EXPECT_EQ(found[0].state, DeviceState::kUsable);
  EXPECT_EQ(open_touch_panel(touch(), "/dev/input/event77").error().message,
            "touch: /dev/input/event77 is no touch panel");
}

TEST_F(Evdev, ItIsHeldAndItsFingersAreWhereTheyAre) {
  testbed_->plug();
  Driver<TouchProtocol> driver([] { return open_touch_panel(touch(), ""); }, TouchProtocol());
  EXPECT_FALSE(driver.poll(clock_.now()));
  ASSERT_TRUE(driver.connected()) << driver.reason();
  EXPECT_EQ(testbed_->grabs(), 1);
  put_finger(3, 12, 4095, 0);
  const auto sample = driver.poll(clock_.now(), kSoon);
  ASSERT_TRUE(sample);
  ASSERT_EQ(sample->frames.back().contacts.size(), 1U);
  EXPECT_EQ(sample->frames.back().contacts[0].at, glm::dvec2(1.0, 0.0));
}

TEST_F(Evdev, AfterALossTheKernelIsAskedForTheSlots) {
  testbed_->plug();
  Driver<TouchProtocol> driver([] { return open_touch_panel(touch(), ""); }, TouchProtocol());
  driver.poll(clock_.now());
  put_finger(0, 1, 0, 0);
  ASSERT_TRUE(driver.poll(clock_.now(), kSoon));
  testbed_->set_slot(0, -1, 0, 0);
  testbed_->set_slot(4, 9, 4095, 2047);
  ASSERT_TRUE(testbed_->send(EV_SYN, SYN_DROPPED, 0));
  ASSERT_TRUE(testbed_->send(EV_SYN, SYN_REPORT, 0));
  EXPECT_FALSE(driver.poll(clock_.now(), kSoon));
  const auto sample = driver.poll(clock_.now());
  ASSERT_TRUE(sample);
  ASSERT_EQ(sample->frames.back().contacts.size(), 1U);
  EXPECT_EQ(sample->frames.back().contacts[0].at, glm::dvec2(1.0, 1.0));
  EXPECT_TRUE(sample->frames.back().cancelled);
}

TEST_F(Evdev, AFingerThatIsOnItWhenItIsOpenedKeepsOthersTheirRelease) {
  testbed_->plug();
  testbed_->set_slot(0, 3, 100, 100);
  Driver<TouchProtocol> driver([] { return open_touch_panel(touch(), ""); }, TouchProtocol());
  driver.poll(clock_.now());
  ASSERT_TRUE(driver.connected()) << driver.reason();
  EXPECT_EQ(testbed_->grabs(), 0);
  put_finger(0, 3, 200, 200);
  EXPECT_FALSE(driver.poll(clock_.now(), kSoon));
  EXPECT_EQ(testbed_->grabs(), 0);
  lift(0);
  EXPECT_FALSE(driver.poll(clock_.now(), kSoon));
  EXPECT_EQ(testbed_->grabs(), 1);
  put_finger(0, 4, 4095, 2047);
  const auto sample = driver.poll(clock_.now(), kSoon);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->frames.back().contacts.size(), 1U);
}

TEST_F(Evdev, WhatAnotherProgramHoldsOrThisUserMayNotReadIsSaid) {
  testbed_->plug();
  testbed_->hold_elsewhere(true);
  const auto held = open_touch_panel(touch(), "");
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().kind, ErrorKind::kUnavailable);
  EXPECT_EQ(held.error().message,
            "evdev: another program holds " + testbed_->node() + "; end it, or take its hold away");
  if (::geteuid() == 0) return;  // root may read everything
  ASSERT_EQ(::chmod(testbed_->node_in_testbed().c_str(), 0), 0);
  const auto found = listed();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].state, DeviceState::kNoPermission);
  EXPECT_NE(found[0].remedy.find("ID_INPUT_TOUCHSCREEN"), std::string::npos);
}

TEST_F(Evdev, UnpluggedItIsLostAndPluggedInAgainItComesBack) {
  testbed_->plug();
  Driver<TouchProtocol> driver([] { return open_touch_panel(touch(), ""); }, TouchProtocol());
  for (int cycle = 0; cycle < 3; ++cycle) {
    driver.wake();
    driver.poll(clock_.now());
    ASSERT_TRUE(driver.connected()) << driver.reason();
    put_finger(0, cycle, 4095, 0);
    EXPECT_TRUE(driver.poll(clock_.now(), kSoon));
    testbed_->unplug();
    driver.poll(clock_.now(), kSoon);
    EXPECT_FALSE(driver.connected());
    EXPECT_FALSE(driver.reason().empty());
    EXPECT_TRUE(listed().empty());
    for (int s = 0; s < EvdevTestbed::kSlots; ++s) testbed_->set_slot(s, -1, 0, 0);
    testbed_->plug();
  }
}

}  // namespace
}  // namespace dubsar
