// The reader thread over a capture that the test plays.

#include "devices/camera/webcam.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace dubsar {
namespace {

/// Delivers pictures whose first level counts them; then does what `last` says.
class PlayedCapture final : public Capture {
 public:
  PlayedCapture(int pictures, bool silent_then) : left_(pictures), silent_(silent_then) {}
  Result<bool> read(std::vector<std::uint8_t>& rgb, int& width, int& height) override {
    if (left_ == 0) {
      if (silent_) return false;
      return fail(ErrorKind::kUnavailable, "unplugged");
    }
    --left_;
    width = 4;
    height = 2;
    rgb.assign(24, ++level_);
    return true;
  }

 private:
  int left_;
  bool silent_;
  std::uint8_t level_ = 0;
};

template <class Condition>
bool eventually(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

WebcamOptions at(const char* path) {
  WebcamOptions options;
  options.path = path;
  return options;
}

TEST(Camera, TheNewestPictureWinsAndALostCameraIsAState) {
  const SteadyClock clock;
  auto camera = make_camera(
      at("x"),
      [](const std::string&, const CaptureFormat&) -> Result<std::unique_ptr<Capture>> {
        return std::make_unique<PlayedCapture>(50, false);
      },
      clock);
  Frame frame;
  EXPECT_EQ(camera->state(), FrameSourceState::kStopped);
  for (std::uint64_t round = 1; round <= 2; ++round) {
    ASSERT_TRUE(camera->start());
    ASSERT_TRUE(eventually([&] { return camera->state() == FrameSourceState::kLost; }));
    EXPECT_EQ(camera->reason(), "unplugged");
    ASSERT_TRUE(camera->poll(frame));
    EXPECT_EQ(frame.sequence, 50 * round) << "numbers go on after a replug";
    EXPECT_EQ(frame.pixels[0], 50);
    EXPECT_EQ(frame.pixels.size(), frame.view_bytes());
    EXPECT_FALSE(camera->poll(frame));
  }
}

TEST(Camera, ASilentCameraIsLostAfterThreePatientReads) {
  const SteadyClock clock;
  auto camera = make_camera(
      at("x"),
      [](const std::string&, const CaptureFormat&) -> Result<std::unique_ptr<Capture>> {
        return std::make_unique<PlayedCapture>(1, true);
      },
      clock);
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(eventually([&] { return camera->state() == FrameSourceState::kLost; }));
  EXPECT_NE(camera->reason().find("three seconds"), std::string::npos);
}

TEST(Camera, AThousandStartsAndStopsLeaveNothingRunning) {
  const SteadyClock clock;
  static std::atomic<int> open{0};
  struct Counted final : Capture {
    Counted() { ++open; }
    ~Counted() override { --open; }
    Result<bool> read(std::vector<std::uint8_t>& rgb, int& width, int& height) override {
      rgb.assign(3, 1);
      width = height = 1;
      return true;
    }
  };
  auto camera = make_camera(
      at("x"),
      [](const std::string&, const CaptureFormat&) -> Result<std::unique_ptr<Capture>> {
        return std::make_unique<Counted>();
      },
      clock);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(camera->start());
    ASSERT_EQ(open, 1);
    if (i % 2 == 0) camera->stop();
  }
  camera.reset();
  EXPECT_EQ(open, 0);
}

TEST(Camera, WhatTheOpenerSaysIsPassedOn) {
  const SteadyClock clock;
  auto camera = make_camera(
      at("/dev/video3"),
      [](const std::string& path, const CaptureFormat& format) -> Result<std::unique_ptr<Capture>> {
        return fail(ErrorKind::kPermission, "{} {}", path, format.width);
      },
      clock);
  const auto started = camera->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kPermission);
  EXPECT_EQ(started.error().message, "/dev/video3 640");
}

}  // namespace
}  // namespace dubsar
