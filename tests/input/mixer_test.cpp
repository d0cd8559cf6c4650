#include "input/mixer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "input/window_events.h"
#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {

using test::kMs;

/// Says what the test told it to.
struct Told final : InputSource {
  InputFrame frame;
  Freshness freshness = Freshness::kNew;
  std::string label;
  explicit Told(std::string n) : label(std::move(n)) {}
  std::string_view name() const noexcept override { return label; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs, InputFrame& newest) noexcept override {
    newest = frame;
    return freshness;
  }
};

HandFrame hand(std::uint32_t id) {
  HandFrame out;
  out.id = id;
  out.valid = out.tracked = true;
  return out;
}

struct TwoTrackers {
  InputMixer mixer;
  Told* first = nullptr;
  Told* second = nullptr;
  TwoTrackers() {
    auto a = std::make_unique<Told>("leap"), b = std::make_unique<Told>("webcam");
    first = a.get();
    second = b.get();
    mixer.add(std::move(a));
    mixer.add(std::move(b));
  }
};

TEST(Mixer, HandsComeFromTheFirstSourceThatSeesAnyAndAreNeverMixed) {
  TwoTrackers t;
  t.second->frame.hands = {hand(20), hand(21)};
  EXPECT_EQ(t.mixer.poll(0).hands.size(), 2u);
  t.first->frame.hands = {hand(10)};
  const InputFrame& frame = t.mixer.poll(10 * kMs);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(frame.hands[0].id, 10u);
}

TEST(Mixer, AShortDropoutDoesNotHandOverToTheOtherTracker) {
  TwoTrackers t;
  t.first->frame.hands = {hand(10)};
  t.second->frame.hands = {hand(20)};
  (void)t.mixer.poll(0);
  t.first->frame.hands.clear();
  EXPECT_TRUE(t.mixer.poll(299 * kMs).hands.empty());
  ASSERT_EQ(t.mixer.poll(300 * kMs).hands.size(), 1u);
  EXPECT_EQ(t.mixer.poll(300 * kMs).hands[0].id, 20u);
}

TEST(Mixer, ALostSourceContributesNothingButItsLastEvents) {
  TwoTrackers t;
  t.first->frame.hands = {hand(10)};
  t.first->freshness = Freshness::kLost;
  t.second->frame.hands = {hand(20)};
  EXPECT_EQ(t.mixer.poll(0).hands[0].id, 20u);
  EXPECT_EQ(t.mixer.states()[0].freshness, Freshness::kLost);
}

TEST(Mixer, EventsOfAllSourcesComeInOrderOfTime) {
  TwoTrackers t;
  t.first->frame.events = {{5, EventKind::kKey, {}, {}, true, 0, "a"}, {9, EventKind::kKey, {}, {}, true, 0, "b"}};
  t.second->frame.events = {{7, EventKind::kKey, {}, {}, true, 0, "c"}};
  const InputFrame& frame = t.mixer.poll(10);
  ASSERT_EQ(frame.events.size(), 3u);
  EXPECT_EQ(frame.events[1].key, "c");
}

TEST(Mixer, SourcesCanBeTakenOutWhileItRuns) {
  TwoTrackers t;
  t.first->frame.hands = {hand(10)};
  t.second->frame.hands = {hand(20)};
  (void)t.mixer.poll(0);
  const Told* const leap = t.first;
  EXPECT_TRUE(t.mixer.remove(leap));
  EXPECT_FALSE(t.mixer.remove(leap));
  EXPECT_EQ(t.mixer.poll(10 * kMs).hands[0].id, 20u);
}

/// Ends only after somebody else has polled.
struct Slow final : InputSource {
  InputMixer& mixer;
  bool& polled;
  Slow(InputMixer& of, bool& meanwhile) : mixer(of), polled(meanwhile) {}
  ~Slow() override {
    auto other = std::make_shared<std::promise<void>>();
    std::future<void> done = other->get_future();
    std::thread([this, other] {
      (void)mixer.poll(20 * kMs);
      other->set_value();
    }).detach();
    polled = done.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  }
  std::string_view name() const noexcept override { return "slow"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs, InputFrame&) noexcept override { return Freshness::kNew; }
};

TEST(Mixer, NobodyWaitsForASourceThatEndsSlowly) {
  static InputMixer mixer;  // of the thread, if it is late
  bool polled = false;
  auto slow = std::make_unique<Slow>(mixer, polled);
  const InputSource* const source = slow.get();
  mixer.add(std::move(slow));
  EXPECT_TRUE(mixer.remove(source));
  EXPECT_TRUE(polled) << "poll() stood still until the source had ended";
}

TEST(WindowEvents, MotionsAreJoinedAndNothingElseIsLost) {
  WindowEvents window;
  InputConfig config;
  config.window = &window;
  const auto mouse = make_input("mouse", config).value(), keyboard = make_input("keyboard", config).value();
  for (int i = 0; i < 100000; ++i) window.push({i, EventKind::kMotion, {1, -1}, {}, false, 0, {}});
  window.push({100000, EventKind::kButton, {}, MouseButton::kRight, true, 0, {}});
  window.push({100001, EventKind::kKey, {}, {}, true, 0, "home"});
  InputFrame frame;
  EXPECT_EQ(mouse->poll(0, frame), Freshness::kNew);
  ASSERT_EQ(frame.events.size(), 2u);
  EXPECT_EQ(frame.events[0].motion, glm::dvec2(100000, -100000));
  EXPECT_EQ(mouse->poll(0, frame), Freshness::kUnchanged);
  EXPECT_EQ(keyboard->poll(0, frame), Freshness::kNew);
  EXPECT_EQ(frame.events[0].key, "home");
}

TEST(WindowEvents, AFullQueueKeepsEveryRelease) {
  WindowEvents window;
  InputConfig config;
  config.window = &window;
  const auto mouse = make_input("mouse", config).value(), keyboard = make_input("keyboard", config).value();
  for (int i = 0; i < 20000; ++i) {  // motions that cannot be joined, then nothing but presses and repeats
    window.push({i, EventKind::kMotion, {1, 0}, {}, false, static_cast<std::uint8_t>(i % 2), {}});
    window.push({i, EventKind::kKey, {}, {}, true, 0, "left", i % 3 != 0});
    if (i == 100) window.push({i, EventKind::kButton, {}, MouseButton::kLeft, false, 0, {}});
    if (i == 100) window.push({i, EventKind::kKey, {}, {}, false, 0, "shift"});
  }
  for (int i = 0; i < 20000; ++i) window.push({i, EventKind::kWheel, {0, 1}, {}, false, 0, {}});
  InputFrame frame;
  mouse->poll(0, frame);
  EXPECT_LE(frame.events.size(), 4096u);
  EXPECT_EQ(std::count_if(frame.events.begin(), frame.events.end(),
                          [](const InputEvent& e) { return e.kind == EventKind::kButton && !e.down; }),
            1);
  keyboard->poll(0, frame);
  EXPECT_LE(frame.events.size(), 4096u);
  EXPECT_EQ(std::count_if(frame.events.begin(), frame.events.end(), [](const InputEvent& e) { return !e.down; }), 1);
}

TEST(WindowEvents, ArePutInByOneThreadAndTakenOutThroughTheMixerByAnother) {
  WindowEvents window;
  InputConfig config;
  config.window = &window;
  InputMixer mixer;
  mixer.add(make_mouse_source(config).value());
  double moved = 0;
  std::atomic<bool> done = false;
  std::jthread polls([&] {
    for (TimestampNs now = 0; !done; ++now)
      for (const InputEvent& event : mixer.poll(now).events) moved += event.motion.x;
  });
  for (int i = 0; i < 20000; ++i) {
    window.push({i, EventKind::kMotion, {1, 0}, {}, false, 0, {}});
    ASSERT_TRUE(mixer.endless());
  }
  done = true;
  polls.join();
  for (const InputEvent& event : mixer.poll(0).events) moved += event.motion.x;
  EXPECT_DOUBLE_EQ(moved, 20000);
}

TEST(InputSources, WhatCannotBeMadeIsSaid) {
  const auto unknown = make_input("kinect");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_NE(unknown.error().message.find("mouse, keyboard"), std::string::npos);
  EXPECT_EQ(make_input("mouse").error().kind, ErrorKind::kUnavailable);
  EXPECT_EQ(make_input("scripted").error().kind, ErrorKind::kUsage);
  EXPECT_EQ(make_input("scripted:/nowhere.json").error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(make_input("replay:a,b").error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
