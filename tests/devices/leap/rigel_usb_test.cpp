// A Rigel through unmodified libusb, found and opened as the program does it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "devices/device_list.h"
#include "devices/leap/leap_camera.h"
#include "devices/leap/rigel_simulator.h"
#include "usb_kernel.h"

namespace dubsar {
namespace {

using RigelOverLibusb = OverLibusb;
using ::testing::HasSubstr;

const DeviceInfo* find(const std::vector<DeviceInfo>& devices, std::uint16_t product) {
  const auto found = std::find_if(devices.begin(), devices.end(), [&](const DeviceInfo& d) {
    return d.vendor_id == 0x2936 && d.product_id == product;
  });
  return found == devices.end() ? nullptr : &*found;
}

TEST_F(RigelOverLibusb, IsListedOpenedByItsDescriptorsAndStreamedUntilItIsUnplugged) {
  RigelSimulatorOptions device;
  device.stream.paced = true;
  device.hands = [](std::uint64_t) {
    HandPose pose;
    pose.palm.position_m = {0.0, 0.25, 0.0};
    return std::vector{pose_hand(pose)};
  };
  RigelSimulator simulator(device);
  UsbKernel kernel(simulator);
  const auto listed = list_devices("/nowhere");
  const DeviceInfo* const rigel = find(listed, 0x1202);
  ASSERT_NE(rigel, nullptr);
  EXPECT_EQ(rigel->driver, "leap");
  EXPECT_EQ(rigel->name, "Leap Motion Rigel");
  EXPECT_EQ(rigel->state, DeviceState::kUsable);

  SteadyClock clock;
  DeviceSpec choice;
  choice.driver = "leap";
  const auto open = open_device(choice, clock);
  ASSERT_TRUE(open);
  auto camera = make_leap_camera(*open, {}, clock);
  const auto started = camera->start();
  ASSERT_TRUE(started) << started.error().message;
  EXPECT_EQ(camera->calibration(), device.calibration);
  EXPECT_TRUE(simulator.lights_on());
  Frame frame;
  ASSERT_TRUE(eventually([&] { return camera->poll(frame) && frame.sequence >= 5; })) << camera->reason();
  EXPECT_EQ(camera->counters().dropped_frames + camera->counters().bad_transfers, 0U);
  std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
  HandRenderer(device.calibration, HandRenderOptions{})
      .render(device.hands(0), device.seed + frame.sequence - 1, left, right);
  EXPECT_TRUE(std::equal(left.begin(), left.end() - 640, frame.view(0).begin()));
  EXPECT_TRUE(std::equal(right.begin(), right.end() - 640, frame.view(1).begin()));

  kernel.unplug();
  EXPECT_TRUE(eventually([&] { return camera->poll(frame), camera->state() == FrameSourceState::kLost; }));
  camera->stop();
  EXPECT_EQ(find(list_devices("/nowhere"), 0x1202), nullptr);
}

TEST_F(RigelOverLibusb, AController2IsListedWithTheOnlyWayToIt) {
  RigelSimulatorOptions device;
  device.product = 0x1206;
  RigelSimulator simulator(device);
  UsbKernel kernel(simulator);
  const auto listed = list_devices("/nowhere");
  const DeviceInfo* const controller = find(listed, 0x1206);
  ASSERT_NE(controller, nullptr);
  EXPECT_EQ(controller->driver, "leapc");
  EXPECT_EQ(controller->state, DeviceState::kIgnored);
  EXPECT_THAT(controller->reason, HasSubstr("only Ultraleap's own service"));
  EXPECT_THAT(controller->remedy, HasSubstr("--input leapc"));
  SteadyClock clock;
  DeviceSpec choice;
  choice.driver = "leap";
  const auto opened = (*open_device(choice, clock))();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(opened.error().message,
              testing::AllOf(HasSubstr("Leap Motion Controller 2"), HasSubstr("--input leapc")));
}

}  // namespace
}  // namespace dubsar
