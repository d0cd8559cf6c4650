// Hands in photographs: are the landmarks where the fingers are, and what follows from them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "core/image_io/jpeg_file.h"
#include "input/tracking/vision/model_files.h"
#include "input/tracking/webcam_hands/webcam_hand_tracker.h"
#include "tests/input/tracking/vision/vision_data.h"

namespace dubsar {
namespace {

/// Places looked up by eye, pixels of the photograph. All three are left hands with their backs to the
/// camera.
struct KnownHand {
  const char* photograph;
  glm::dvec2 wrist, index_tip, little_tip;
};
constexpr std::array<KnownHand, 3> kKnown{{{"sample5.jpg", {1374, 1146}, {1189, 1229}, {1275, 1307}},
                                           {"sample2.jpg", {898, 1053}, {820, 1215}, {948, 1172}},
                                           {"sample4.jpg", {893, 751}, {739, 853}, {832, 876}}}};

class HandPhotographs : public testing::Test {
 protected:
  void SetUp() override {
    for (const ModelFile& model : {kPalmModel, kHandModel})
      if (!std::filesystem::exists(model_folder() / model.name)) GTEST_SKIP() << kNoModels;
    if (!std::filesystem::exists(photograph_folder() / "sample6.jpg")) GTEST_SKIP() << kNoPhotographs;
    auto made = make_hand_networks(model_folder());
    ASSERT_TRUE(made) << made.error().message;
    networks_ = *std::move(made);
  }
  static Image photograph(const char* name) {
    auto image = read_jpeg(photograph_folder() / name);
    EXPECT_TRUE(image) << image.error().message;
    return image ? *std::move(image) : Image(1, 1, 3);
  }
  static PictureView view_of(const Image& image) { return {image.pixels.data(), image.width, image.height}; }
  /// A 640 x 480 picture around a point of the photograph, with a camera's noise.
  Frame webcam(const Image& photo, const glm::dvec2& centre, double scale, float noise_sd) {
    std::vector<float> planes(3 * 640 * 640);
    PictureSampler().sample(view_of(photo), {centre, 640 / scale, 0.0}, 640, 1.0f, 0.0f, planes);
    std::normal_distribution<float> noise(0.0f, noise_sd);
    Frame frame;
    frame.width = 640;
    frame.height = 480;
    frame.format = PixelFormat::kRgb8;
    frame.pixels.resize(frame.view_bytes());
    for (int i = 0; i < 640 * 480; ++i)
      for (int c = 0; c < 3; ++c)
        frame.pixels[static_cast<std::size_t>(3 * i + c)] = static_cast<std::uint8_t>(
            std::clamp(planes[static_cast<std::size_t>(c * 640 * 640 + 80 * 640 + i)] + noise(random_), 0.0f, 255.0f));
    return frame;
  }
  std::unique_ptr<HandNetworks> networks_;
  std::mt19937 random_{4};
};

TEST_F(HandPhotographs, LandmarksLieOnTheFingersThatAPersonSees) {
  for (const KnownHand& known : kKnown) {
    const Image photo = photograph(known.photograph);
    const auto palms = networks_->find_palms(view_of(photo));
    ASSERT_TRUE(palms);
    double best = 1e9;
    for (const SquareCrop& palm : *palms) {
      const auto first = networks_->place_landmarks(view_of(photo), palm);
      ASSERT_TRUE(first);
      if (first->presence < 0.5) continue;
      const auto hand = networks_->place_landmarks(view_of(photo), first->next_crop());
      ASSERT_TRUE(hand);
      if (hand->presence < 0.5) continue;
      EXPECT_LT(hand->right, 0.5) << known.photograph;
      best = std::min(best, std::max({glm::length(hand->points_px[0] - known.wrist),
                                      glm::length(hand->points_px[8] - known.index_tip),
                                      glm::length(hand->points_px[20] - known.little_tip)}));
    }
    EXPECT_LT(best, 15.0) << known.photograph << ": pixels, of hands that are 200 long";
  }
}

TEST_F(HandPhotographs, PicturesWithoutHandsShowNone) {
  const Image photo = photograph("sample6.jpg");
  WebcamHandTracker tracker(std::move(networks_), {});
  Hands hands;
  for (const glm::dvec2& at :
       {glm::dvec2(150, 150), glm::dvec2(800, 500), glm::dvec2(1280, 430)}) {  // blinds, two faces
    ASSERT_TRUE(tracker.track(webcam(photo, at, 1.0, 4.0f), hands));
    EXPECT_TRUE(hands.empty()) << at.x;
  }
}

TEST_F(HandPhotographs, ARestingHandStaysWhereItIsAndItsBackFacesTheCamera) {
  const Image photo = photograph("sample2.jpg");
  double depth_m[2] = {0, 0};
  std::vector<double> cpu_ms;
  for (const int half : {0, 1}) {
    auto networks = make_hand_networks(model_folder());
    ASSERT_TRUE(networks);
    WebcamHandTracker tracker(*std::move(networks), {});
    std::vector<double> x, z;
    for (int i = 0; i < 24; ++i) {
      Frame frame = webcam(photo, {860, 1130}, half == 0 ? 1.0 : 0.6, 4.0f);
      frame.time = i * TimestampNs{33'333'333};
      Hands hands;
      const std::clock_t before = std::clock();
      ASSERT_TRUE(tracker.track(frame, hands));
      cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
      const HandFrame* middle = nullptr;
      for (const HandFrame& hand : hands)
        if (std::abs(hand.palm.position_m.x) < 0.08 && std::abs(hand.palm.position_m.y) < 0.08) middle = &hand;
      ASSERT_NE(middle, nullptr) << i;
      EXPECT_EQ(middle->chirality, Chirality::kLeft);
      // it hangs over a knee: its back up and to the camera, which looks along +Z, knuckles nearer than the
      // wrist, tips down
      EXPECT_LT((middle->palm.rotation * glm::dvec3(0, 1, 0)).z, -0.1);
      EXPECT_LT((middle->palm.rotation * glm::dvec3(0, 0, -1)).z, -0.5);
      EXPECT_LT(middle->joint(HandJoint::kMiddleTip).pose.position_m.y,
                middle->joint(HandJoint::kWrist).pose.position_m.y - 0.05);
      EXPECT_LT(middle->grab_strength, 0.7) << "a hand that rests does not grab";
      if (i < 10) continue;
      x.push_back(1e3 * middle->palm.position_m.x);
      z.push_back(1e3 * middle->palm.position_m.z);
    }
    const auto spread = [](std::vector<double>& v) {
      double sum = 0, squares = 0;
      for (const double value : v) sum += value;
      for (const double value : v)
        squares += (value - sum / static_cast<double>(v.size())) * (value - sum / static_cast<double>(v.size()));
      return std::sqrt(squares / static_cast<double>(v.size() - 1));
    };
    for (const double value : z) depth_m[half] += 1e-3 * value / static_cast<double>(z.size());
    std::printf("hand at %.2f m: sd of the palm %.1f mm sideways, %.1f mm in depth\n", depth_m[half], spread(x),
                spread(z));
    EXPECT_LT(spread(x), 3.0);
    EXPECT_LT(spread(z), 15.0);
  }
  EXPECT_NEAR(depth_m[1] / depth_m[0], 1.0 / 0.6, 0.15) << "a hand of 0.6 times the size is that much further away";
  std::sort(cpu_ms.begin(), cpu_ms.end());
  std::printf("CPU of a frame: median %.1f ms, worst (with the palm network) %.1f ms\n", cpu_ms[cpu_ms.size() / 2],
              cpu_ms.back());
}

}  // namespace
}  // namespace dubsar
