#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "input/people/eye_pair.h"
#include "input/people/one_euro.h"
#include "input/people/pose_history.h"
#include "input/people/presence.h"
#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {
using test::kMs;

TEST(OneEuro, AConstantStaysAndAStepConverges) {
  OneEuroVector filter;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(filter.filter(i * 16 * kMs, {1, 2, 3}), glm::dvec3(1, 2, 3));
  glm::dvec3 out(0.0);
  for (int i = 10; i < 200; ++i) out = filter.filter(i * 16 * kMs, {2, 2, 3});
  EXPECT_NEAR(out.x, 2.0, 1e-3);
}

TEST(OneEuro, NoiseAtRestShrinksToLessThanAThird) {
  OneEuroVector filter({1.0, 0.5, 1.0});
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.001);
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 out = filter.filter(i * 11 * kMs, {noise(random), 0, 0});
    if (i > 200) sum += out.x * out.x / 1800.0;
  }
  EXPECT_LT(std::sqrt(sum), 0.001 / 3.0);
}

TEST(OneEuro, AFastMoveLagsLessThanWithAFixedFilter) {
  OneEuroVector adaptive({1.0, 20.0, 1.0}), fixed({1.0, 0.0, 1.0});
  glm::dvec3 a(0.0), f(0.0), truth(0.0);
  for (int i = 0; i < 100; ++i) {
    truth.x = 0.5 * i * 0.016;
    a = adaptive.filter(i * 16 * kMs, truth);
    f = fixed.filter(i * 16 * kMs, truth);
  }
  EXPECT_LT(truth.x - a.x, 0.25 * (truth.x - f.x));
}

TEST(OneEuro, RotationTakesTheNearWayAcrossTheSignChange) {
  OneEuroRotation filter;
  const glm::dquat q = glm::angleAxis(0.4, glm::dvec3(0, 0, 1));
  filter.filter(0, q);
  const glm::dquat out = filter.filter(16 * kMs, -q);
  EXPECT_NEAR(std::abs(glm::dot(out, q)), 1.0, 1e-12);
}

TEST(PositionHistory, OldSamplesAreDroppedAndCounted) {
  PositionHistory history;
  EXPECT_TRUE(history.add({10 * kMs, {}}));
  EXPECT_FALSE(history.add({10 * kMs, {}}));
  EXPECT_FALSE(history.add({5 * kMs, {}}));
  EXPECT_EQ(history.dropped(), 2u);
}

TEST(PositionHistory, AStraightMoveIsPredictedExactlyAndNotTooFar) {
  PositionHistory history;
  for (int i = 0; i <= 10; ++i) history.add({i * 10 * kMs, {0.2 * 0.01 * i, 0, 0.6}});
  EXPECT_NEAR(history.velocity_mps().x, 0.2, 1e-9);
  EXPECT_NEAR(history.predict(140 * kMs)->x, 0.028, 1e-9);
  EXPECT_NEAR(history.predict(10'000 * kMs)->x, 0.020 + 0.2 * 0.1, 1e-9);
}

// A head that sways with 200 mm/s at most, seen by a tracker at 60 Hz with 0.5 mm noise, 40 ms late.
TEST(PositionHistory, AHeadAt200MillimetresASecondIsFollowedWithinThreeMillimetresRms) {
  const auto truth = [](double t) { return glm::dvec3(0.1 * std::sin(2.0 * t), 0.02 * std::sin(1.3 * t), 0.6); };
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.0005);
  PositionHistory history;
  double predicted = 0.0, late = 0.0;
  int count = 0;
  for (int i = 0; i < 1200; ++i) {
    const TimestampNs measured = TimestampNs{i} * 16'666'667;
    const glm::dvec3 jitter(noise(random), noise(random), noise(random));
    history.add({measured, truth(1e-9 * static_cast<double>(measured)) + jitter});
    if (i < 30) continue;
    const TimestampNs shown = measured + 40 * kMs;
    const glm::dvec3 eye = truth(1e-9 * static_cast<double>(shown));
    const auto square = [](const glm::dvec3& d) { return glm::dot(d, d); };
    predicted += square(*history.predict(shown) - eye);
    late += square(history.newest().position_m - eye);
    ++count;
  }
  EXPECT_LT(std::sqrt(predicted / count), 0.003);
  EXPECT_GT(std::sqrt(late / count), 0.004);
}

TEST(Presence, ATrackerThatFallsSilentIsHeldThenEasedThenOff) {
  const glm::dvec3 last(0.1, 0, 0.5), rest(0, 0, 0.6);
  EXPECT_EQ(present_position(last, rest, 50 * kMs).presence, Presence::kTracked);
  const auto held = present_position(last, rest, 400 * kMs);
  EXPECT_TRUE(held.valid());
  EXPECT_FALSE(held.tracked());
  EXPECT_EQ(held.position_m, last);
  EXPECT_EQ(present_position(last, rest, 2000 * kMs).position_m, rest);
  EXPECT_EQ(present_position(last, rest, 3000 * kMs).presence, Presence::kOff);
  EXPECT_EQ(present_position(last, rest, -1).presence, Presence::kOff);
}

TEST(Presence, NoStepIsLargerThanAMillimetreAt60Hertz) {
  const glm::dvec3 last(0.03, 0, 0.6), rest(0, 0, 0.6);
  glm::dvec3 before = last;
  for (TimestampNs age = 0; age < 4000 * kMs; age += 16 * kMs) {
    const glm::dvec3 now = present_position(last, rest, age).position_m;
    EXPECT_LT(glm::length(now - before), 0.001);
    before = now;
  }
}

TEST(EyePair, AMissingEyeIsRebuiltFromTheLastDistanceForThreeTenthsOfASecond) {
  EyePairKeeper keeper;
  EXPECT_FALSE(keeper.update({0, glm::dvec3(0), std::nullopt}));
  EXPECT_TRUE(keeper.update({10 * kMs, glm::dvec3(-0.03, 0, 0.6), glm::dvec3(0.03, 0, 0.6)}));
  const auto rebuilt = keeper.update({20 * kMs, glm::dvec3(-0.02, 0, 0.6), std::nullopt});
  ASSERT_TRUE(rebuilt);
  EXPECT_TRUE(rebuilt->rebuilt);
  EXPECT_NEAR(rebuilt->right_m.x, 0.04, 1e-12);
  EXPECT_FALSE(keeper.update({311 * kMs, glm::dvec3(0), std::nullopt}));
  EXPECT_FALSE(keeper.update({20 * kMs, std::nullopt, std::nullopt}));
}

}  // namespace
}  // namespace dubsar
