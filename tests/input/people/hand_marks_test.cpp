#include "input/people/hand_marks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {

using test::kMs;

/// People before a screen: frames go through the keeper and the recognisers as in a session.
class Scene {
 public:
  std::vector<HandMark> see(TimestampNs now, std::vector<HandFrame> hands) {
    InputFrame frame;
    frame.time = now;
    for (HandFrame& hand : hands) hand.time = now;
    frame.hands = std::move(hands);
    const KeptPerson person = keeper_.update(now, frame);
    for (std::size_t s = 0; s < 2; ++s) gestures_[s].update(now, person.hands[s]);
    return hand_marks(frame, person, gestures_, zone_);
  }

 private:
  HandZone zone_{{-0.3, -0.2, 0.0}, {0.3, 0.3, 0.5}};
  PersonKeeper keeper_{zone_};
  std::array<GestureRecognizer, 2> gestures_;
};

HandFrame hand(std::uint32_t id, const glm::dvec3& at_m, double closing = 0.0) {
  HandFrame out;
  out.id = id;
  out.chirality = Chirality::kRight;
  out.valid = out.tracked = true;
  out.palm.position_m = at_m;
  out.grab_strength = closing;
  return out;
}

TEST(HandMarks, AnOpenHandIsReadyAndAClosedOneHolds) {
  Scene scene;
  const glm::dvec3 at{0.05, 0.02, 0.2};
  std::vector<HandMark> marks;
  for (int i = 0; i < 30; ++i) marks = scene.see(i * 16 * kMs, {hand(1, at)});
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_EQ(marks[0].state, HandState::kReady);
  EXPECT_LT(glm::length(marks[0].place_m - at), 1e-3);
  for (int i = 30; i < 40; ++i) marks = scene.see(i * 16 * kMs, {hand(1, at, 1.0)});
  EXPECT_EQ(marks[0].state, HandState::kHolding);
  EXPECT_EQ(marks[0].closing, 1.0);
}

TEST(HandMarks, AFistThatComesInHasToOpenFirst) {
  Scene scene;
  std::vector<HandMark> marks;
  for (int i = 0; i < 60; ++i) marks = scene.see(i * 16 * kMs, {hand(1, {0, 0, 0.2}, 1.0)});
  EXPECT_EQ(marks.at(0).state, HandState::kFist);
  marks = scene.see(61 * 16 * kMs, {hand(1, {0, 0, 0.2}, 0.1)});
  EXPECT_EQ(marks.at(0).state, HandState::kReady);
}

TEST(HandMarks, OthersAreMarkedAsTooFarOrAsStrangers) {
  Scene scene;
  std::vector<HandMark> marks;
  for (int i = 0; i < 10; ++i)
    marks = scene.see(i * 16 * kMs, {hand(7, {0, 0, 0.9}), hand(1, {0.05, 0, 0.2}), hand(2, {-0.1, 0, 0.25})});
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[0].state, HandState::kReady);  // the followed one first
  EXPECT_NEAR(marks[0].place_m.x, 0.05, 1e-3);
  EXPECT_EQ(marks[1].state, HandState::kTooFar);
  EXPECT_EQ(marks[2].state, HandState::kStranger);  // a second right hand
}

TEST(HandMarks, HoldingStillFillsUp) {
  Scene scene;
  std::vector<double> resting;
  for (int i = 0; i < 100; ++i) resting.push_back(scene.see(i * 16 * kMs, {hand(1, {0, 0, 0.2})}).at(0).resting);
  EXPECT_EQ(resting[20], 0.0);
  EXPECT_GT(*std::max_element(resting.begin(), resting.end()), 0.9);
}

TEST(HandMarks, AHandThatIsNotMeasuredNowIsNotShown) {
  Scene scene;
  scene.see(0, {hand(1, {0, 0, 0.2})});
  HandFrame held = hand(1, {0, 0, 0.2});
  held.tracked = false;
  EXPECT_TRUE(scene.see(16 * kMs, {held}).empty());
  EXPECT_TRUE(scene.see(32 * kMs, {}).empty());
}

}  // namespace
}  // namespace dubsar
