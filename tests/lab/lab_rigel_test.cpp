// A Rigel on a real USB bus (USB/IP): the kernel's camera driver accepts our descriptors of it, the program
// finds, opens and reads it through unmodified libusb.

#include <gmock/gmock.h>

#include "devices/device_list.h"
#include "devices/leap/leap_camera.h"
#include "devices/leap/rigel_simulator.h"
#include "tests/lab/lab_kernel.h"
#include "tests/lab/usb_gadget.h"
#include "tests/lab/usbip_port.h"

namespace dubsar::lab {
namespace {

class RigelGadget final : public UsbGadget {
 public:
  RigelGadget(RigelSimulator simulator, std::uint16_t product)
      : simulator_(std::move(simulator)), device_(RigelSimulator::device_descriptor(product)) {}
  std::span<const std::uint8_t> device_descriptor() const override { return device_; }
  std::span<const std::uint8_t> configuration_descriptor() const override {
    return RigelSimulator::configuration_descriptor();
  }
  std::string text(int) const override { return ""; }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data) override {
    return simulator_.control(request, data);
  }
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::byte> data) override {
    if (endpoint != 0x82) return std::nullopt;  // the interrupt endpoint never says anything
    const std::size_t length = simulator_.next_transfer(data);
    return length == 0 ? std::nullopt : std::optional(length);
  }
  Result<void> receive(std::uint8_t, std::span<const std::byte>) override {
    return fail(ErrorKind::kBadData, "rigel simulator: it has no endpoint to write to");
  }

 private:
  RigelSimulator simulator_;
  std::array<std::uint8_t, 18> device_;
};

std::optional<DeviceInfo> camera_on_the_bus() {
  for (DeviceInfo& info : list_devices("/none"))
    if (info.vendor_id == rigel::kVendorId) return std::move(info);
  return std::nullopt;
}

using LabRigel = Lab;

TEST_F(LabRigel, TheKernelTakesItForACameraAndItsPicturesComeThroughLibusb) {
  RigelSimulatorOptions options;
  options.product = rigel::kSir170;
  options.stream.paced = true;
  options.stream.frame_limit = 2;  // rendering is slow in there
  HandPose pose;
  pose.palm.position_m = {0.03, 0.28, 0.02};
  options.hands = [hand = pose_hand(pose)](std::uint64_t) { return std::vector{hand}; };
  RigelSimulator simulator(options);
  RigelGadget gadget(simulator, options.product);
  UsbipPort port(gadget);
  const auto plugged = port.plug();
  ASSERT_TRUE(plugged) << plugged.error().message;
  ASSERT_TRUE(eventually([] { return camera_on_the_bus().has_value(); }));
  EXPECT_EQ(camera_on_the_bus()->name, "Ultraleap Stereo IR 170");
  ASSERT_TRUE(eventually([&] { return is_a_camera(rigel::kVendorId, options.product); }))
      << "uvcvideo does not take it for a camera";

  DeviceSpec choice;
  choice.driver = "leap";
  {
    const auto camera = make_leap_camera(open_device(choice, clock_).value(), {}, clock_);
    const auto started = camera->start();
    ASSERT_TRUE(started) << started.error().message;
    EXPECT_EQ(camera->calibration(), options.calibration);
    EXPECT_TRUE(simulator.lights_on());
    Frame frame;
    ASSERT_TRUE(eventually([&] { return camera->poll(frame); })) << camera->reason();
    EXPECT_EQ(frame.exposure_us, 200);
    EXPECT_EQ(frame.width * 1000 + frame.height, 640'240);
    // The hand is bright in both eyes, more to the right in the left one by f * baseline / distance = 59 px.
    const auto brightest_column = [&](int eye) {
      std::vector<int> sums(640, 0);
      const auto view = frame.view(eye);
      for (std::size_t i = 0; i < view.size(); ++i) sums[i % 640] += view[i];
      double weight = 0, at = 0;
      for (std::size_t x = 0; x < sums.size(); ++x)
        if (const double bright = sums[x] - sums[0]; bright > 2000)
          weight += bright, at += bright * static_cast<double>(x);
      return weight > 0 ? at / weight : -1000.0;
    };
    EXPECT_NEAR(brightest_column(0) - brightest_column(1), 59.0, 8.0);
    EXPECT_EQ(camera->counters().bad_transfers + camera->counters().dropped_frames, 0U);
    port.unplug();
    simulator.unplug();
    EXPECT_TRUE(eventually([&] { return camera->poll(frame), camera->state() == FrameSourceState::kLost; }));
  }
  EXPECT_TRUE(eventually([] { return !camera_on_the_bus(); }));
}

TEST_F(LabRigel, AController2IsListedWithTheOnlyWayToIt) {
  RigelSimulatorOptions options;
  options.product = 0x1206;
  RigelGadget gadget{RigelSimulator(options), options.product};
  UsbipPort port(gadget);
  const auto plugged = port.plug();
  ASSERT_TRUE(plugged) << plugged.error().message;
  ASSERT_TRUE(eventually([] { return camera_on_the_bus().has_value(); }));
  EXPECT_EQ(camera_on_the_bus()->state, DeviceState::kIgnored);
  DeviceSpec choice;
  choice.driver = "leap";
  const auto opened = open_device(choice, clock_).value()();
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("--input leapc"));
  port.unplug();
  EXPECT_TRUE(eventually([] { return !camera_on_the_bus(); }));
}

}  // namespace
}  // namespace dubsar::lab
