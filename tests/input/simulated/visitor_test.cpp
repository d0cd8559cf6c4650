// Whole sessions without pictures: simulated people before the navigation, hundreds of them.

#include "input/simulated/visitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "input/mixer.h"
#include "input/navigation/navigation.h"
#include "input/people/person_keeper.h"
#include "input/simulated/scripted_source.h"

namespace dubsar {
namespace {

constexpr TimestampNs kFrame = 16'666'667;
constexpr double kRad = std::numbers::pi / 180.0;

struct Outcome {
  ViewState view;
  double largest_step_deg = 0.0, seconds = 0.0;
  int frames = 0;
  double longest_zoom_step = 0.0;
};

Outcome run(const Script& script, const ViewState& home = {}) {
  Outcome out;
  const Mapping mapping = default_mapping().value();
  Navigator navigator(mapping, home);
  PersonKeeper people;
  ViewState seen = home;
  InputMixer mixer;
  mixer.add(play_script(script, [&] { return seen; }).value());
  TimestampNs now = 1'000'000'000;
  for (int settle = 0; settle < 60; now += kFrame) {
    const InputFrame& polled = mixer.poll(now);
    navigator.update(now, polled, people.update(now, polled).hands);
    out.largest_step_deg = std::max(out.largest_step_deg, turn_between_deg(seen.rotation, navigator.view().rotation));
    out.longest_zoom_step = std::max(out.longest_zoom_step, std::abs(std::log(navigator.view().zoom / seen.zoom)));
    seen = navigator.view();
    ++out.frames;
    if (mixer.finished()) ++settle;
  }
  out.view = seen;
  out.seconds = 1e-9 * static_cast<double>(now - 1'000'000'000);
  return out;
}

Script visit(std::uint64_t seed) {
  ScriptRandom random(seed);
  Script script;
  script.seed = seed;
  script.duration_s = 120;
  script.rate_hz = random.uniform(60, 120);
  script.latency_s = random.uniform(0.01, 0.05);
  script.noise_m = 0.001;
  script.hand_dropouts = {0.4, 0.02, 0.7};  // some are bridged, some cancel the gesture
  script.visitor =
      VisitorGoal{random.uniform(-90, 90), random.uniform(-40, 40), std::exp(random.uniform(-0.5, 0.8)), 100};
  script.bystanders = 1 + static_cast<int>(seed % 2);
  script.bystander_heads = seed % 3 != 0;
  return script;
}

glm::dquat wished(const VisitorGoal& goal) {
  return turn_of({goal.pitch_deg * kRad, 0, 0}) * turn_of({0, goal.yaw_deg * kRad, 0});
}

TEST(Visitor, HundredSessionsEndInTheViewTheVisitorWantedWithoutAJump) {
  double total_s = 0, worst_turn = 0, worst_zoom = 0, worst_step = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Script script = visit(seed);
    const Outcome outcome = run(script);
    const double turn = turn_between_deg(outcome.view.rotation, wished(*script.visitor));
    const double zoom = std::abs(outcome.view.zoom / script.visitor->zoom - 1.0);
    EXPECT_LE(turn, 5.0) << "seed " << seed << " after " << outcome.seconds << " s";
    EXPECT_LE(zoom, 0.05) << "seed " << seed << " after " << outcome.seconds << " s";
    EXPECT_LE(outcome.largest_step_deg, 2.0) << "seed " << seed;
    total_s += outcome.seconds;
    worst_turn = std::max(worst_turn, turn);
    worst_zoom = std::max(worst_zoom, zoom);
    worst_step = std::max(worst_step, outcome.largest_step_deg);
  }
  RecordProperty("worst_turn_deg", std::to_string(worst_turn));
  RecordProperty("worst_zoom_percent", std::to_string(100 * worst_zoom));
  RecordProperty("worst_step_deg", std::to_string(worst_step));
  RecordProperty("mean_session_s", std::to_string(total_s / 100));
}

TEST(Visitor, BystandersHandsNeverMoveTheViewWhileTheVisitorsRestsInTheZone) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Script script = visit(seed);
    script.visitor.reset();
    script.duration_s = 20;
    script.hands = {{Chirality::kRight, {0.2, -0.2, 0.75}, {{0.0, {0.08, 0, 0.25}}, {22, {0.08, 0, 0.25}}}}};
    script.heads = script.bystander_heads
                       ? std::vector<HeadTrack>{{0.063, {{0.0, {0, 0.05, 0.65}}, {20, {0, 0.05, 0.65}}}}}
                       : std::vector<HeadTrack>{};
    const Outcome outcome = run(script);
    EXPECT_LT(turn_between_deg(outcome.view.rotation, {1, 0, 0, 0}), 1e-9) << "seed " << seed;
    EXPECT_DOUBLE_EQ(outcome.view.zoom, 1.0) << "seed " << seed;
  }
}

TEST(Visitor, TheSameBystandersDoMoveTheViewWhenTheyAreAlone) {  // else the test above shows nothing
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Script script = visit(seed);
    script.visitor.reset();
    script.duration_s = 20;
    script.heads = {{0.063, {{30, {}}, {31, {}}}}};  // nobody in front
    script.bystander_heads = false;
    moved += turn_between_deg(run(script).view.rotation, {1, 0, 0, 0}) > 2.0;
  }
  EXPECT_GT(moved, 0);  // most reach in from so far aside that they are known for bystanders
}

TEST(Visitor, ASessionRepeatsToTheLastBit) {
  const Outcome a = run(visit(5)), b = run(visit(5));
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.view.rotation, b.view.rotation);
  EXPECT_EQ(a.view.zoom, b.view.zoom);
}

}  // namespace
}  // namespace dubsar
