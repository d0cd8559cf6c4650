#include "input/sources/webcam_source.h"

#include <filesystem>
#include <glm/geometric.hpp>

#include "core/image_io/jpeg_file.h"
#include "core/image_io/png_file.h"
#include "input/tracking/vision/model_files.h"
#include "input/tracking/vision/picture_crop.h"
#include "tests/input/sources/source_bench.h"
#include "tests/input/tracking/vision/vision_data.h"

namespace dubsar::test {
namespace {

TEST(WebcamSource, WrongOptionsAreRefusedByName) {
  SourceBench bench;
  for (const auto& [spec, word] : {std::pair{"webcam:hfov=200", "hfov"},
                                   {"webcam:size=big", "size"},
                                   {"webcam:replay=/nonexistent", "/nonexistent"},
                                   {"webcam:at=1/2", "at"},
                                   {"webcam", "simulated time"}}) {
    const auto made = make_input(spec, bench.config);
    ASSERT_FALSE(made) << spec;
    EXPECT_NE(made.error().message.find(word), std::string::npos) << made.error().message;
  }
}

/// One picture of somebody before a grey wall, as a webcam of 60 degrees sees him at a known place.
class WebcamOfAPhotograph : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(photograph_folder() / "sample6.jpg")) GTEST_SKIP() << kNoPhotographs;
    folder_ = std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    bench_.config.model_folder = model_folder();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  /// The third face of the photograph, which looks at the camera; its pupils are `pupils_px` apart, their
  /// middle `right_px` from the picture's.
  void write(const char* name, double pupils_px, double right_px) {
    const auto photo = read_jpeg(photograph_folder() / "sample6.jpg");
    ASSERT_TRUE(photo);
    const double scale = pupils_px / 102.1;
    std::vector<float> planes(3 * 640 * 640);
    PictureSampler().sample({photo->pixels.data(), photo->width, photo->height},
                            {{1280.0 - right_px / scale, 430.0}, 640 / scale, 0.0}, 640, 1.0f, 0.0f, planes);
    Image image(640, 480, 3);
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x)
        for (int c = 0; c < 3; ++c)
          image.at(x, y)[c] =
              std::abs(x - 320 - right_px) < 1.6 * pupils_px
                  ? static_cast<std::uint8_t>(planes[static_cast<std::size_t>((c * 640 + y + 80) * 640 + x)])
                  : std::uint8_t{128};
    ASSERT_TRUE(write_png(folder_ / name, image));
  }
  SourceBench bench_;
  std::filesystem::path folder_;
};

TEST_F(WebcamOfAPhotograph, AHeadMovesInTheScreenFrameAsItDoesInThePictures) {
  if (!std::filesystem::exists(model_folder() / kFaceModel.name)) GTEST_SKIP() << kNoModels;
  write("1.png", 58.2, 0.0);   // 600 mm away, on the camera's axis
  write("2.png", 58.2, 90.0);  // further to the picture's right: the person's left, -X
  write("3.png", 43.6, 0.0);   // 800 mm
  const auto source = bench_.make(fmt::format("webcam:replay={},fps=10,at=0/150/20", folder_.string()));
  ASSERT_TRUE(source);
  const double focal = 320.0 / std::tan(std::numbers::pi / 6);
  const glm::dvec3 expected[] = {{0, 0.15, 0.62}, {-90.0 / focal * 0.6, 0.15, 0.62}, {0, 0.15, 0.82}};
  for (const glm::dvec3& place : expected) {
    EXPECT_EQ(bench_.poll(*source), Freshness::kNew);
    ASSERT_EQ(bench_.frame.heads.size(), 1U);
    const HeadFrame& head = bench_.frame.heads[0];
    EXPECT_EQ(head.time, bench_.clock.now());
    EXPECT_TRUE(head.tracked);
    EXPECT_LT(head.left_eye_m->x, head.right_eye_m->x);
    const glm::dvec3 middle = 0.5 * (*head.left_eye_m + *head.right_eye_m);
    // which pixels are the pupils was looked up by eye, and the head is turned a little
    EXPECT_NEAR(middle.x, place.x, 0.012);
    EXPECT_NEAR(middle.y, place.y, 0.012);
    EXPECT_NEAR(middle.z, place.z, 0.06);
    bench_.clock.advance(50 * kMs);
    EXPECT_EQ(bench_.poll(*source), Freshness::kUnchanged);
    bench_.clock.advance(50 * kMs);
  }
  EXPECT_TRUE(source->has_end());
  EXPECT_TRUE(source->finished());
  EXPECT_TRUE(source->note().empty()) << source->note();
}

TEST_F(WebcamOfAPhotograph, WithoutTheNetworkTheCascadeSeesTheHeadAndSaysSo) {
  if (!std::filesystem::exists("/usr/share/opencv4/haarcascades")) GTEST_SKIP() << "opencv-data is missing";
  write("1.png", 70.0, 0.0);
  const auto source = bench_.make(fmt::format("webcam:replay={},models=/nonexistent", folder_.string()));
  ASSERT_TRUE(source);
  EXPECT_EQ(bench_.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench_.frame.heads.size(), 1U);
  EXPECT_NEAR(0.5 * (bench_.frame.heads[0].left_eye_m->z + bench_.frame.heads[0].right_eye_m->z), 0.5, 0.08);
  EXPECT_NE(source->note().find("./do models"), std::string::npos) << source->note();
}

TEST_F(WebcamOfAPhotograph, HandsAreFollowedWhenAskedForAndNeedTheirNetworks) {
  if (!std::filesystem::exists(model_folder() / kHandModel.name)) GTEST_SKIP() << kNoModels;
  std::filesystem::copy_file(photograph_folder() / "sample2.jpg", folder_ / "1.jpg");
  std::filesystem::copy_file(photograph_folder() / "sample2.jpg", folder_ / "2.jpg");
  const std::string spec = fmt::format("webcam:hands,fps=10,replay={}", folder_.string());
  const auto source = bench_.make(spec);
  ASSERT_TRUE(source);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(bench_.poll(*source), Freshness::kNew);
    ASSERT_FALSE(bench_.frame.hands.empty());
    EXPECT_EQ(bench_.frame.hands[0].id, 1U);
    EXPECT_EQ(bench_.frame.hands[0].chirality, Chirality::kLeft);
    EXPECT_EQ(bench_.frame.hands[0].time, bench_.clock.now());
    bench_.clock.advance(100 * kMs);
  }
  const auto without = make_input(spec + ",models=/nonexistent", bench_.config);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().kind, ErrorKind::kUnavailable);
  EXPECT_NE(without.error().message.find("./do models"), std::string::npos) << without.error().message;
}

TEST(WebcamSourceOver, ALostCameraIsAStateAndComesBack) {
  if (!std::filesystem::exists(model_folder() / kFaceModel.name)) GTEST_SKIP() << kNoModels;
  struct Played final : FrameSource {
    const Clock& clock;
    bool* there;
    bool running = false;
    Played(const Clock& c, bool& t) : clock(c), there(&t) {}
    Result<void> start() override {
      if (!*there) return fail(ErrorKind::kUnavailable, "camera: none is plugged in");
      running = true;
      return {};
    }
    void stop() noexcept override { running = false; }
    bool poll(Frame& newest) override {
      if (!running || !*there) return false;
      newest.time = clock.now();
      newest.width = newest.height = 64;
      newest.format = PixelFormat::kRgb8;
      newest.pixels.assign(64 * 64 * 3, 90);
      return true;
    }
    bool wait(Frame& newest, std::chrono::milliseconds) override { return poll(newest); }
    FrameSourceState state() const override {
      return running && !*there ? FrameSourceState::kLost : FrameSourceState::kRunning;
    }
    std::string reason() const override { return "it was unplugged"; }
  };
  SourceBench bench;
  bench.config.model_folder = model_folder();
  bool there = true;
  WebcamFrames frames;
  frames.source = std::make_unique<Played>(bench.clock, there);
  auto source = make_webcam_source_over(std::move(frames), bench.config);
  ASSERT_TRUE(source) << source.error().message;
  ASSERT_TRUE((*source)->start());
  EXPECT_EQ(bench.poll(**source), Freshness::kNew);
  EXPECT_TRUE(bench.frame.heads.empty());
  there = false;
  EXPECT_EQ(bench.poll(**source), Freshness::kLost);
  EXPECT_EQ((*source)->note(), "it was unplugged");
  bench.clock.advance(600 * kMs);
  EXPECT_EQ(bench.poll(**source), Freshness::kLost);
  EXPECT_EQ((*source)->note(), "camera: none is plugged in");
  there = true;
  bench.bell->ring();
  EXPECT_EQ(bench.poll(**source), Freshness::kNew);
}

}  // namespace
}  // namespace dubsar::test
