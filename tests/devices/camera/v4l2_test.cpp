// OpenCV's unmodified Video4Linux code against a simulated kernel node. Run with libumockdev-preload.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <thread>

#include "devices/camera/opencv_capture.h"
#include "devices/camera/webcam.h"
#include "tests/core/image_io/jpeg_picture.h"
#include "tests/devices/camera/v4l2_testbed.h"

namespace dubsar {
namespace {

V4l2Testbed::Picture jpeg_picture() { return {V4L2_PIX_FMT_MJPEG, 24, 16, test_jpeg()}; }

V4l2Testbed::Picture yuyv_picture(std::uint8_t luma) {
  V4l2Testbed::Picture picture{V4L2_PIX_FMT_YUYV, 64, 48, std::vector<std::byte>(64 * 48 * 2, std::byte{128})};
  for (std::size_t i = 0; i < picture.bytes.size(); i += 2) picture.bytes[i] = static_cast<std::byte>(luma);
  return picture;
}

class V4l2 : public testing::Test {
 protected:
  void SetUp() override {
    testbed_ = std::make_unique<V4l2Testbed>();
    if (!umockdev_in_mock_environment()) GTEST_SKIP() << "run it under umockdev-wrapper (ctest does the same)";
    camera_ = make_camera({}, open_opencv_capture, clock_);
  }
  bool next_frame() {
    const TimestampNs end = clock_.now() + 10'000'000'000;
    while (clock_.now() < end && camera_->state() == FrameSourceState::kRunning) {
      if (camera_->poll(frame_)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  std::array<int, 3> pixel(int x, int y) const {
    const std::uint8_t* at = frame_.pixels.data() + 3 * (y * frame_.width + x);
    return {at[0], at[1], at[2]};
  }
  SteadyClock clock_;
  std::unique_ptr<V4l2Testbed> testbed_;
  std::unique_ptr<FrameSource> camera_;
  Frame frame_;
};

TEST_F(V4l2, CamerasAreListedAndMetadataNodesAreNot) {
  EXPECT_TRUE(list_cameras().empty());
  testbed_->plug_metadata_node(8);
  EXPECT_TRUE(list_cameras().empty());
  testbed_->unplug();
  testbed_->plug(7, jpeg_picture());
  const auto cameras = list_cameras();
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0].driver, "webcam");
  EXPECT_EQ(cameras[0].path, "/dev/video7");
  EXPECT_EQ(cameras[0].name, "Simulated Webcam");
  EXPECT_EQ(cameras[0].state, DeviceState::kUsable);
}

TEST_F(V4l2, CompressedPicturesAreAskedForAndArriveInColour) {
  testbed_->plug(7, jpeg_picture());
  const auto started = camera_->start();
  ASSERT_TRUE(started) << started.error().message;
  TimestampNs before = 0;
  std::uint64_t sequence = 0;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(next_frame()) << camera_->reason();
    EXPECT_GT(frame_.time, before);
    EXPECT_GT(frame_.sequence, sequence);
    before = frame_.time;
    sequence = frame_.sequence;
    ASSERT_EQ(frame_.width, 24);
    ASSERT_EQ(frame_.height, 16);
    ASSERT_EQ(frame_.format, PixelFormat::kRgb8);
    ASSERT_EQ(frame_.pixels.size(), 24U * 16 * 3);
    for (const auto& [x, expected] : {std::pair{5, std::array{200, 60, 30}}, std::pair{20, std::array{20, 180, 220}}})
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(x, 8)[c], expected[c], 6);
  }
  const auto asked = testbed_->formats_asked_for();
  EXPECT_NE(std::find(asked.begin(), asked.end(), V4L2_PIX_FMT_MJPEG), asked.end());
}

TEST_F(V4l2, ACameraWithoutCompressionWorksToo) {
  testbed_->plug(0, yuyv_picture(126));
  ASSERT_TRUE(camera_->start());
  ASSERT_TRUE(next_frame()) << camera_->reason();
  EXPECT_EQ(frame_.width, 64);
  for (const int level : pixel(30, 20)) EXPECT_NEAR(level, (126 - 16) * 255 / 219, 2);
}

TEST_F(V4l2, AnUnpluggedCameraIsLostAndItsReplacementIsFound) {
  for (int cycle = 0; cycle < 3; ++cycle) {
    testbed_->plug(cycle, jpeg_picture());
    ASSERT_TRUE(camera_->start());
    ASSERT_TRUE(next_frame());
    testbed_->unplug();
    EXPECT_FALSE(next_frame() && next_frame() && next_frame());
    EXPECT_EQ(camera_->state(), FrameSourceState::kLost);
    EXPECT_NE(camera_->reason().find("unplugged"), std::string::npos) << camera_->reason();
    EXPECT_EQ(camera_->start().error().kind, ErrorKind::kUnavailable);
  }
}

TEST_F(V4l2, AMissingNodeIsUnavailable) {
  EXPECT_EQ(open_opencv_capture("/dev/video9", {}).error().kind, ErrorKind::kUnavailable);
}

}  // namespace
}  // namespace dubsar
