// Inputs from shared libraries: the example, and a plug-in that throws, blocks and floods.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "input/plugins/source_plugin.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;

Result<std::unique_ptr<InputSource>> make(const char* file, std::vector<Option> options) {
  InputConfig config;
  config.options = std::move(options);
  config.options.insert(config.options.begin(), Option{file});
  return make_plugin_source(config);
}

template <class Condition>
bool eventually(const Condition& condition) {
  const auto until = steady_clock::now() + std::chrono::seconds(20);
  while (steady_clock::now() < until) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

std::ptrdiff_t entries_of(const char* folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

TEST(SourcePlugin, TheExamplesHeadSwaysWhereItsCameraStands) {
  const auto source = make(DUBSAR_DEPTH_CAMERA, {{"at", "0/100/0"}, {"ipd", "64"}});
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->name(), "plugin:depth_camera");
  InputFrame frame;
  const SteadyClock clock;
  ASSERT_TRUE(eventually([&] { return (*source)->poll(clock.now(), frame) == Freshness::kNew; })) << (*source)->note();
  ASSERT_EQ(frame.heads.size(), 1U);
  const HeadFrame& head = frame.heads[0];
  EXPECT_TRUE(head.tracked);
  EXPECT_NEAR(head.right_eye_m->x - head.left_eye_m->x, 0.064, 1e-9);
  EXPECT_NEAR(head.left_eye_m->y, 0.1 - 0.05, 0.009);  // a pixel is 8.6 mm wide there
  EXPECT_NEAR(head.left_eye_m->z, 0.6, 1e-6);
  EXPECT_LE(std::abs(head.left_eye_m->x + 0.032), 0.16);
  EXPECT_EQ(make(DUBSAR_DEPTH_CAMERA, {{"ipd", "640"}}).error().kind, ErrorKind::kUsage);
}

TEST(SourcePlugin, WhatIsThrownIsALossWithItsReason) {
  for (const auto& [way, reason] :
       {std::pair{"throw_open", "it threw an exception"}, std::pair{"throw_read", "index 7 of 3"},
        std::pair{"absent", "no camera is plugged in"}, std::pair{"lost", "xxxx"}}) {
    const auto source = make(DUBSAR_UNRULY, {{way}});
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_TRUE(eventually([&, why = reason] { return (*source)->note().find(why) != std::string::npos; }))
        << (*source)->note();
    InputFrame frame;
    EXPECT_EQ((*source)->poll(SteadyClock().now(), frame), Freshness::kLost);
  }
  EXPECT_NE(make(DUBSAR_UNRULY, {{"throw_create"}}).error().message.find("no memory"), std::string::npos);
  EXPECT_NE(make(DUBSAR_UNRULY, {{"refuse"}}).error().message.find("does not want"), std::string::npos);
}

TEST(SourcePlugin, ABlockedOneIsLostAndNobodyWaitsForIt) {
  const auto threads = entries_of("/proc/self/task");
  auto source = make(DUBSAR_UNRULY, {{"block"}}).value();
  const SteadyClock clock;
  InputFrame frame;
  EXPECT_TRUE(eventually([&] { return source->poll(clock.now(), frame) == Freshness::kUnchanged; }));
  double longest_s = 0.0;
  EXPECT_TRUE(eventually([&] {
    const auto begun = steady_clock::now();
    const Freshness freshness = source->poll(clock.now(), frame);
    longest_s = std::max(longest_s, std::chrono::duration<double>(steady_clock::now() - begun).count());
    return freshness == Freshness::kLost;
  }));
  EXPECT_NE(source->note().find("not answered"), std::string::npos) << source->note();
  EXPECT_LT(longest_s, 0.5);
  const auto begun = steady_clock::now();
  source.reset();
  EXPECT_LT(std::chrono::duration<double>(steady_clock::now() - begun).count(), 4.0);
  // it comes back after 5 s and finds that it is not wanted: its thread ends, its library goes
  EXPECT_TRUE(eventually([&] { return entries_of("/proc/self/task") == threads; }));
}

TEST(SourcePlugin, AFloodIsBounded) {
  const auto source = make(DUBSAR_UNRULY, {{"flood"}}).value();
  const SteadyClock clock;
  InputFrame frame;
  ASSERT_TRUE(eventually([&] { return source->poll(clock.now(), frame) == Freshness::kNew; }));
  EXPECT_LE(frame.heads.size(), 16U);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  source->poll(clock.now(), frame);
  EXPECT_LE(frame.events.size(), 4096U);
  EXPECT_NE(source->note().find("more at once"), std::string::npos) << source->note();
}

TEST(SourcePlugin, WhatCannotBeIsRefusedAndTimesToComeAreNow) {
  for (const char* way : {"nan", "short"}) {
    const auto source = make(DUBSAR_UNRULY, {{way}}).value();
    InputFrame frame;
    ASSERT_TRUE(eventually([&] { return source->poll(SteadyClock().now(), frame) == Freshness::kNew; }));
    EXPECT_TRUE(frame.heads.empty());
    EXPECT_NE(source->note().find("cannot be"), std::string::npos) << source->note();
  }
  const auto source = make(DUBSAR_UNRULY, {{"future"}}).value();
  InputFrame frame;
  ASSERT_TRUE(eventually([&] { return source->poll(SteadyClock().now(), frame) == Freshness::kNew; }));
  EXPECT_LE(frame.time, SteadyClock().now());
}

TEST(SourcePlugin, AThousandLoadsAndUnloadsOfWhateverBehavesBadlyLeaveNothingBehind) {
  const auto maps = [] {
    std::ifstream file("/proc/self/maps");
    return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
  };
  const SteadyClock clock;
  constexpr std::array kWays{"", "flood", "throw_read", "throw_open", "lost", "absent", "nan", "short", "future"};
  const auto load = [&](int i) {
    const char* const way = i % 25 == 24 ? "stall" : kWays[static_cast<std::size_t>(i) % kWays.size()];
    const bool camera = i % 2 == 0 && *way == '\0';
    auto source = make(camera ? DUBSAR_DEPTH_CAMERA : DUBSAR_UNRULY,
                       *way == '\0' ? std::vector<Option>{} : std::vector<Option>{{way}});
    ASSERT_TRUE(source) << source.error().message;
    if (i % 3 == 0) return;  // unloaded before, while or after it opens
    InputFrame frame;
    EXPECT_TRUE(eventually([&] {
      return (*source)->poll(clock.now(), frame) == Freshness::kNew ||
             (*source)->note().find("not opened yet") == std::string::npos;
    })) << way;
    EXPECT_LE(frame.events.size(), 4096U);
  };
  for (int i = 0; i < 50; ++i) load(i);
  const auto descriptors = entries_of("/proc/self/fd"), threads = entries_of("/proc/self/task");
  const auto before = maps();
  for (int i = 0; i < 1000; ++i) load(i);
  EXPECT_EQ(entries_of("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries_of("/proc/self/task"), threads);
  EXPECT_LE(maps(), before + 8);  // the allocator's own
  std::ifstream file("/proc/self/maps");
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(all.find("depth_camera"), std::string::npos);
  EXPECT_EQ(all.find("unruly"), std::string::npos);
}

TEST(SourcePlugin, FilesThatAreNoPluginSayWhy) {
  EXPECT_EQ(make("/no/such/file.so", {}).error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(make("/etc/passwd", {}).error().kind, ErrorKind::kUnavailable);
  EXPECT_EQ(make_plugin_source({}).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
