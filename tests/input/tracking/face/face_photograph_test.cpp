// Faces in photographs, and how still the eyes stand when nothing but noise moves.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>

#include "core/base/system/clock.h"
#include "core/image_io/jpeg_file.h"
#include "input/people/head_follower.h"
#include "input/tracking/face/face_tracker.h"
#include "input/tracking/vision/model_files.h"
#include "tests/input/tracking/vision/vision_data.h"
#include "tests/pace.h"

namespace dubsar {
namespace {

constexpr const char* kCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_default.xml";
constexpr int kPhotoWidth = 640, kPhotoHeight = 480;

PictureView view_of(const Image& image) { return {image.pixels.data(), image.width, image.height}; }

class FacePhotographs : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(model_folder() / kFaceModel.name)) GTEST_SKIP() << kNoModels;
    if (!std::filesystem::exists(photograph_folder() / "sample1.jpg")) GTEST_SKIP() << kNoPhotographs;
    auto made = make_network_face_detector(model_folder());
    ASSERT_TRUE(made) << made.error().message;
    detector_ = *std::move(made);
    std::normal_distribution<float> normal;
    for (int i = 0; i < static_cast<int>(kNoise); ++i) noise_.push_back(normal(random_));
  }
  static Image photograph(const char* name) {
    auto image = read_jpeg(photograph_folder() / name);
    EXPECT_TRUE(image) << image.error().message;
    return image ? *std::move(image) : Image(1, 1, 3);
  }
  /// The photograph, `scale` times as large, with this point of it in the middle of a webcam's picture;
  /// floats, planes.
  std::vector<float> scene(const Image& photo, const glm::dvec2& centre, double scale) {
    std::vector<float> planes(std::size_t{3} * kPhotoWidth * kPhotoWidth);
    sampler_.sample(view_of(photo), {centre, kPhotoWidth / scale, 0.0}, kPhotoWidth, 1.0f, 0.0f, planes);
    return planes;
  }
  /// What a camera makes of it.
  Frame webcam(const std::vector<float>& planes, float noise_sd) {
    Frame frame;
    frame.width = kPhotoWidth;
    frame.height = kPhotoHeight;
    frame.format = PixelFormat::kRgb8;
    frame.pixels.resize(frame.view_bytes());
    std::size_t at = random_();
    for (int y = 0; y < kPhotoHeight; ++y)
      for (int x = 0; x < kPhotoWidth; ++x)
        for (int c = 0; c < 3; ++c) {
          const std::size_t row = static_cast<std::size_t>(c) * kPhotoWidth + static_cast<std::size_t>(y) +
                                  (kPhotoWidth - kPhotoHeight) / 2;
          const float level = planes[row * kPhotoWidth + static_cast<std::size_t>(x)];
          frame.pixels[(static_cast<std::size_t>(y) * kPhotoWidth + static_cast<std::size_t>(x)) * 3 +
                       static_cast<std::size_t>(c)] =
              static_cast<std::uint8_t>(std::clamp(level + noise_sd * noise_[at++ & (kNoise - 1)], 0.0f, 255.0f));
        }
    return frame;
  }
  static constexpr std::size_t kNoise = 1 << 17;
  std::unique_ptr<FaceDetector> detector_;
  PictureSampler sampler_;
  std::mt19937 random_{11};
  std::vector<float> noise_;  // drawn once: sd 1
};

double deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// Pupils in sample6.jpg, looked up by eye.
struct Pupils {
  glm::dvec2 right, left;
};
constexpr std::array<Pupils, 4> kSixth{
    {{{326, 608}, {428, 598}}, {{702, 461}, {796, 449}}, {{1229, 428}, {1331, 432}}, {{1530, 378}, {1634, 397}}}};

double worst_pupil_error(const FaceSeen& face, const Pupils& pupils) {
  return std::max(glm::length(face.right_eye_px - pupils.right), glm::length(face.left_eye_px - pupils.left));
}

TEST_F(FacePhotographs, TheNetworkFindsAllFourFacesAndTheirPupils) {
  const Image photo = photograph("sample6.jpg");
  const auto faces = detector_->find(view_of(photo));
  ASSERT_TRUE(faces);
  ASSERT_EQ(faces->size(), 4U);
  for (const Pupils& pupils : kSixth) {
    double first = 1e9, second = 1e9;
    for (const FaceSeen& face : *faces) {
      const auto finer = detector_->refine(view_of(photo), face);
      ASSERT_TRUE(finer && *finer);
      first = std::min(first, worst_pupil_error(face, pupils));
      second = std::min(second, worst_pupil_error(**finer, pupils));
    }
    EXPECT_LT(first, 70.0);  // of a pupil distance of 100 pixels: in this pass the faces are 15 pixels wide
    EXPECT_LT(second, 15.0);
  }
}

TEST_F(FacePhotographs, TheCascadeFindsTheSameFacesCoarsely) {
  if (!std::filesystem::exists(kCascade)) GTEST_SKIP() << "opencv-data is missing";
  auto cascade = make_cascade_face_detector(kCascade);
  ASSERT_TRUE(cascade) << cascade.error().message;
  const Image photo = photograph("sample6.jpg");
  const auto faces = (*cascade)->find(view_of(photo));
  ASSERT_TRUE(faces);
  for (const Pupils& pupils : kSixth) {
    const auto best = std::min_element(faces->begin(), faces->end(), [&](const FaceSeen& a, const FaceSeen& b) {
      return worst_pupil_error(a, pupils) < worst_pupil_error(b, pupils);
    });
    ASSERT_NE(best, faces->end());
    EXPECT_LT(worst_pupil_error(*best, pupils), 25.0);
    EXPECT_NEAR(glm::length(best->left_eye_px - best->right_eye_px), glm::length(pupils.left - pupils.right), 25.0);
  }
}

TEST_F(FacePhotographs, WallsAndBlackPicturesShowNobody) {
  const Image photo = photograph("sample6.jpg");
  for (const Frame& frame :
       {webcam(scene(photo, {150, 150}, 3.0), 4.0f), webcam(scene(photo, {-5000, 0}, 1.0), 4.0f)}) {
    const auto faces = detector_->find({frame.pixels.data(), frame.width, frame.height});
    ASSERT_TRUE(faces);
    EXPECT_TRUE(faces->empty());
  }
}

// Somebody who sits still: a photograph's face at this distance, moved by fractions of pixels, with a
// camera's noise.
TEST_F(FacePhotographs, AtSixtyCentimetresTheFilteredDepthIsStillWithinTenMillimetres) {
  const Image photo = photograph("sample6.jpg");
  constexpr int kFrames = 45;
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  for (const double distance_m : {0.4, 0.6, 0.8, 1.0}) {
    double raw_worst = 0, filtered_worst = 0, sideways_worst = 0;
    int seen = 0, expected = 0;
    for (const Pupils& pupils : std::span(kSixth).first(distance_m == 0.6 ? 4 : 1)) {
      FaceTrackerOptions options;
      // the face's yaw makes its pupils' distance shorter; what matters here is how still it is
      const double scale =
          options.camera.focal_px(kPhotoWidth) * options.ipd_m / distance_m / glm::length(pupils.left - pupils.right);
      std::array<std::vector<float>, 5> scenes;
      for (auto& planes : scenes)
        planes = scene(photo, 0.5 * (pupils.left + pupils.right) + glm::dvec2(shift(random_), shift(random_)) / scale,
                       scale);
      auto detector = make_network_face_detector(model_folder());
      ASSERT_TRUE(detector);
      FaceTracker tracker(*std::move(detector), options);
      HeadFollower follower;
      std::vector<double> raw, filtered, sideways;
      std::vector<HeadFrame> heads;
      std::uint32_t id = 0;
      for (int i = 0; i < kFrames; ++i) {
        Frame frame = webcam(scenes[random_() % scenes.size()], 4.0f);
        frame.time = i * TimestampNs{33'333'333};
        ASSERT_TRUE(tracker.track(frame, heads));
        ++expected;
        // the neighbours are in the picture as well; this one is in its middle
        const HeadFrame* middle = nullptr;
        for (const HeadFrame& head : heads)
          if (head.tracked && std::abs(head.left_eye_m->x + head.right_eye_m->x) < 0.1 && (id == 0 || head.id == id))
            middle = &head;
        if (middle == nullptr) continue;
        id = middle->id;
        ++seen;
        raw.push_back(500.0 * (middle->left_eye_m->z + middle->right_eye_m->z));
        follower.add(*middle, frame.time);
        if (i < 15) continue;
        const FollowedEyes eyes = follower.eyes(frame.time, frame.time);
        filtered.push_back(500.0 * (eyes.left_m.z + eyes.right_m.z));
        sideways.push_back(500.0 * (eyes.left_m.x + eyes.right_m.x));
      }
      ASSERT_GT(filtered.size(), 10U);
      raw_worst = std::max(raw_worst, deviation(raw));
      filtered_worst = std::max(filtered_worst, deviation(filtered));
      sideways_worst = std::max(sideways_worst, deviation(sideways));
    }
    std::printf(
        "%.1f m: seen in %d of %d frames; sd of depth %.1f mm raw, %.1f mm filtered, sideways %.1f mm (worst "
        "of %d)\n",
        distance_m, seen, expected, raw_worst, filtered_worst, sideways_worst, expected / kFrames);
    if (distance_m == 0.6) {
      EXPECT_LE(filtered_worst, 10.0);
      EXPECT_LE(sideways_worst, 3.0);
      EXPECT_GE(seen, expected - 2);
    }
  }
}

TEST_F(FacePhotographs, AFrameTakesAtMostTenMillisecondsOfOneCore) {
  const Image photo = photograph("sample6.jpg");
  const std::vector<float> planes = scene(photo, {960, 700}, 0.34);  // all four are in the picture
  double p99 = 0.0, bound = 0.0;
  // other programs on this machine only ever add: up to six rounds until one is undisturbed
  for (int round = 0; round < 6 && (round == 0 || p99 > bound); ++round) {
    auto detector = make_network_face_detector(model_folder());
    ASSERT_TRUE(detector);
    FaceTracker tracker(*std::move(detector), {});
    std::vector<double> cost;
    std::vector<HeadFrame> heads;
    bound = 10.0 * testing::slowness();
    for (int i = 0; i < 100; ++i) {
      Frame frame = webcam(planes, 4.0f);
      frame.time = i * TimestampNs{33'333'333};
      const double before = process_cpu_seconds();
      ASSERT_TRUE(tracker.track(frame, heads));
      cost.push_back(1e3 * (process_cpu_seconds() - before));
    }
    EXPECT_EQ(heads.size(), 4U);
    std::sort(cost.begin(), cost.end());
    p99 = cost[98];
    std::printf("CPU of a frame: median %.2f ms, p95 %.2f ms, p99 %.2f ms, of %.2f\n", cost[49], cost[94], p99, bound);
  }
#ifdef NDEBUG
  EXPECT_LE(p99, bound);
#endif
}

}  // namespace
}  // namespace dubsar
