// Work beside a window: how far it is, how it ends, and that what is left is heard of no more.

#include "app/session/background_job.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace dubsar::app {
namespace {

TEST(BackgroundJob, SaysHowFarItIsAndHowItEndedOnce) {
  BackgroundJob job;
  EXPECT_FALSE(job.take());
  EXPECT_FALSE(job.stop());
  std::atomic<bool> go{false}, half{false};
  job.begin("a thing", [&](Progress& progress) -> Result<void> {
    progress.begin("stage", 4, "step");
    progress.advance(2);
    half = true;
    while (!go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {};
  });
  while (!half) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(job.state());
  EXPECT_EQ(*job.state(), (JobState{"a thing", 0.5}));
  EXPECT_FALSE(job.take()) << "it works";
  go = true;
  job.wait();
  const auto ended = job.take();
  ASSERT_TRUE(ended);
  EXPECT_TRUE(*ended);
  EXPECT_FALSE(job.take());
  EXPECT_FALSE(job.state());
}

TEST(BackgroundJob, WhatIsStoppedOrThrowsEndsNothingElse) {
  BackgroundJob job;
  std::atomic<int> noticed{0};
  const auto until_cancelled = [&](Progress& progress) -> Result<void> {
    while (!progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++noticed;
    return cancelled_error();
  };
  job.begin("first", until_cancelled);
  job.begin("second", until_cancelled);  // leaves the first
  EXPECT_TRUE(job.stop());
  EXPECT_FALSE(job.take());
  job.begin("third", [](Progress&) -> Result<void> { throw std::runtime_error("oh"); });
  job.wait();
  const auto ended = job.take();
  ASSERT_TRUE(ended);
  ASSERT_FALSE(*ended);
  EXPECT_NE(ended->error().message.find("third"), std::string::npos);
  while (noticed < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace
}  // namespace dubsar::app
