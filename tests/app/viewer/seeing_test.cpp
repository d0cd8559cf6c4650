// Light that goes round, the glass and the ring under the pointer: sessions in simulated time against geometry.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "app/stage/light_over.h"
#include "app/stage/picker.h"
#include "app/viewer/run_view.h"
#include "display/render/shading.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {

constexpr int kWidth = 640, kHeight = 400;

class Seeing : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("phong").value();
    Screen& screen = options_.stage.screen;
    screen.width_px = screen.window_w = kWidth;
    screen.height_px = screen.window_h = kHeight;
    screen.width_mm = 320;
    screen.height_mm = 200;
    options_.time.fps = 10.0;
    options_.time.longest_s = 3.0;
    options_.around.notices = options_.around.panels = false;
  }
  /// Pictures and what led to them, by tenths of a second.
  struct Seen {
    Image image;
    PictureReport report;
    glm::dmat4 screen_from_model{1.0};
  };
  std::vector<Seen> run(const TriMesh& mesh, std::vector<TimedCommand> steps) {
    options_.steps = std::move(steps);
    std::vector<Seen> out;
    const auto done = run_view(mesh, options_, progress_, [&](const ViewMoment& moment) {
      out.push_back({moment.presenter.picture().value(), moment.report, moment.viewer.stage().screen_from_model()});
    });
    EXPECT_TRUE(done) << done.error().message;
    return out;
  }
  ViewOptions options_;
  SilentProgress progress_;
};

TEST_F(Seeing, SweepingLightGoesRoundInItsPeriodAndStopsWhereItBegan) {
  const auto seen = run(testing::lettered_box(), {{0.0, "light 90,40"}, {0.2, "sweep 20 4"}, {2.0, "sweep"}});
  ASSERT_GT(seen.size(), 25u);
  std::size_t begin = 0;
  while (begin < seen.size() && seen[begin].report.view.light_elevation_deg != 20.0) ++begin;
  ASSERT_LT(begin, 6u);
  for (std::size_t k = 0; k < 15; ++k) {
    const ViewState& view = seen[begin + k].report.view;
    EXPECT_NEAR(view.light_azimuth_deg, std::fmod(90.0 + 360.0 * 0.1 * static_cast<double>(k) / 4.0, 360.0), 0.1) << k;
    EXPECT_EQ(view.light_elevation_deg, 20.0);
  }
  EXPECT_NEAR(seen.back().report.view.light_azimuth_deg, 90.0, 1e-9);
  EXPECT_NEAR(seen.back().report.view.light_elevation_deg, 40.0, 1e-9);
}

TEST_F(Seeing, TheLightStandsOverThePlaceOfTheBallThatWasTouched) {
  for (double x = -0.9; x < 1.0; x += 0.3)
    for (double y = -0.9; y < 1.0; y += 0.3) {
      if (std::hypot(x, y) > 0.98 || std::hypot(x, y) < 0.1) continue;
      const LightPlace place = light_over(x, y);
      Light light;
      light.azimuth_deg = place.azimuth_deg;
      light.elevation_deg = place.elevation_deg;
      const glm::dvec3 way = light_direction(light);
      EXPECT_NEAR(way.x, x, 1e-9);
      EXPECT_NEAR(way.y, y, 1e-9);
    }
  EXPECT_EQ(light_over(3.0, 0.0).elevation_deg, 5.0);
  EXPECT_EQ(light_over(3.0, 0.0).azimuth_deg, 90.0);
}

TEST_F(Seeing, TheGlassShowsWhatIsUnderItLargerAndNothingElseChanges) {
  TriMesh mesh = testing::lettered_box();
  const glm::dvec2 at(0.03, 0.02);  // heights of the window from its middle
  const auto seen = run(mesh, {{0.5, "pointer 0.03,0.02"}, {0.6, "magnify 4"}, {2.0, "magnify"}});
  ASSERT_GT(seen.size(), 25u);
  const Image &before = seen[2].image, &with = seen[15].image, &after = seen.back().image;
  EXPECT_EQ(before.pixels, after.pixels);
  const double x0 = 0.5 * kWidth + at.x * kHeight, y0 = 0.5 * kHeight - at.y * kHeight, radius = 0.17 * kHeight;
  int compared = 0, same = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double dx = x + 0.5 - x0, dy = y + 0.5 - y0, r = std::hypot(dx, dy);
      if (r > radius + 2) {
        for (int c = 0; c < 3; ++c) ASSERT_EQ(with.at(x, y)[c], before.at(x, y)[c]) << x << " " << y;
      } else if (r < radius - 8) {
        const int sx = static_cast<int>(std::floor(x0 + dx / 4)), sy = static_cast<int>(std::floor(y0 + dy / 4));
        bool level = true;  // where the small picture has an edge the large one may be on either side of it
        for (int k = -1; k <= 1; ++k)
          for (int c = 0; c < 3; ++c)
            level = level && std::abs(before.at(sx + k, sy)[c] - before.at(sx, sy)[c]) < 6 &&
                    std::abs(before.at(sx, sy + k)[c] - before.at(sx, sy)[c]) < 6;
        if (!level) continue;
        ++compared;
        bool equal = true;
        for (int c = 0; c < 3; ++c) equal = equal && std::abs(with.at(x, y)[c] - before.at(sx, sy)[c]) < 10;
        same += equal ? 1 : 0;
      }
    }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(same, 0.98 * compared) << same << " of " << compared;
}

TEST_F(Seeing, AStateThatIsKeptStandsBesideTheOneThatGoesOn) {
  options_.time.longest_s = 4.6;
  const auto seen =
      run(testing::lettered_box(), {{0.2, "beside"}, {0.5, "side left"}, {3.3, "beside apart"}, {3.8, "beside none"}});
  ASSERT_GT(seen.size(), 41u);
  const auto half = [](const Image& image, bool right) {
    std::vector<int> out;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth / 2; ++x) out.push_back(image.at(x + (right ? kWidth / 2 : 0), y)[1]);
    return out;
  };
  const auto differing = [](const std::vector<int>& a, const std::vector<int>& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += std::abs(a[i] - b[i]) > 20 ? 1 : 0;
    return count;
  };
  const Image &first = seen[4].image, &linked = seen[31].image, &apart = seen[36].image, &alone = seen.back().image;
  const int turned = differing(half(first, false), half(linked, false));
  EXPECT_GT(turned, 500) << "both are turned";
  EXPECT_LT(differing(half(linked, false), half(linked, true)), 100) << "the same state twice, seen from the same side";
  EXPECT_EQ(half(first, false), half(apart, false)) << "the one that is kept is as it was";
  EXPECT_LT(differing(half(linked, true), half(apart, true)), 20) << "the other goes on as it is";
  EXPECT_GT(differing(half(alone, false), half(apart, false)), 5000);
}

TEST_F(Seeing, MarksGoWithTheSurfaceThatIsCutAway) {
  const auto seen =
      run(testing::lettered_box(), {{0.2, "measure_distance -8,0,5 8,0,5"}, {0.8, "cut front 40"}, {1.6, "no_cuts"}});
  ASSERT_GT(seen.size(), 22u);
  const auto amber = [](const Image& image) {
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) count += image.at(x, y)[0] - image.at(x, y)[2] > 90 ? 1 : 0;
    return count;
  };
  EXPECT_GT(amber(seen[6].image), 100);
  EXPECT_EQ(amber(seen[14].image), 0);
  EXPECT_EQ(amber(seen.back().image), amber(seen[6].image));
}

/// Middle of what is amber in these columns.
glm::dvec2 amber_middle(const Image& image, int from, int to) {
  glm::dvec2 sum(0.0);
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = from; x < to; ++x) {
      const auto* p = image.at(x, y);
      if (std::abs(p[0] - 217) > 4 || std::abs(p[1] - 164) > 4 || std::abs(p[2] - 65) > 4) continue;
      sum += glm::dvec2(x + 0.5 - from, y + 0.5);
      ++count;
    }
  EXPECT_GT(count, 20);
  return sum / static_cast<double>(std::max(count, 1));
}

TEST(Picking, FindsTheNearestPlaceInMillimetresWhateverTheGridAndHoweverPartsAreMoved) {
  TriMesh mesh;  // two sheets of 40 x 40 voxels, at 2 and 6 of them
  testing::add_rectangle(mesh, {0, 0, 2}, {40, 0, 0}, {0, 40, 0}, 0);
  testing::add_rectangle(mesh, {0, 0, 6}, {40, 0, 0}, {0, 40, 0}, 1);
  mesh.frame.scale = {2, 2, 4};
  mesh.frame.origin_vox = {5, -3, 1};
  mesh.frame.input_voxel.mm = {0.1, 0.2, -0.05};  // mirrored along z
  PartLooks parts{};
  parts[1].offset_mm = {1, 0, -3};
  const Ray ray{{3, 4, 50}, glm::normalize(glm::dvec3(0.02, -0.01, -1))};
  const auto place = [&](double z) { return ray.from + (z - ray.from.z) / ray.direction.z * ray.direction; };
  const double near = -0.05 * (1 + 4 * 2), far = -0.05 * (1 + 4 * 6) - 3;
  const Picker picker(mesh);
  const auto found = picker.pick(parts, ray);
  ASSERT_TRUE(found);
  EXPECT_LT(glm::distance(found->at_mm, place(near)), 1e-9);
  EXPECT_LT(found->triangle, 2u);
  EXPECT_LT(glm::distance(found->normal, glm::dvec3(0, 0, 1)), 1e-9);
  parts[0].visible = false;
  ASSERT_TRUE(picker.pick(parts, ray));
  EXPECT_LT(glm::distance(picker.pick(parts, ray)->at_mm, place(far)), 1e-9);
  const Ray beside{{8.7, 4, 50}, {0, 0, -1}};  // the sheets end at 8.5 mm, the moved one at 9.5
  EXPECT_TRUE(picker.pick(parts, beside));
  parts[1].offset_mm.x = 0;
  EXPECT_FALSE(picker.pick(parts, beside));
}

/// How far along the ray a triangle is met, by its plane and the senses of its corners around the ray; or infinity.
double met_at(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto side = [&](const glm::dvec3& p, const glm::dvec3& q) {
    return glm::dot(ray.direction, glm::cross(p - ray.from, q - ray.from));
  };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (!((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0))) return INFINITY;
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double at = glm::dot(n, a - ray.from) / glm::dot(n, ray.direction);
  return at > 0 ? at : INFINITY;
}

TEST(Picking, RunsOfTrianglesHideNone) {
  std::mt19937 random(7719);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  TriMesh mesh;  // crumpled balls, one in the other
  for (std::uint8_t ball = 0; ball < 2; ++ball)
    for (int k = 0; k < 4000; ++k) {
      const glm::dvec3 out = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
      const glm::dvec3 u = glm::normalize(glm::cross(out, glm::dvec3(any(random), any(random), any(random))));
      const glm::dvec3 middle = 50.0 + (20.0 + 20.0 * ball + any(random)) * out, v = glm::cross(out, u);
      testing::add_rectangle(mesh, glm::vec3(middle - 0.5 * (u + v)), glm::vec3(u), glm::vec3(v), ball);
    }
  mesh.frame.input_voxel.mm = {0.1, 0.1, 0.2};
  const Picker picker(mesh);
  PartLooks parts{};
  parts[1].offset_mm = {0.3, 1.1, -0.7};
  int met = 0, passed = 0;
  for (int k = 0; k < 300; ++k) {
    parts[1].visible = k % 3 != 0;
    Ray ray{{5 + 4 * any(random), 5 + 4 * any(random), 25}, {0.2 * any(random), 0.2 * any(random), -1.0}};
    if (k % 4 == 0) ray.direction = {0, 0, -1};
    double nearest = INFINITY;
    std::size_t best = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const PartLook& part = parts[mesh.partition_of(t)];
      if (!part.visible) continue;
      std::array<glm::dvec3, 3> p;
      for (std::size_t i = 0; i < 3; ++i)
        p[i] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[mesh.triangles[t][i]])) + part.offset_mm;
      const double at = met_at(ray, p[0], p[1], p[2]);
      if (at < nearest) {
        nearest = at;
        best = t;
      }
    }
    const auto found = picker.pick(parts, ray);
    ASSERT_EQ(found.has_value(), std::isfinite(nearest)) << k;
    ++(found ? met : passed);
    if (!found) continue;
    EXPECT_EQ(found->triangle, best) << k;
    EXPECT_LT(glm::distance(found->at_mm, ray.from + nearest * ray.direction), 1e-9) << k;
  }
  EXPECT_GT(met, 50);
  EXPECT_GT(passed, 20);
}

TEST_F(Seeing, TheRingStandsAtTheDepthOfTheSurfaceForBothEyes) {
  options_.stage.display = testing::spec("side_by_side");
  const auto seen = run(testing::lettered_box(), {{0.2, "pointer 0.1,-0.05"}, {0.3, "cursor"}});
  const Seen& last = seen.back();
  const int half = last.image.width / 2;
  const glm::dvec2 left = amber_middle(last.image, 0, half), right = amber_middle(last.image, half, 2 * half);
  EXPECT_NEAR(left.y, right.y, 0.6);
  // The front of the box (raised letters: 5.05 mm) is at this depth before the panel; eyes are 63 mm apart.
  const double front = (last.screen_from_model * glm::dvec4(0, 0, 5.0, 1.0)).z;
  ASSERT_GT(front, 5.0) << "well before the panel";
  const double eye = last.report.viewer.centre_mm().z;
  const double mm_per_px = options_.stage.screen.width_mm / half;
  EXPECT_NEAR((left.x - right.x) * mm_per_px, 63.0 * front / (eye - front), 1.2 * mm_per_px);
}

}  // namespace
}  // namespace dubsar::app
