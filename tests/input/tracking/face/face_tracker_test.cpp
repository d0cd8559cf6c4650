// Geometry of eyes, and who is followed, with faces that the test makes up.

#include "input/tracking/face/face_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dubsar {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kNose = 0.6 * 0.063;  // before the pupils

/// A head's eyes and nose tip, turned by `yaw` to its own left and rolled, as the camera sees them.
struct Head {
  glm::dvec3 centre_m{0.0};  // between the pupils, screen frame
  double yaw_rad = 0.0, roll_rad = 0.0;

  glm::dquat turn() const {
    return glm::angleAxis(roll_rad, glm::dvec3(0, 0, 1)) * glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0));
  }
  glm::dvec3 left_m() const {
    return centre_m + turn() * glm::dvec3(-0.0315, 0, 0);
  }  // at the left as the person sees the screen
  glm::dvec3 right_m() const { return centre_m + turn() * glm::dvec3(0.0315, 0, 0); }
  glm::dvec3 nose_m() const { return centre_m + turn() * glm::dvec3(0, -0.035, -kNose); }  // towards the screen

  FaceSeen seen(const CameraView& camera) const {
    const Pose camera_from_screen = inverse(camera.screen_from_camera());
    const double f = camera.focal_px(kWidth);
    const auto pixel = [&](const glm::dvec3& point_m) {
      const glm::dvec3 p = transform(camera_from_screen, point_m);
      return glm::dvec2(0.5 * kWidth - f * p.x / p.z, 0.5 * kHeight - f * p.y / p.z);
    };
    FaceSeen face;
    face.score = 0.9;
    face.left_eye_px = pixel(left_m());
    face.right_eye_px = pixel(right_m());
    face.nose_px = pixel(nose_m());
    face.centre_px = *face.nose_px;
    face.size_px = 2.5 * glm::length(face.left_eye_px - face.right_eye_px);
    return face;
  }
};

FaceTrackerOptions options_with_tilt(double tilt_deg) {
  FaceTrackerOptions options;
  options.camera.at_m = {0.01, 0.12, 0.0};
  options.camera.tilt_rad = tilt_deg * std::numbers::pi / 180.0;
  return options;
}

TEST(PlaceEyes, AHeadThatFacesTheScreenIsPlacedWithinTwoPercentOfItsDistance) {
  const FaceTrackerOptions options = options_with_tilt(0.0);
  for (const double roll : {0.0, 0.3, -0.4})
    for (const glm::dvec3& at : {glm::dvec3(0.01, 0.12, 0.6), glm::dvec3(0.2, -0.1, 0.7), glm::dvec3(-0.15, 0.1, 0.4),
                                 glm::dvec3(0.3, 0.1, 1.0)}) {
      const Head head{at, 0.0, roll};
      const EyesPlaced eyes = place_eyes(head.seen(options.camera), kWidth, kHeight, options);
      EXPECT_LT(glm::length(eyes.left_m - head.left_m()), 0.02 * at.z) << at.x << ' ' << roll;
      EXPECT_LT(glm::length(eyes.right_m - head.right_m()), 0.02 * at.z) << at.x << ' ' << roll;
      EXPECT_LT(eyes.left_m.x, eyes.right_m.x) << "the picture is not mirrored, the screen frame is the person's";
    }
}

TEST(PlaceEyes, TurningTheHeadKeepsItsPlaceAndTurnsTheEyes) {
  const FaceTrackerOptions options = options_with_tilt(0.0);
  for (const double yaw : {-0.7, -0.35, 0.2, 0.5})
    for (const double x : {0.01, -0.2, 0.15}) {
      const Head head{{x, 0.12, 0.6}, yaw, 0.0};
      const EyesPlaced eyes = place_eyes(head.seen(options.camera), kWidth, kHeight, options);
      EXPECT_NEAR(eyes.yaw_rad, yaw, 0.06) << x;
      EXPECT_LT(glm::length(eyes.left_m - head.left_m()), 0.03) << x << ' ' << yaw;
      EXPECT_LT(glm::length(eyes.right_m - head.right_m()), 0.03) << x << ' ' << yaw;
      EXPECT_EQ(eyes.left_m.z > eyes.right_m.z, yaw > 0) << "the left eye goes back when a head turns to its left";
      EXPECT_NEAR(glm::length(eyes.left_m - eyes.right_m), 0.063, 1e-9);
    }
}

TEST(PlaceEyes, TheCamerasTiltTurnsTheWholeSceneAboutTheLens) {
  const Head head{{0.01, 0.02, 0.62}, 0.0, 0.0};
  for (const double tilt : {5.0, 20.0, -15.0}) {
    const FaceTrackerOptions options = options_with_tilt(tilt);
    const EyesPlaced eyes = place_eyes(head.seen(options.camera), kWidth, kHeight, options);
    // depth is taken along the camera's axis, where the tilted camera sees the same pupils' distance
    EXPECT_LT(glm::length(0.5 * (eyes.left_m + eyes.right_m) - head.centre_m), 0.004) << tilt;
  }
}

TEST(PlaceEyes, AnotherDistanceBetweenThePupilsScalesTheDepth) {
  FaceTrackerOptions options = options_with_tilt(0.0);
  const Head head{{0.01, 0.12, 0.6}, 0.0, 0.0};
  options.ipd_m = 0.058;
  const EyesPlaced eyes = place_eyes(head.seen(options.camera), kWidth, kHeight, options);
  EXPECT_NEAR(eyes.left_m.z, 0.6 * 58.0 / 63.0, 1e-6);
}

TEST(PlaceEyes, PixelsThatMakeNoSenseGiveFiniteEyes) {
  FaceSeen face;  // both eyes on one pixel
  const EyesPlaced eyes = place_eyes(face, kWidth, kHeight, {});
  EXPECT_TRUE(std::isfinite(glm::length(eyes.left_m)) && std::isfinite(glm::length(eyes.right_m)));
}

/// Sees what the test says, `find` all, `refine` what is near; counts its passes.
class PlayedDetector final : public FaceDetector {
 public:
  std::vector<FaceSeen>* faces;
  int* passes;
  PlayedDetector(std::vector<FaceSeen>& all, int& count) : faces(&all), passes(&count) {}
  std::string_view name() const noexcept override { return "played"; }
  Result<std::vector<FaceSeen>> find(const PictureView&) override {
    ++*passes;
    return *faces;
  }
  Result<std::optional<FaceSeen>> refine(const PictureView&, const FaceSeen& near) override {
    ++*passes;
    for (const FaceSeen& face : *faces)
      if (glm::length(face.centre_px - near.centre_px) < 0.5 * near.size_px) return std::optional(face);
    return std::optional<FaceSeen>();
  }
};

FaceSeen face_at(double x, double y, double size) {
  FaceSeen face;
  face.score = 0.8;
  face.centre_px = {x, y};
  face.size_px = size;
  face.right_eye_px = {x - 0.2 * size, y};
  face.left_eye_px = {x + 0.2 * size, y};
  face.nose_px = face.centre_px;
  return face;
}

class Following : public ::testing::Test {
 protected:
  Following() : tracker_(std::make_unique<PlayedDetector>(faces_, passes_), {}) {
    frame_.width = kWidth;
    frame_.height = kHeight;
    frame_.format = PixelFormat::kRgb8;
    frame_.pixels.resize(frame_.view_bytes());
  }
  void step() {
    frame_.time += 33'000'000;
    passes_ = 0;
    ASSERT_TRUE(tracker_.track(frame_, heads_));
    EXPECT_LE(passes_, 2) << "the time of a frame is bounded";
  }
  std::vector<FaceSeen> faces_;
  int passes_ = 0;
  FaceTracker tracker_;
  Frame frame_;
  std::vector<HeadFrame> heads_;
};

TEST_F(Following, AMovingFaceKeepsItsIdAndTakesOnePassInFourOfFiveFrames) {
  int passes = 0;
  for (int i = 0; i < 50; ++i) {
    faces_ = {face_at(100 + 8 * i, 240, 120)};
    step();
    passes += passes_;
    ASSERT_EQ(heads_.size(), 1U);
    EXPECT_EQ(heads_[0].id, 1U);
    EXPECT_TRUE(heads_[0].tracked);
  }
  EXPECT_LE(passes, 50 + 12);
}

TEST_F(Following, ANewcomerIsSeenWithinFiveFramesAndGetsAnIdOfItsOwn) {
  faces_ = {face_at(200, 240, 120)};
  for (int i = 0; i < 7; ++i) step();
  faces_.push_back(face_at(500, 200, 90));
  int frames = 0;
  while (heads_.size() < 2 && frames < 20) {
    step();
    ++frames;
  }
  EXPECT_LE(frames, 5);
  EXPECT_EQ(heads_[0].id, 1U) << "the largest face comes first";
  EXPECT_EQ(heads_[1].id, 2U);
}

TEST_F(Following, AFaceAwayForAThirdOfASecondIsTheSamePersonAfterASecondItIsNot) {
  faces_ = {face_at(300, 240, 120)};
  step();
  faces_.clear();
  for (int i = 0; i < 10; ++i) {
    step();
    EXPECT_TRUE(heads_.empty()) << "what is not seen is not reported";
  }
  faces_ = {face_at(310, 240, 120)};
  step();
  ASSERT_EQ(heads_.size(), 1U);
  EXPECT_EQ(heads_[0].id, 1U);
  faces_.clear();
  for (int i = 0; i < 30; ++i) step();
  faces_ = {face_at(310, 240, 120)};
  step();
  ASSERT_EQ(heads_.size(), 1U);
  EXPECT_EQ(heads_[0].id, 2U);
}

TEST_F(Following, TheKeptPersonIsSeenInEveryFrameHoweverLargeThreeOthersAre) {
  faces_ = {face_at(320, 240, 100)};
  for (int i = 0; i < 5; ++i) step();
  for (const double x : {60.0, 200.0, 560.0}) faces_.push_back(face_at(x, 240, 130));
  for (int i = 0; i < 20; ++i) {
    step();
    EXPECT_TRUE(std::any_of(heads_.begin(), heads_.end(), [](const HeadFrame& head) {
      return head.id == 1 && head.tracked;
    })) << i;
  }
}

TEST_F(Following, ACrowdIsSeenWithAtMostTwoPasses) {
  for (int i = 0; i < 9; ++i) faces_.push_back(face_at(40 + 70 * i, 240, 60 + i));
  for (int i = 0; i < 20; ++i) step();
  EXPECT_GE(heads_.size(), 2U);
  EXPECT_LE(heads_.size(), 6U);
}

TEST_F(Following, GreyFramesAreRefused) {
  frame_.format = PixelFormat::kGray8;
  EXPECT_EQ(tracker_.track(frame_, heads_).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
