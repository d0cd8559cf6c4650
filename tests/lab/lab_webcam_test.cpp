// A webcam of a real kernel (vivid): its pictures through unmodified OpenCV, as the program loads it.

#include <array>
#include <fstream>

#include "devices/camera/webcam.h"
#include "tests/lab/lab_kernel.h"

namespace dubsar::lab {
namespace {

/// Takes the kernel's driver from the simulated webcam, or gives it back: its node goes and comes.
bool set_plugged(bool plugged) {
  std::ofstream file(plugged ? "/sys/bus/platform/drivers/vivid/bind" : "/sys/bus/platform/drivers/vivid/unbind");
  file << "vivid.0" << std::flush;
  return file.good();
}

class LabCamera : public Lab {
 protected:
  Result<std::unique_ptr<FrameSource>> make() {
    DUBSAR_ASSIGN(const OpenCapture open, load_capture());
    return make_camera({}, open, clock_);
  }
  bool next_frame(FrameSource& camera, Frame& frame) {
    return eventually([&] { return camera.poll(frame); });
  }
};

TEST_F(LabCamera, TheWebcamsColoursArriveAndItComesBack) {
  const auto cameras = list_cameras();
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0].driver, "webcam");
  EXPECT_EQ(cameras[0].name, "vivid");
  EXPECT_EQ(cameras[0].state, DeviceState::kUsable);

  auto made = make();
  ASSERT_TRUE(made) << made.error().message;
  FrameSource& camera = **made;
  Frame frame;
  int descriptors = 0;
  for (int plugging = 0; plugging < 2; ++plugging) {
    const auto started = camera.start();
    ASSERT_TRUE(started) << started.error().message;
    ASSERT_TRUE(next_frame(camera, frame)) << camera.reason();
    if (plugging > 0) {
      const double after_s = seconds_since_made(cameras[0].path);
      std::printf("first picture %.0f ms after the node\n", 1e3 * after_s);
      EXPECT_LT(after_s, 1.0);
    }
    std::uint64_t sequence = 0;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(next_frame(camera, frame)) << camera.reason();
      EXPECT_GT(frame.sequence, sequence);
      sequence = frame.sequence;
    }
    ASSERT_EQ(frame.width, 640);
    ASSERT_EQ(frame.height, 480);
    ASSERT_EQ(frame.format, PixelFormat::kRgb8);
    // colour bars of 75 %: white, yellow, cyan, green, magenta, red, blue, black
    constexpr std::array<unsigned, 8> kBars{7, 6, 3, 2, 5, 4, 1, 0};  // bits: red, green, blue
    for (int bar = 0; bar < 8; ++bar) {
      const std::uint8_t* const pixel = frame.pixels.data() + 3 * (400 * frame.width + 40 + 80 * bar);
      for (unsigned channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(pixel[channel], (kBars[static_cast<std::size_t>(bar)] & 4U >> channel) != 0 ? 191 : 0, 25)
            << "bar " << bar << ", channel " << channel;
    }

    ASSERT_TRUE(set_plugged(false));
    EXPECT_TRUE(eventually([&] { return camera.state() == FrameSourceState::kLost; }, milliseconds(2000)));
    EXPECT_TRUE(list_cameras().empty());
    EXPECT_EQ(camera.start().error().kind, ErrorKind::kUnavailable);
    if (plugging == 0)
      descriptors = open_descriptors();  // the first time libraries keep some open
    else
      EXPECT_EQ(open_descriptors(), descriptors);
    ASSERT_TRUE(set_plugged(true));
  }
}

TEST_F(LabCamera, ToAnotherUserItSaysThatPermissionIsMissingAndWhatToDo) {
  const std::string told = as_nobody([] {
    const auto cameras = list_cameras();
    if (cameras.size() != 1) return fmt::format("{} cameras", cameras.size());
    return fmt::format("{}; {}; {}", device_state_name(cameras[0].state), cameras[0].reason, cameras[0].remedy);
  });
  EXPECT_EQ(told, "no permission; this user may not open /dev/video0; usermod -aG video $USER and log in again");
}

}  // namespace
}  // namespace dubsar::lab
