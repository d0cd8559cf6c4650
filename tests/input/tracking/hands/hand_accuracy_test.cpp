// How far the tracker's palm, finger tips and grab are from the truth of simulated pictures. Prints the table
// of docs/leap.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "devices/leap/hand_renderer.h"
#include "input/tracking/hands/hand_tracker.h"
#include "tests/input/tracking/hands/hand_trials.h"
#include "tests/pace.h"

namespace dubsar {
namespace {

/// Errors in mm of one kind of hands at one distance.
struct Errors {
  std::vector<double> x, along, depth, tips, cpu_ms, turn_degrees;
  int trials = 0, seen = 0, grab_right = 0, side_right = 0;
};

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return 1e9;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(p * static_cast<double>(values.size() - 1)))];
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 1e9 : std::sqrt(sum / static_cast<double>(values.size()));
}

void soften(Frame& frame) {
  const std::vector<std::uint8_t> sharp = frame.pixels;
  for (std::size_t eye = 0; eye < 2; ++eye)
    blur_121({sharp.data() + eye * frame.view_bytes(), frame.width, frame.height},
             std::span(frame.pixels).subspan(eye * frame.view_bytes(), frame.view_bytes()));
}

class HandAccuracy : public ::testing::Test {
 protected:
  lmc1::Calibration calibration_ = example_calibration(true);
  HandRenderer renderer_{calibration_, {}}, lit_from_eyes_{calibration_, {.light_x_m = {}}};
  HandTracker tracker_{stereo_lenses(calibration_, 640, 240)};

  Errors measure(const HandKind& kind, double height_m, int trials, std::uint32_t seed) {
    std::mt19937 random(seed);
    Errors e;
    for (int i = 0; i < trials; ++i) {
      const HandPose pose = random_hand(random, height_m, kind);
      PosedHand hand = pose_hand(pose);
      if (kind.sleeve) hand.cones.resize(hand.cones.size() - 2);
      Frame frame = render_frame(kind.lit_from_eyes ? lit_from_eyes_ : renderer_, {&hand, 1}, random());
      if (kind.soft) soften(frame);
      frame.time = i + 1;
      tracker_.reset();
      Hands hands;
      const double before = process_cpu_seconds();
      EXPECT_TRUE(tracker_.track(frame, hands));
      e.cpu_ms.push_back(1e3 * (process_cpu_seconds() - before));
      ++e.trials;
      if (hands.size() != 1) continue;
      ++e.seen;
      const HandFrame& found = hands[0];
      const glm::dvec3 error = 1e3 * (found.palm.position_m - hand.palm_m);
      e.turn_degrees.push_back(
          2.0 * std::acos(std::min(1.0, std::abs(glm::dot(found.palm.rotation, pose.palm.rotation)))) / kDegree);
      e.x.push_back(std::abs(error.x));
      e.along.push_back(std::abs(error.z));
      e.depth.push_back(std::abs(error.y));
      e.grab_right += (found.grab_strength > 0.5) == kind.fist ? 1 : 0;
      e.side_right += (found.chirality == Chirality::kLeft) == pose.left ? 1 : 0;
      constexpr std::array<HandJoint, 5> kTips{HandJoint::kThumbTip, HandJoint::kIndexTip, HandJoint::kMiddleTip,
                                               HandJoint::kRingTip, HandJoint::kLittleTip};
      for (std::size_t f = 0; f < 5; ++f)
        if (found.joint(kTips[f]).tracked)
          e.tips.push_back(1e3 * glm::distance(found.joint(kTips[f]).pose.position_m, hand.tips_m[f]));
    }
    return e;
  }

  static void print_header() {
    std::puts(
        "Errors in mm, of the rotation in degrees: median, RMS, 95 %; times in ms: median, 99 %\n"
        "                              mm |         x         |       along       |       depth       |      "
        "rotation     "
        "|       tips        | seen, grab and side right | CPU");
  }
  static void print(const char* what, double height_m, const Errors& e) {
    const auto show = [](const std::vector<double>& v) {
      std::printf(" | %5.2f %5.2f %5.2f", quantile(v, 0.5), rms(v), quantile(v, 0.95));
    };
    std::printf("%-28s %4.0f", what, 1e3 * height_m);
    show(e.x);
    show(e.along);
    show(e.depth);
    show(e.turn_degrees);
    if (e.tips.empty())
      std::printf(" |                  ");
    else
      show(e.tips);
    std::printf(" | %d %d %d of %d | %.1f %.1f\n", e.seen, e.grab_right, e.side_right, e.trials,
                quantile(e.cpu_ms, 0.5), quantile(e.cpu_ms, 0.99));
  }
};

void join(Errors& all, const Errors& e) {
  for (const auto member :
       {&Errors::x, &Errors::along, &Errors::depth, &Errors::tips, &Errors::cpu_ms, &Errors::turn_degrees})
    (all.*member).insert((all.*member).end(), (e.*member).begin(), (e.*member).end());
  for (const auto member : {&Errors::trials, &Errors::seen, &Errors::grab_right, &Errors::side_right})
    all.*member += e.*member;
}

/// DUBSAR_HAND_TRIALS: hands of each kind at each distance; the bounds hold for the usual number and for
/// many.
int trials_of_each_kind() {
  const char* text = std::getenv("DUBSAR_HAND_TRIALS");
  return text != nullptr ? std::max(10, std::atoi(text)) : 20;
}

TEST_F(HandAccuracy, PalmIsWithinTwoMillimetresSidewaysAndFiveInDepth) {
  print_header();
  Errors all;
  for (const bool fist : {false, true}) {
    Errors kind;
    for (const double height : {0.2, 0.25, 0.3, 0.35, 0.4}) {
      const Errors e = measure({.fist = fist}, height, trials_of_each_kind(), 40961);  // not the seed of the tuning
      print(fist ? "fist" : "open", height, e);
      EXPECT_LE(rms(e.x), 2.0);
      EXPECT_LE(rms(e.along), 2.0);
      EXPECT_LE(rms(e.depth), 5.0);
      join(kind, e);
    }
    EXPECT_LE(quantile(kind.x, 0.95), 2.0);
    EXPECT_LE(quantile(kind.along, 0.95), fist ? 2.5 : 2.0);  // fists at 400 mm are at the limit
    EXPECT_LE(quantile(kind.depth, 0.95), 5.0);
    if (!fist) {
      EXPECT_LE(quantile(kind.tips, 0.95), 5.0);
    }
    join(all, kind);
  }
  print("all of these", 0.3, all);
  EXPECT_LE(quantile(all.along, 0.95), 2.0);
  EXPECT_EQ(all.seen, all.trials);
  EXPECT_GE(all.grab_right, 0.99 * all.trials);
  EXPECT_GE(all.side_right, 0.98 * all.trials);
#ifdef NDEBUG
  // 8 ms is the aim; twice as much for a machine that does other things
  EXPECT_LE(quantile(all.cpu_ms, 0.99), 2 * 8.0 * testing::slowness());
#endif
}

TEST_F(HandAccuracy, HandsUnlikeTheModelAreFoundNearlyAsWell) {
  const std::array<std::pair<const char*, HandKind>, 10> kinds{{
      {"open, other proportions", {.proportions = 0.08}},
      {"fist, other proportions", {.fist = true, .proportions = 0.08}},
      {"open, wrist turned", {.wrist_turn_rad = 12 * kDegree}},
      {"fist, wrist turned", {.fist = true, .wrist_turn_rad = 12 * kDegree}},
      {"open, sleeve", {.sleeve = true}},
      {"fist, sleeve", {.fist = true, .sleeve = true}},
      {"open, lit from the eyes", {.lit_from_eyes = true}},
      {"fist, lit from the eyes", {.fist = true, .lit_from_eyes = true}},
      {"open, out of focus", {.soft = true}},
      {"fist, out of focus", {.fist = true, .soft = true}},
  }};
  print_header();
  for (const auto& [name, kind] : kinds) {
    Errors all;
    for (const double height : {0.2, 0.3, 0.4}) {
      const Errors e = measure(kind, height, trials_of_each_kind() / 3, 4052);
      print(name, height, e);
      join(all, e);
    }
    EXPECT_EQ(all.seen, all.trials);
    EXPECT_GE(all.grab_right, 0.98 * all.trials);
    // What it does today, with a margin; the few hands that are fitted in a wrong place weigh on the RMS.
    const bool hard = kind.sleeve || kind.soft;
    EXPECT_LE(quantile(all.x, 0.5), 1.0);
    EXPECT_LE(quantile(all.along, 0.5), 2.5);
    EXPECT_LE(quantile(all.depth, 0.5), kind.soft || kind.lit_from_eyes ? 4.0 : 2.5);
    EXPECT_LE(rms(all.x), hard ? 4.0 : 2.0);
    EXPECT_LE(rms(all.along), hard ? 6.0 : 2.0);
    EXPECT_LE(rms(all.depth), hard ? 6.0 : 5.0);
  }
}

}  // namespace
}  // namespace dubsar
