// The real libusb code path on a simulated kernel: umockdev answers the usbdevfs requests of unmodified libusb from the
// simulated device. Runs with libumockdev-preload (the test declaration sets it).

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "devices/leap/lmc1_simulator.h"
#include "devices/transport/usb_transport.h"
#include "tests/devices/leap/one_kind.h"
#include "usb_kernel.h"

namespace dubsar {
namespace {

UsbOpenOptions leap_options() {
  UsbOpenOptions options;
  options.interfaces = {lmc1::kControlInterface, lmc1::kStreamInterface};
  options.read_endpoint = lmc1::kBulkEndpoint;
  options.transfer_bytes = lmc1::kMaxTransferBytes;
  return options;
}

using Lmc1OverLibusb = OverLibusb;

TEST_F(Lmc1OverLibusb, IsListedReadCalibratedAndStreamedUntilItIsUnplugged) {
  Lmc1SimulatorOptions device;
  device.hands = [](std::uint64_t n) {
    HandPose pose;
    pose.palm.position_m = {0.001 * static_cast<double>(n), 0.25, 0.0};
    return std::vector{pose_hand(pose)};
  };
  device.paced = true;
  Lmc1Simulator simulator(device);
  UsbKernel kernel(simulator);

  const auto listed = list_usb_devices();
  ASSERT_TRUE(listed) << listed.error().message;
  ASSERT_EQ(listed->size(), 1U);
  EXPECT_EQ(listed->front().vendor_id, lmc1::kVendorId);
  EXPECT_EQ(listed->front().path, "usb:001/002");
  EXPECT_TRUE(listed->front().accessible);

  SteadyClock clock;
  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  auto driver = lmc1_camera(
      [&] { return open_usb_transport(lmc1::kVendorId, lmc1::kProductId, leap_options(), listed->front().path); },
      options, clock);
  const auto started = driver->start();
  ASSERT_TRUE(started) << started.error().message;
  EXPECT_EQ(driver->calibration(), device.calibration);
  EXPECT_TRUE(simulator.led_on(lmc1::Switch::kLedRight));

  Frame frame;
  ASSERT_TRUE(eventually([&] { return driver->poll(frame) && frame.sequence >= 20; })) << driver->reason();
  EXPECT_EQ(driver->counters().dropped_frames, 0U);
  HandRenderer renderer(device.calibration, HandRenderOptions{});
  std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
  renderer.render(device.hands(frame.sequence - 1), device.seed + frame.sequence - 1, left, right);
  EXPECT_TRUE(std::equal(left.begin(), left.end() - 6, frame.view(0).begin()));
  EXPECT_TRUE(std::equal(right.begin(), right.end() - 6, frame.view(1).begin()));

  kernel.unplug();
  EXPECT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; }));
  driver->stop();
  const auto after = list_usb_devices();
  ASSERT_TRUE(after);
  EXPECT_TRUE(after->empty());
  EXPECT_EQ(driver->start().error().kind, ErrorKind::kNoInput);
}

TEST_F(Lmc1OverLibusb, BuffersThatTheKernelRefusedAreOfferedAgain) {
  Lmc1SimulatorOptions device;
  device.paced = true;
  Lmc1Simulator simulator(device);
  UsbKernel kernel(simulator);
  SteadyClock clock;
  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  UsbOpenOptions one_buffer = leap_options();
  one_buffer.transfers_in_flight = 1;
  auto driver =
      lmc1_camera([&] { return open_usb_transport(lmc1::kVendorId, lmc1::kProductId, one_buffer); }, options, clock);
  kernel.refuse(2);  // the first ones already
  ASSERT_TRUE(driver->start());
  Frame frame;
  ASSERT_TRUE(eventually([&] { return driver->poll(frame) && frame.sequence >= 3; })) << driver->reason();
  kernel.refuse(1);  // with one buffer nothing would come any more
  const std::uint64_t before = frame.sequence;
  EXPECT_TRUE(eventually([&] { return driver->poll(frame) && frame.sequence >= before + 5; })) << driver->reason();
}

TEST_F(Lmc1OverLibusb, AStalledRequestIsBadDataAndTheDeviceStaysUsable) {
  Lmc1Simulator simulator(Lmc1SimulatorOptions{});
  UsbKernel kernel(simulator);
  auto transport = open_usb_transport(lmc1::kVendorId, lmc1::kProductId, leap_options());
  ASSERT_TRUE(transport) << transport.error().message;
  std::array<std::byte, 2> data{};
  const auto stalled = (*transport)->control(lmc1::get_current(9, 1), data, milliseconds(500));
  ASSERT_FALSE(stalled);
  EXPECT_EQ(stalled.error().kind, ErrorKind::kBadData);
  EXPECT_EQ((*transport)->control(lmc1::get_current(5, 7), data, milliseconds(500)), std::size_t{2});
  EXPECT_EQ((*transport)->read(data, milliseconds(5)), std::size_t{0});  // not streaming: nothing comes
}

}  // namespace
}  // namespace dubsar
