// Geometry of landmarks and joints, and which hands are followed, with hands that the test makes up.

#include "input/tracking/webcam_hands/webcam_hand_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dubsar {
namespace {

constexpr int kWidth = 640, kHeight = 480;
using Landmarks = std::array<glm::dvec3, kLandmarks>;

/// A right hand, palm down, fingers to -Z, wrist at the origin; `bend_rad`: of each finger joint. Screen
/// axes, metres.
Landmarks right_hand(double bend_rad) {
  Landmarks at{};
  const auto chain = [&](std::size_t first, glm::dvec3 from, glm::dvec3 direction, const glm::dvec3& axis,
                         double length, double bend) {
    at[first] = from;
    for (std::size_t i = first; i < first + 3; ++i) {
      direction = glm::angleAxis(bend, axis) * direction;
      at[i + 1] = at[i] + length * direction;
    }
  };
  chain(1, {-0.03, 0, -0.02}, glm::normalize(glm::dvec3(-0.6, 0, -0.8)), {0, 1, 0}, 0.03, 0.0);
  const double x[] = {-0.03, -0.01, 0.01, 0.03};
  for (std::size_t finger = 0; finger < 4; ++finger)
    chain(5 + 4 * finger, {x[finger], 0, -0.09}, {0, 0, -1}, {1, 0, 0}, 0.028, -bend_rad);
  return at;
}

Landmarks mirrored(Landmarks at) {
  for (glm::dvec3& p : at) p.x = -p.x;
  return at;
}

TEST(HandFromLandmarks, BothHandsHaveTheirBacksUpAndTheirFingersForward) {
  for (const bool right : {true, false}) {
    const Landmarks at = right ? right_hand(0.05) : mirrored(right_hand(0.05));
    const HandFrame hand = hand_from_landmarks(at, right ? Chirality::kRight : Chirality::kLeft);
    EXPECT_LT(glm::length(hand.palm.rotation * glm::dvec3(0, 0, -1) - glm::normalize(at[9] - at[0])), 1e-9);
    EXPECT_GT((hand.palm.rotation * glm::dvec3(0, 1, 0)).y, 0.99);
    EXPECT_LT(hand.grab_strength, 0.2);
    for (const HandJointPose& joint : hand.joints) EXPECT_TRUE(joint.valid);
    EXPECT_EQ(hand.joint(HandJoint::kIndexTip).pose.position_m, at[8]);
    EXPECT_EQ(hand.joint(HandJoint::kLittleProximal).pose.position_m, at[17]);
    EXPECT_EQ(hand.joint(HandJoint::kThumbTip).pose.position_m, at[4]);
    EXPECT_FALSE(hand.joint(HandJoint::kRingMetacarpal).tracked);
    EXPECT_NEAR(hand.pinch_distance_m, glm::length(at[4] - at[8]), 1e-12);
  }
}

TEST(HandFromLandmarks, GrabRisesFromOpenToFist) {
  double before = -1.0;
  for (const double bend : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5}) {
    const double grab = hand_from_landmarks(right_hand(bend), Chirality::kRight).grab_strength;
    EXPECT_GE(grab, before);
    before = grab;
  }
  EXPECT_LT(hand_from_landmarks(right_hand(0.2), Chirality::kRight).grab_strength, 0.2);
  EXPECT_GT(hand_from_landmarks(right_hand(1.5), Chirality::kRight).grab_strength, 0.8);
}

/// The hand at a place before a camera, as the networks would say it.
HandSeen seen_at(const Landmarks& shape_m, const glm::dvec3& place_m, const CameraView& camera, double size) {
  HandSeen hand;
  hand.presence = 0.9;
  const double f = camera.focal_px(kWidth);
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const glm::dvec3 p =
        size * shape_m[i] + place_m;  // camera frame: +Z away from the camera, +X to the picture's left
    hand.points_px[i] = {0.5 * kWidth - f * p.x / p.z, 0.5 * kHeight - f * p.y / p.z};
    hand.shape_m[i] = {-shape_m[i].x, -shape_m[i].y, shape_m[i].z};
  }
  return hand;
}

TEST(PlaceHand, TheLandmarksOfAHandInPerspectiveSayExactlyWhereItIs) {
  CameraView camera;
  for (const glm::dvec3& place : {glm::dvec3(0, 0, 0.5), glm::dvec3(0.2, -0.1, 0.4), glm::dvec3(-0.3, 0.15, 1.0)})
    for (const double size : {1.0, 0.85}) {
      const auto found = place_hand(seen_at(right_hand(0.3), place, camera, size), kWidth, kHeight, camera, size);
      ASSERT_TRUE(found);
      EXPECT_LT(glm::length(*found - place), 1e-9);
    }
}

TEST(PlaceHand, AHandTakenForALargerOneIsPlacedThatMuchFurther) {
  CameraView camera;
  const auto found = place_hand(seen_at(right_hand(0.0), {0, 0, 0.5}, camera, 1.0), kWidth, kHeight, camera, 1.1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->z, 0.55, 1e-9);
}

TEST(PlaceHand, LandmarksOnOnePixelAreNowhere) {
  HandSeen hand;
  EXPECT_FALSE(place_hand(hand, kWidth, kHeight, {}, 1.0));
}

/// Networks that see what the test put up, each hand as a point; they count their calls.
struct Stage {
  struct Shown {
    glm::dvec2 at_px{0.0};
    double right = 0.9;
  };
  std::vector<Shown> hands;
  int palm_calls = 0, hand_calls = 0;
};

class PlayedNetworks final : public HandNetworks {
 public:
  explicit PlayedNetworks(Stage& stage) : stage_(stage) {}
  Result<std::vector<SquareCrop>> find_palms(const PictureView&) override {
    ++stage_.palm_calls;
    std::vector<SquareCrop> crops;
    for (const auto& hand : stage_.hands) crops.push_back({hand.at_px, 120.0, 0.0});
    return crops;
  }
  Result<HandSeen> place_landmarks(const PictureView&, const SquareCrop& crop) override {
    ++stage_.hand_calls;
    for (const auto& hand : stage_.hands)
      if (glm::length(hand.at_px - crop.centre_px) < 60.0) {
        CameraView camera;
        const double f = camera.focal_px(kWidth);
        Landmarks shape = right_hand(0.1);
        for (glm::dvec3& p : shape) p = {p.x, -p.z, 0.0};  // held up to the camera
        HandSeen seen =
            seen_at(shape, {-(hand.at_px.x - 320) * 0.6 / f, -(hand.at_px.y - 240) * 0.6 / f - 0.07, 0.6}, camera, 1.0);
        seen.right = hand.right;
        return seen;
      }
    return HandSeen{};
  }

 private:
  Stage& stage_;
};

class FollowingHands : public testing::Test {
 protected:
  FollowingHands() : tracker_(std::make_unique<PlayedNetworks>(stage_), {}) {
    frame_.width = kWidth;
    frame_.height = kHeight;
    frame_.format = PixelFormat::kRgb8;
    frame_.pixels.resize(frame_.view_bytes());
  }
  void step() {
    frame_.time += 33'000'000;
    ASSERT_TRUE(tracker_.track(frame_, hands_));
  }
  Stage stage_;
  WebcamHandTracker tracker_;
  Frame frame_;
  Hands hands_;
};

TEST_F(FollowingHands, PalmsAreLookedForOnlyUntilAHandIsFollowed) {
  for (int i = 0; i < 3; ++i) step();
  EXPECT_EQ(stage_.palm_calls, 3);
  stage_.hands = {{{300, 200}}};
  step();
  ASSERT_EQ(hands_.size(), 1U);
  const std::uint32_t id = hands_[0].id;
  stage_.palm_calls = 0;
  for (int i = 0; i < 60; ++i) {
    stage_.hands[0].at_px.x += 3.0;
    step();
    ASSERT_EQ(hands_.size(), 1U);
    EXPECT_EQ(hands_[0].id, id);
    EXPECT_TRUE(hands_[0].tracked);
  }
  EXPECT_EQ(stage_.palm_calls, 4) << "once in 15 frames";
  EXPECT_EQ(hands_[0].chirality, Chirality::kRight);
  EXPECT_GT(hands_[0].palm.position_m.z, 0.4);
  EXPECT_LT(hands_[0].velocity_mps.x, -0.03) << "to the picture's right is -X";
}

TEST_F(FollowingHands, ASecondHandJoinsAndALostOneComesBackWithANewId) {
  stage_.hands = {{{200, 200}}, {{450, 220}, 0.1}};
  step();
  ASSERT_EQ(hands_.size(), 2U);
  EXPECT_EQ(hands_[0].chirality, Chirality::kRight);
  EXPECT_EQ(hands_[1].chirality, Chirality::kLeft);
  stage_.palm_calls = 0;
  for (int i = 0; i < 40; ++i) step();
  EXPECT_EQ(stage_.palm_calls, 0) << "nobody has three";
  const std::uint32_t first = hands_[0].id, second = hands_[1].id;
  stage_.hands.erase(stage_.hands.begin());
  step();
  ASSERT_EQ(hands_.size(), 1U);
  EXPECT_EQ(hands_[0].id, second);
  stage_.hands.push_back({{200, 200}});
  for (int i = 0; i < 15; ++i) step();
  ASSERT_EQ(hands_.size(), 2U);
  EXPECT_NE(hands_[1].id, first);
  EXPECT_NE(hands_[1].id, second);
}

TEST_F(FollowingHands, TwoThatComeToFollowOneHandBecomeOne) {
  stage_.hands = {{{200, 200}}, {{420, 200}}};
  step();
  ASSERT_EQ(hands_.size(), 2U);
  for (int i = 0; i < 12; ++i) {
    stage_.hands[1].at_px.x -= 18.0;
    step();
  }
  EXPECT_EQ(hands_.size(), 1U);
}

TEST_F(FollowingHands, GreyFramesAreRefused) {
  frame_.format = PixelFormat::kGray8;
  EXPECT_EQ(tracker_.track(frame_, hands_).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
