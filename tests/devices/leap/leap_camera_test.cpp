#include "devices/leap/leap_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/leap/lmc1_simulator.h"
#include "devices/leap/rigel_simulator.h"

namespace dubsar {
namespace {

using ::testing::HasSubstr;

LeapCameraOptions quick_camera() {
  LeapCameraOptions options;
  options.calibration_settle = milliseconds(0);
  options.exposure_us = 150;
  return options;
}

TEST(LeapCamera, AsksTheDeviceWhatItIs) {
  SteadyClock clock;
  Lmc1SimulatorOptions lmc1;
  lmc1.frame_limit = 1;
  Lmc1Simulator controller(lmc1);
  auto camera = make_leap_camera([&] { return controller.open(); }, quick_camera(), clock);
  EXPECT_FALSE(camera->calibration());
  ASSERT_TRUE(camera->start());
  EXPECT_EQ(camera->calibration(), lmc1.calibration);
  EXPECT_EQ(camera->width() * 1000 + camera->height(), 640'240);
  EXPECT_EQ(controller.exposure_us(), 150);
  Frame frame;
  EXPECT_TRUE(camera->poll(frame));

  for (const std::uint16_t product : {rigel::kRigel, rigel::kSir170}) {
    RigelSimulatorOptions device;
    device.product = product;
    device.stream.frame_limit = 1;
    RigelSimulator simulator(device);
    camera = make_leap_camera([&] { return simulator.open(); }, quick_camera(), clock);
    const auto started = camera->start();
    ASSERT_TRUE(started) << started.error().message;
    EXPECT_EQ(camera->calibration(), device.calibration);
    EXPECT_EQ(camera->width() * 1000 + camera->height(), 640'240);
    EXPECT_EQ(simulator.exposure_us(), 150);
    EXPECT_TRUE(camera->poll(frame));
  }
}

TEST(LeapCamera, OthersAreSentToTheServiceOrRefused) {
  SteadyClock clock;
  RigelSimulatorOptions device;
  device.product = 0x1206;
  RigelSimulator controller_2(device);
  auto started = make_leap_camera([&] { return controller_2.open(); }, quick_camera(), clock)->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(started.error().message,
              testing::AllOf(HasSubstr("Leap Motion Controller 2"), HasSubstr("--input leapc")));
  device.product = 0x4711;
  RigelSimulator stranger(device);
  started = make_leap_camera([&] { return stranger.open(); }, quick_camera(), clock)->start();
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, HasSubstr("2936:4711"));
}

TEST(LeapCamera, ProductsAreKnownByTheirNumbers) {
  EXPECT_EQ(find_leap_product(0x2936, 0x1206)->name, "Leap Motion Controller 2");
  EXPECT_EQ(find_leap_product(0xf182, 0x1202), nullptr);
}

}  // namespace
}  // namespace dubsar
