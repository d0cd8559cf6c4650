// A Leap Motion Controller on a real USB bus (USB/IP): the kernel's camera driver takes it, unmodified libusb
// takes it from there, our driver reads calibration and pictures, the tracker sees the hand.

#include "devices/device_list.h"
#include "input/tracking/hands/hand_tracker.h"
#include "tests/devices/leap/one_kind.h"
#include "tests/lab/lab_kernel.h"
#include "tests/lab/leap_gadget.h"

namespace dubsar::lab {
namespace {

std::optional<DeviceInfo> leap_on_the_bus() {
  for (DeviceInfo& info : list_devices("/none"))
    if (info.driver == "leap") return std::move(info);
  return std::nullopt;
}

bool kernel_has_it() { return is_a_camera(lmc1::kVendorId, lmc1::kProductId); }

Result<std::unique_ptr<Transport>> open_leap(const Clock& clock) {
  DeviceSpec choice;
  choice.driver = "leap";
  return open_device(choice, clock).value()();
}

class LabLeap : public Lab {
 protected:
  void plug() {
    const auto plugged = leap_.plug();
    ASSERT_TRUE(plugged) << plugged.error().message;
    ASSERT_TRUE(eventually([] { return leap_on_the_bus().has_value(); }));
  }
  PluggedLeap leap_;
};

TEST_F(LabLeap, IsTakenFromTheKernelsCameraDriverAndShowsAHand) {
  plug();
  EXPECT_EQ(leap_on_the_bus()->state, DeviceState::kUsable);
  ASSERT_TRUE(eventually([] { return kernel_has_it(); })) << "uvcvideo does not take it for a camera";

  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  {
    const auto driver = lmc1_camera([this] { return open_leap(clock_); }, options, clock_);
    const auto started = driver->start();
    ASSERT_TRUE(started) << started.error().message;
    EXPECT_FALSE(kernel_has_it());
    EXPECT_EQ(driver->calibration(), Lmc1SimulatorOptions{}.calibration);
    EXPECT_TRUE(leap_.simulator().led_on(lmc1::Switch::kLedCentre));
    EXPECT_EQ(leap_.simulator().exposure_us(), options.exposure_us);

    HandTracker tracker(stereo_lenses(*driver->calibration(), options.width, options.height));
    Frame frame;
    Hands hands;
    for (int seen = 0; seen < 3; ++seen) {
      ASSERT_TRUE(eventually([&] { return driver->poll(frame); })) << driver->reason();
      ASSERT_TRUE(tracker.track(frame, hands));
      ASSERT_EQ(hands.size(), 1U);
      const glm::dvec3 off_m = hands[0].palm.position_m - PluggedLeap::kPalmM;
      EXPECT_LT(std::abs(off_m.x), 0.004);
      EXPECT_LT(std::abs(off_m.y), 0.006);
      EXPECT_LT(std::abs(off_m.z), 0.008);
    }
    EXPECT_EQ(driver->counters().bad_transfers, 0U);
    EXPECT_EQ(driver->counters().dropped_frames, 0U);

    leap_.unplug();
    EXPECT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; },
                           milliseconds(1000)));
    EXPECT_NE(driver->reason().find("unplugged"), std::string::npos) << driver->reason();
    ASSERT_TRUE(eventually([] { return !leap_on_the_bus(); }));
    EXPECT_EQ(driver->start().error().kind, ErrorKind::kUnavailable);
  }
  EXPECT_EQ(open_descriptors(), descriptors_at_start());
}

TEST_F(LabLeap, IsRefusedWhileAnotherProgramHoldsItAndGivenBackToTheKernelAfterwards) {
  plug();
  ASSERT_TRUE(eventually([] { return kernel_has_it(); }));
  auto first = open_leap(clock_);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_FALSE(kernel_has_it());
  const auto second = open_leap(clock_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kUnavailable);
  EXPECT_NE(second.error().message.find("leapd"), std::string::npos) << second.error().message;
  first->reset();
  EXPECT_TRUE(eventually([] { return kernel_has_it(); }, milliseconds(5000)));
}

TEST_F(LabLeap, ToAnotherUserItSaysThatPermissionIsMissingAndWhatToDo) {
  plug();
  const std::string told = as_nobody([this] {
    const auto opened = open_leap(clock_);
    const auto info = leap_on_the_bus();
    if (opened || !info) return std::string("opened");
    return fmt::format("{}; {}; {}; {}", device_state_name(info->state), info->remedy,
                       opened.error().kind == ErrorKind::kPermission, opened.error().message);
  });
  EXPECT_EQ(told.rfind("no permission; copy 70-dubsar.rules to ", 0), 0U) << told;
  EXPECT_NE(told.find("; true; "), std::string::npos) << told;
  EXPECT_NE(told.find(R"(ATTR{idVendor}=="f182", ATTR{idProduct}=="0003")"), std::string::npos) << told;
}

}  // namespace
}  // namespace dubsar::lab
