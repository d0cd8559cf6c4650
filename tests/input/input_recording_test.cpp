#include "input/input_recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "input/mixer.h"
#include "input/navigation/navigation.h"
#include "input/people/person_keeper.h"
#include "input/simulated/scripted_source.h"
#include "tests/input/recorded_frames.h"

namespace dubsar {
namespace {

Script busy_script() {
  Script script;
  script.duration_s = 12;
  script.noise_m = 0.001;
  script.visitor = VisitorGoal{25, -10, 1.0, 11};
  script.bystanders = 1;
  return script;
}

struct Session {
  std::string recording;
  ViewState view;
};

Session run(InputMixer& mixer, ViewState& seen, TimestampNs start) {
  Session out;
  Navigator navigator(default_mapping().value());
  PersonKeeper people;
  for (TimestampNs now = start; now < start + 12'000'000'000; now += 16'000'000) {
    const InputFrame& frame = mixer.poll(now);
    out.recording += record_line({now, frame}) + "\n";
    navigator.update(now, frame, people.update(now, frame).hands);
    seen = navigator.view();
  }
  out.view = seen;
  return out;
}

TEST(Recording, AReplayedSessionEndsInTheSameView) {
  ViewState seen;
  InputMixer live;
  live.add(play_script(busy_script(), [&] { return seen; }).value());
  const Session original = run(live, seen, 1'000'000'000);
  ASSERT_GT(turn_between_deg(original.view.rotation, {1, 0, 0, 0}), 5.0);
  InputMixer replayed;
  replayed.add(replay_of(frames_of(original.recording, "test").value()));
  ViewState unused;
  const Session again = run(replayed, unused, 77'000'000'000);  // another day
  EXPECT_LT(turn_between_deg(original.view.rotation, again.view.rotation), 0.01);
  EXPECT_NEAR(original.view.zoom, again.view.zoom, 1e-4);
}

TEST(Recording, ATabletThatWasHeldIsWhereItWasLeft) {
  const auto held = [](TimestampNs now) {  // closes on it at 1 s, carries and turns it, opens at 2 s
    const double t = 1e-9 * static_cast<double>(now), way = std::clamp(t - 1.0, 0.0, 1.0);
    InputFrame frame;
    frame.time = now;
    frame.grips[1] = {true,
                      t >= 1.0 && t < 2.0,
                      true,
                      {{0.03 + 0.12 * way, 0.05 * way, 0.02}, glm::angleAxis(way, glm::dvec3(0, 0.6, 0.8))}};
    return frame;
  };
  Navigator navigator(default_mapping().value());
  std::string recording;
  for (TimestampNs now = 0; now < 3'000'000'000; now += 11'000'000) {
    const InputFrame frame = held(now);
    navigator.update(now, frame, {});
    recording += record_line({now, frame}) + "\n";
  }
  ASSERT_GT(turn_between_deg(navigator.view().rotation, {1, 0, 0, 0}), 50.0);
  InputMixer replayed;
  replayed.add(replay_of(frames_of(recording, "test").value()));
  Navigator again(default_mapping().value());
  for (TimestampNs now = 0; now < 3'200'000'000; now += 11'000'000) again.update(now, replayed.poll(now), {});
  EXPECT_LT(turn_between_deg(navigator.view().rotation, again.view().rotation), 1e-3);
  EXPECT_NEAR(glm::distance(navigator.view().pan, again.view().pan), 0.0, 1e-5);
  EXPECT_NEAR(navigator.view().nearer, again.view().nearer, 1e-5);
}

TEST(Recording, EverythingInAFrameSurvives) {
  RecordedFrame frame{500, {}};
  frame.frame.time = 400;
  frame.frame.events = {{300, EventKind::kWheel, {0.5, -2}, {}, false, kShift | kAlt, {}},
                        {310, EventKind::kButton, {}, MouseButton::kMiddle, true, kControl, {}},
                        {320, EventKind::kKey, {}, {}, true, 0, "page_up", true},
                        {330, EventKind::kMotion, {3, 4}, {}, false, 0, {}, false, glm::dvec2(-0.25, 0.5)},
                        {340, EventKind::kPinch, {}, {}, true, 0, {}, false, glm::dvec2(0.1, 0.2)}};
  frame.frame.events[4].pinch = {{0.01, -0.02}, 1.25, -0.5};
  frame.frame.events[4].touched = true;
  frame.frame.space_mouse = SpaceMouseMotion{399, {0.1, -0.2, 0.3}, {1, 0, -1}};
  HandFrame hand;
  hand.time = 398;
  hand.id = 4'000'000'000u;
  hand.chirality = Chirality::kLeft;
  hand.valid = true;
  hand.palm = {{0.1, 0.2, 0.3}, glm::angleAxis(0.5, glm::dvec3(0, 0, 1))};
  hand.grab_strength = 0.25;
  hand.pinch_distance_m = 0.031;
  hand.joint(HandJoint::kLittleTip) = {{{1, 2, 3}, {1, 0, 0, 0}}, 0.007, true, false};
  frame.frame.hands = {hand};
  HeadFrame head;
  head.time = 397;
  head.tracked = true;
  head.right_eye_m = glm::dvec3(0.03, 0.01, 0.6);
  frame.frame.heads = {head};
  frame.frame.grips[1] = {true, true, false, {{0.25, -0.5, 0.125}, glm::angleAxis(1.5, glm::dvec3(0, 1, 0))}};
  const std::string line = record_line(frame);
  const auto back = frames_of(line, "test").value();
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(record_line(back[0]), line);
  EXPECT_EQ(back[0].frame.hands[0].id, 4'000'000'000u);
  EXPECT_TRUE(back[0].frame.grips[1].closed && !back[0].frame.grips[0].active);
  EXPECT_FALSE(back[0].frame.hands[0].tracked);
  EXPECT_TRUE(back[0].frame.hands[0].joint(HandJoint::kLittleTip).valid);
  EXPECT_FALSE(back[0].frame.hands[0].joint(HandJoint::kIndexTip).valid);
  EXPECT_FALSE(back[0].frame.heads[0].left_eye_m);
  EXPECT_EQ(back[0].frame.events[1].button, MouseButton::kMiddle);
  EXPECT_TRUE(back[0].frame.events[2].repeat);
  EXPECT_EQ(back[0].frame.events[3].at, glm::dvec2(-0.25, 0.5));
  EXPECT_EQ(back[0].frame.events[4].pinch.by, glm::dvec2(0.01, -0.02));
  EXPECT_EQ(back[0].frame.events[4].pinch.factor, 1.25);
  EXPECT_EQ(back[0].frame.events[4].pinch.roll_rad, -0.5);
  EXPECT_TRUE(back[0].frame.events[4].touched && back[0].frame.events[4].down);
  EXPECT_FALSE(back[0].frame.events[3].touched);
}

TEST(Recording, ALastLineThatIsNotWholeIsLeftOutAndNothingElseIs) {
  RecordedFrame frame{500, {}};
  HandFrame hand;
  hand.joint(HandJoint::kPalm).valid = true;
  frame.frame.hands = {hand};
  const std::string line = record_line(frame), before = record_line({400, {}}) + "\n";
  for (std::size_t n = 1; n < line.size(); ++n) {
    RecordingReader reader = RecordingReader::over(before + line.substr(0, n), "cut");
    EXPECT_EQ(reader.next().value().value().polled, 400) << n;
    EXPECT_FALSE(reader.next().value()) << n;
    EXPECT_TRUE(reader.cut_off()) << n;
    EXPECT_FALSE(frames_of(before + line.substr(0, n) + "\n", "cut")) << n;  // a broken line is none
  }
  RecordingReader whole = RecordingReader::over(before + line, "whole");  // a line feed is not what makes it whole
  EXPECT_TRUE(whole.next().value());
  EXPECT_EQ(whole.next().value().value().frame.hands.size(), 1u);
  EXPECT_FALSE(whole.next().value());
  EXPECT_FALSE(whole.cut_off());
}

TEST(Recording, ABrokenByteIsRefusedWithItsLineOrReadAsWhatItSays) {
  RecordedFrame frame{500, {}};
  HandFrame hand;
  hand.joint(HandJoint::kPalm).valid = true;
  frame.frame.hands = {hand};
  const std::string line = record_line(frame) + "\n";
  int refused = 0, read = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    for (const char c : {'0', '9', '-', '"', '{', ']', 'e', '\0', '\xff'}) {
      std::string broken = line;
      broken[i] = c;
      const auto parsed = frames_of(broken, "broken");
      if (!parsed) {
        ++refused;
        EXPECT_EQ(parsed.error().kind, ErrorKind::kConfig);
        EXPECT_EQ(parsed.error().message.find("broken: line 1: "), 0u) << parsed.error().message;
        continue;
      }
      ++read;  // another number, or a name that is not known: what it says is what is kept
      ASSERT_EQ(parsed->size(), 1u) << broken;
      const std::string again = record_line(parsed->front());
      EXPECT_EQ(record_line(frames_of(again, "again").value().front()), again) << broken;
    }
  EXPECT_GT(refused, 3 * read) << refused << " refused, " << read << " read";
}

TEST(Recording, LengthDoesNotMatter) {
  // More than the 8 MiB that scripts may have, and more than 200000 frames.
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_long_" + std::to_string(::getpid()) + ".jsonl");
  constexpr int kFrames = 210'000;
  {
    std::ofstream file(path);
    InputFrame frame;
    frame.space_mouse = SpaceMouseMotion{};
    for (int i = 0; i < kFrames; ++i) file << record_line({i * 11'000'000LL, frame}) << "\n";
  }
  ASSERT_GT(std::filesystem::file_size(path), std::uintmax_t{9} << 20);
  InputConfig config;
  config.options = {{"path", path.string()}};
  auto source = make_replay_source(config);
  ASSERT_TRUE(source) << source.error().message;
  InputFrame newest;
  (*source)->poll(0, newest);
  EXPECT_FALSE((*source)->finished());
  (*source)->poll((kFrames - 2) * 11'000'000LL, newest);
  EXPECT_FALSE((*source)->finished());
  (*source)->poll((kFrames - 1) * 11'000'000LL, newest);
  EXPECT_TRUE((*source)->finished());
  std::filesystem::remove(path);
}

TEST(Recording, ALineWithoutEndIsNotReadToItsEnd) {
  const std::string endless(3 * kLongestLine, ' ');
  EXPECT_NE(frames_of(endless, "r.jsonl").error().message.find("longer than"), std::string::npos);
}

TEST(Recording, RefusesWhatCannotBe) {
  const auto refused = [](const char* text) { return frames_of(text, "r.jsonl").error().message; };
  EXPECT_EQ(refused("{\"polled\": 5, \"t\": 4}\n{\"polled\": 4, \"t\": 4}"),
            "r.jsonl: line 2: polled goes back in time");
  EXPECT_EQ(refused("{\"polled\": -5, \"t\": 4}"),
            "r.jsonl: line 1: polled is not a whole number of 0 to 4000000000000000000");
  EXPECT_NE(refused("{\"t\": 4}").find("polled is missing"), std::string::npos);
  EXPECT_NE(refused("5").find("expected an object"), std::string::npos);
  EXPECT_NE(refused("{\"polled\": 5, \"t\": 4, \"heads\": "
                    "[{\"t\":1,\"id\":1,\"tracked\":true,\"confidence\":1,\"left\":[1e9,0,0]}]}")
                .find("left"),
            std::string::npos);
}

}  // namespace
}  // namespace dubsar
