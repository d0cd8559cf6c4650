#include "devices/camera/picture_frames.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/files/atomic_file.h"
#include "core/image_io/png_file.h"
#include "tests/core/image_io/jpeg_picture.h"

namespace dubsar {
namespace {

constexpr TimestampNs kMs = 1'000'000;

class PictureFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("pictures_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, std::uint8_t level) {
    Image image(6, 4, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), level);
    ASSERT_TRUE(write_png(folder_ / name, image));
  }
  std::filesystem::path folder_;
  ManualClock clock_{5'000 * kMs};
  Frame frame_;
};

TEST_F(PictureFolder, PicturesComeInTheOrderOfTheirNamesAtTheRateAsked) {
  write("b.png", 20);
  write("a.png", 10);
  write("c.png", 30);
  const auto source = make_picture_frames(folder_, 10.0, clock_);
  ASSERT_TRUE(source->start());
  ASSERT_TRUE(source->poll(frame_));
  EXPECT_EQ(frame_.pixels[0], 10);
  EXPECT_EQ(frame_.time, 5'000 * kMs);
  EXPECT_EQ(frame_.width, 6);
  clock_.advance(99 * kMs);
  EXPECT_FALSE(source->poll(frame_));
  clock_.advance(kMs);
  ASSERT_TRUE(source->poll(frame_));
  EXPECT_EQ(frame_.pixels[0], 20);
  EXPECT_FALSE(source->finished());
  clock_.advance(500 * kMs);
  ASSERT_TRUE(source->poll(frame_));
  EXPECT_EQ(frame_.pixels[0], 30);
  EXPECT_EQ(frame_.time, 5'200 * kMs);
  EXPECT_EQ(frame_.sequence, 3U);
  EXPECT_TRUE(source->finished());
  EXPECT_EQ(source->state(), FrameSourceState::kStopped);
  EXPECT_FALSE(source->poll(frame_));
}

TEST_F(PictureFolder, LateReadersGetTheNewestPictureOnly) {
  for (int i = 0; i < 9; ++i) write(std::string(1, static_cast<char>('a' + i)) + ".png", static_cast<std::uint8_t>(i));
  const auto source = make_picture_frames(folder_, 100.0, clock_);
  ASSERT_TRUE(source->start());
  clock_.advance(55 * kMs);
  ASSERT_TRUE(source->poll(frame_));
  EXPECT_EQ(frame_.pixels[0], 5);
  EXPECT_FALSE(source->poll(frame_));
}

TEST_F(PictureFolder, WhatTheRecorderWritesIsPlayedAtTheTimesItWasTaken) {
  FrameRecorder recorder(folder_);
  const TimestampNs times[] = {700 * kMs, 733 * kMs, 900 * kMs};
  for (int i = 0; i < 3; ++i) {
    Frame frame;
    frame.time = times[i];
    frame.width = 5;
    frame.height = 3;
    frame.format = PixelFormat::kRgb8;
    frame.pixels.resize(45);
    for (std::size_t k = 0; k < 45; ++k)
      frame.pixels[k] = static_cast<std::uint8_t>(k + 50 * static_cast<std::size_t>(i));
    ASSERT_TRUE(recorder.write(frame));
  }
  const auto source = make_picture_frames(folder_, 30.0, clock_);
  ASSERT_TRUE(source->start());
  for (int i = 0; i < 3; ++i) {
    clock_.set(5'000 * kMs + times[i] - times[0] - (i > 0 ? 1 : 0));
    if (i > 0) {
      EXPECT_FALSE(source->poll(frame_));
      clock_.advance(1);
    }
    ASSERT_TRUE(source->poll(frame_));
    EXPECT_EQ(frame_.time - 5'000 * kMs, times[i] - times[0]);
    for (std::size_t k = 0; k < 45; ++k) ASSERT_EQ(frame_.pixels[k], k + 50 * static_cast<std::size_t>(i));
  }
}

TEST_F(PictureFolder, PhotographsAreReadAndDamagedOnesSaySo) {
  const auto jpeg = test_jpeg();
  ASSERT_TRUE(write_file_atomically(folder_ / "a.jpg", std::span<const std::byte>(jpeg)));
  ASSERT_TRUE(write_file_atomically(folder_ / "b.jpg", std::span<const std::byte>(jpeg).first(200)));
  const auto source = make_picture_frames(folder_, 10.0, clock_);
  ASSERT_TRUE(source->start());
  ASSERT_TRUE(source->poll(frame_));
  EXPECT_EQ(frame_.width, 24);
  clock_.advance(100 * kMs);
  EXPECT_FALSE(source->poll(frame_));
  EXPECT_EQ(source->state(), FrameSourceState::kLost);
  EXPECT_NE(source->reason().find("b.jpg"), std::string::npos);
}

TEST_F(PictureFolder, AFolderWithoutPicturesIsNoInput) {
  EXPECT_EQ(make_picture_frames(folder_, 10.0, clock_)->start().error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(make_picture_frames(folder_ / "nowhere", 10.0, clock_)->start().error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace dubsar
