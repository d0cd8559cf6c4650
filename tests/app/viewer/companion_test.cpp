// Another surface beside that of a session: its scale, its turn, where it stands, and how far the two are apart.

#include "app/viewer/companion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <thread>

#include "app/stage/pick_camera.h"
#include "core/compare/surface_difference.h"
#include "display/optics/srgb.h"
#include "display/render/context/context_egl.h"
#include "display/render/passes/compose_pass.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {

/// A box that is larger or smaller.
TriMesh box(double factor = 1.0) {
  TriMesh mesh = testing::lettered_box();
  for (glm::vec3& p : mesh.positions) p = static_cast<float>(factor) * p;
  return mesh;
}

/// A tablet of 40 x 26 x 12 mm that has no two like places; in its middle it may lie `more` mm higher.
TriMesh pillow(double more_mm) {
  constexpr int kAcross = 120, kTurn = 240;
  TriMesh mesh;
  for (int j = 0; j <= kAcross; ++j)
    for (int i = 0; i < kTurn; ++i) {
      const double along = 3.14159265358979 * j / kAcross, around = 2 * 3.14159265358979 * i / kTurn;
      const double uneven = 1.0 + 0.06 * std::sin(3 * around + 1.0) * std::sin(2 * along) + 0.02 * std::cos(5 * along);
      glm::dvec3 p(20 * uneven * std::cos(along), 13 * uneven * std::sin(along) * std::cos(around),
                   6 * uneven * std::sin(along) * std::sin(around));
      if (p.z > 0 && std::hypot(p.x, p.y) < 4.0) p.z += more_mm;
      mesh.positions.emplace_back(p);
    }
  const auto id = [=](int j, int i) { return static_cast<std::uint32_t>(j * kTurn + i % kTurn); };
  for (int j = 0; j < kAcross; ++j)
    for (int i = 0; i < kTurn; ++i) {
      mesh.triangles.push_back({id(j, i), id(j + 1, i), id(j, i + 1)});
      mesh.triangles.push_back({id(j, i + 1), id(j + 1, i), id(j + 1, i + 1)});
    }
  mesh.frame.input_voxel = {glm::dvec3(1.0), "test"};
  return mesh;
}

TriMesh turned(TriMesh mesh, const glm::dquat& turn) {
  const glm::mat3 rotation(glm::mat3_cast(turn));
  for (glm::vec3& p : mesh.positions) p = rotation * p;
  return mesh;
}

/// Columns and rows of a picture that show something, from the first to the last.
struct Silhouette {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
};
Silhouette silhouette(const Image& image, int x0, int x1, int y0, int y1) {
  Silhouette out;
  const std::uint8_t* const ground = image.at(x0, y0);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (std::abs(image.at(x, y)[0] - ground[0]) > 12) {
        out = {std::min(out.left, x), std::max(out.right, x), std::min(out.top, y), std::max(out.bottom, y)};
      }
  return out;
}

class CompanionPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = EglContext::create().value();
    options_.screen = {.window_w = 640, .window_h = 360};
    options_.shading = shading_preset("relief").value();
  }
  static CompanionSurface companion(TriMesh mesh, const glm::dquat& home = {1.0, 0.0, 0.0, 0.0}) {
    OpenedSurface read;
    read.mesh = std::move(mesh);
    read.work.document.home.rotation = read.work.document.now.rotation = home;
    return CompanionSurface(std::move(read));
  }
  Image picture(const TriMesh& own, const CompanionSurface& beside, const glm::dquat& turn = {1.0, 0.0, 0.0, 0.0},
                double difference_mm = 0.0) {
    stage_ = Stage::create(own, options_).value();
    Document document;
    document.companion = {"/tablets/b.exa", "", difference_mm};
    ViewState view = view_of(document);
    view.rotation = turn;
    Shown shown = shown_of(document, view, options_, stage_->box_mm());
    put_beside(shown, document, beside, options_, {});
    stage_->show(shown, FollowedEyes(), 1);
    auto surface = OffscreenSurface::create(stage_->traits().output).value();
    EXPECT_TRUE(stage_->paint(surface.surface()));
    return surface.read().value();
  }
  /// Pixels of the left half that differ from those of the right half by more than rounding.
  static int halves_differ(const Image& image) {
    int out = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width / 2; ++x)
        for (int c = 0; c < 3; ++c)
          out += std::abs(image.at(x, y)[c] - image.at(x + image.width / 2, y)[c]) > 8 ? 1 : 0;
    return out;
  }
  std::unique_ptr<GlContext> context_;
  StageOptions options_;
  std::unique_ptr<Stage> stage_;
};

TEST_F(CompanionPicture, TheSameSurfaceTwiceIsTwiceTheSamePictureHoweverItIsTurned) {
  const TriMesh mesh = pillow(0.0);
  const CompanionSurface beside = companion(pillow(0.0));
  for (const glm::dquat& turn : {glm::dquat(1, 0, 0, 0), turn_of({0.3, 0.8, -0.2}), turn_of({0.0, 3.1, 0.4})}) {
    const Image found = picture(mesh, beside, turn);
    EXPECT_LT(halves_differ(found), 200) << "of 345 600";
    EXPECT_GT(silhouette(found, 0, 320, 0, 360).width(), 100);
  }
}

TEST_F(CompanionPicture, EachStandsByItsOwnWayUpAndBothTurnTogether) {
  const glm::dquat lies = turn_of({0.0, 0.0, 3.14159265358979});  // upside down in its scan
  const TriMesh own = pillow(0.0);
  const CompanionSurface beside = companion(turned(own, lies), glm::conjugate(lies));
  EXPECT_LT(halves_differ(picture(own, beside)), 200);
  EXPECT_LT(halves_differ(picture(own, beside, turn_of({0.4, -0.7, 0.1}))), 200);
  EXPECT_GT(halves_differ(picture(own, companion(turned(own, lies)))), 2000) << "without it one stands on its head";
}

TEST_F(CompanionPicture, BothHaveOneScaleAndTheLargerOneFits) {
  const Silhouette alone = silhouette(picture(box(), companion(box())), 0, 320, 0, 360);
  const Image small = picture(box(), companion(box(0.5)));
  const Silhouette own = silhouette(small, 0, 320, 0, 360), half = silhouette(small, 320, 640, 0, 360);
  EXPECT_EQ(own.width(), alone.width()) << "the smaller one changes nothing";
  // The eye is 600 mm away: what is thinner stands farther from it by some per cent.
  EXPECT_NEAR(half.width(), 0.5 * own.width(), 0.02 * own.width());
  EXPECT_NEAR(half.height(), 0.5 * own.height(), 0.02 * own.height());
  const Image large = picture(box(), companion(box(2.0)));
  const Silhouette shrunk = silhouette(large, 0, 320, 0, 360), twice = silhouette(large, 320, 640, 0, 360);
  EXPECT_NEAR(shrunk.width(), 0.5 * alone.width(), 0.02 * alone.width());
  EXPECT_NEAR(twice.width(), 2.0 * shrunk.width(), 0.04 * alone.width());
  EXPECT_LT(twice.right, 636);
}

TEST_F(CompanionPicture, OnUprightPanelsOneStandsAboveTheOther) {
  options_.screen = {.window_w = 360, .window_h = 640};
  options_.screen.width_mm = 360.0;
  options_.screen.height_mm = 640.0;
  const Image found = picture(box(), companion(box()));
  const Silhouette above = silhouette(found, 0, 360, 0, 320), below = silhouette(found, 0, 360, 320, 640);
  EXPECT_EQ(above.width(), below.width());
  EXPECT_GT(above.width(), 240) << "as wide as the panel lets it be";
  EXPECT_NEAR(0.5 * (above.left + above.right), 179.5, 2.0);
  EXPECT_NEAR(0.5 * (above.top + above.bottom) + 320.0, 0.5 * (below.top + below.bottom), 1.5);
  const glm::dvec2 mm = stage_->window_mm();
  EXPECT_TRUE(other_half(stage_->shown(), mm, {0.0, -0.2})) << "the lower half is not the session's own";
  EXPECT_FALSE(other_half(stage_->shown(), mm, {0.1, 0.2}));
}

TEST_F(CompanionPicture, OwnPlacesAreFoundInTheOwnHalfOnly) {
  picture(box(), companion(box()));
  const double quarter = 0.25 * stage_->window_mm().x / stage_->window_mm().y;
  const auto own = stage_->place_at({-quarter, 0.0});
  ASSERT_TRUE(own && *own);
  EXPECT_NEAR((*own)->x, 0.0, 0.3);
  EXPECT_NEAR((*own)->z, 5.0, 0.3);
  const glm::dvec2 seen = PickCamera::of(*stage_).seen({0.0, 0.0, 5.0});
  EXPECT_NEAR(seen.x, -quarter, 1e-3);
  const auto other = stage_->place_at({quarter, 0.0});
  EXPECT_TRUE(other && !*other);
}

TEST_F(CompanionPicture, AStillIsWhatIsSeen) {
  const Image seen = picture(box(), companion(box(0.7)), turn_of({0.2, 0.5, 0.0}));
  const auto still = stage_->still(1);
  ASSERT_TRUE(still) << still.error().message;
  ASSERT_EQ(still->width, seen.width);
  int differ = 0;
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) differ += std::abs(still->at(x, y)[1] - seen.at(x, y)[1]) > 2 ? 1 : 0;
  EXPECT_EQ(differ, 0);
}

TEST_F(CompanionPicture, ColoursTellTheDifferenceInMm) {
  constexpr double kBump = 0.12, kFull = 0.25;
  const TriMesh own = pillow(kBump);
  const Image found = picture(own, companion(pillow(0.0)), {1, 0, 0, 0}, kFull);
  const SurfaceDifference* const apart = stage_->difference();
  ASSERT_NE(apart, nullptr);
  EXPECT_LT(apart->median_mm, 0.004);
  const auto at = [&](double x_mm, double y_mm) {
    const glm::dvec2 seen = PickCamera::of(*stage_).seen({x_mm, y_mm, 6.0});
    return found.at(static_cast<int>(320 + 360 * seen.x), static_cast<int>(180 - 360 * seen.y));
  };
  // White light changes how bright a colour is, not the proportions of its linear parts.
  const auto proportions = [](const std::uint8_t* color) {
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = linear_from_srgb(color[c]);
    const double sum = out[0] + out[1] + out[2];
    for (double& part : out) part /= sum;
    return out;
  };
  const auto more = difference_color(kBump, kFull), same = difference_color(0.0, kFull);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(proportions(at(0, 0))[c], proportions(more.data())[c], 0.02) << c;
    EXPECT_NEAR(proportions(at(12, 2))[c], proportions(same.data())[c], 0.02) << c;
  }
  // The other way round clay is missing.
  const Image less = picture(pillow(0.0), companion(pillow(kBump)), {1, 0, 0, 0}, kFull);
  const glm::dvec2 middle = PickCamera::of(*stage_).seen({0, 0, 6.0});
  const auto* const blue = less.at(static_cast<int>(320 + 360 * middle.x), static_cast<int>(180 - 360 * middle.y));
  EXPECT_GT(blue[2] - blue[0], 60);
}

TEST_F(CompanionPicture, TheDifferenceIsMeasuredBesideThePicturesAndNoLongerWhenNobodyWantsIt) {
  options_.quality = Quality::kAdaptive;
  const TriMesh own = pillow(0.1);
  const CompanionSurface beside = companion(pillow(0.0));
  picture(own, beside, {1, 0, 0, 0}, 0.25);
  EXPECT_TRUE(stage_->measuring());
  EXPECT_EQ(stage_->difference(), nullptr);
  Shown plain = stage_->shown();
  const Shown wanted = plain;
  plain.style = options_.shading.style;
  stage_->show(plain, FollowedEyes(), 2);
  EXPECT_FALSE(stage_->measuring()) << "it was given up";
  stage_->show(wanted, FollowedEyes(), 3);
  for (TimestampNs now = 4; stage_->measuring(); ++now) {
    stage_->show(wanted, FollowedEyes(), now);
    std::this_thread::yield();
  }
  ASSERT_NE(stage_->difference(), nullptr);
  EXPECT_TRUE(stage_->moved()) << "its colours are there now";
}

}  // namespace
}  // namespace dubsar::app
