// How far two eyes converge on what any display shows, by the lines from its cameras through its panel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "display/optics/comfort.h"
#include "display/panels/panel_set.h"
#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar {
namespace {

constexpr double kDeg = 180.0 / std::numbers::pi, kApartMm = 63.0;

glm::dvec3 eye_of(const View& view) { return glm::inverse(view.view_from_world)[3]; }

/// Where the panel's plane, z = 0, is lit for a point of the world. The cameras' plane of no parallax is the panel.
glm::dvec3 on_panel(const View& view, const glm::dvec3& at) {
  const auto ndc = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(p, 1.0);
    return glm::dvec2(clip) / clip.w;
  };
  const glm::dvec2 origin = ndc({0, 0, 0}), seen = ndc(at);
  return {(seen - origin) / glm::dvec2((ndc({1, 0, 0}) - origin).x, (ndc({0, 1, 0}) - origin).y), 0.0};
}

/// How much more two eyes converge on a point, as these two cameras show it, than on the panel there; from above.
double more_deg(const View& left, const View& right, const glm::dvec3& l, const glm::dvec3& r, const glm::dvec3& at) {
  const glm::dvec3 on_l = on_panel(left, at), on_r = on_panel(right, at);
  const auto aside = [](const glm::dvec3& eye, const glm::dvec3& seen) { return std::atan2(seen.x - eye.x, eye.z); };
  const glm::dvec3 middle = 0.5 * (on_l + on_r);
  return kDeg * ((aside(l, on_l) - aside(r, on_r)) - (aside(l, middle) - aside(r, middle)));
}

/// `eyes`: where these cameras stand. The most of all pairs of cameras that two eyes can be at, and all points of a
/// box.
double most_deg(std::span<const View> views, std::span<const glm::dvec3> eyes, double front_mm, double back_mm) {
  double most = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      if (views.size() > 2 && glm::distance(eyes[i], eyes[j]) > kApartMm) break;
      for (const double z : {front_mm, 0.5 * front_mm, 0.5 * back_mm, back_mm})
        for (const double x : {-40.0, 0.0, 30.0})
          for (const double y : {-20.0, 0.0})
            most = std::max(most, std::abs(more_deg(views[i], views[j], eyes[i], eyes[j], {x, y, z})));
    }
  return most;
}

/// Every kind of display, and every panel that is known by its name.
std::vector<std::string> displays() {
  std::vector<std::string> out{
      "mono",     "side_by_side", "top_bottom:full", "interlaced",
      "anaglyph", "quad_buffer",  "shutter",         "quilt:columns=8,rows=6,width=800,height=600,aspect=.75,cone=40"};
  for (const PanelProfile& panel : built_in_panels().profiles) {
    const bool lenses = panel.sheet || panel.optics;
    if (lenses) out.push_back("lenticular:" + panel.name);
    if (panel.quilt.views() > 0) out.push_back("quilt:" + panel.name);
  }
  return out;
}

TEST(Parallax, OfWhateverADisplayShowsIsWithinADegree) {
  const SinkCatalog catalog;
  int deep = 0;
  for (const std::string& name : displays()) {
    auto sink = catalog.make(name);
    ASSERT_TRUE(sink) << sink.error().message;
    ASSERT_TRUE((*sink)->configure(Screen()));
    for (const double half_mm : {10.0, 60.0, 250.0}) {
      Observer viewer;
      viewer.front_mm = half_mm;
      viewer.back_mm = -half_mm;
      const auto given = (*sink)->views(viewer);
      const std::vector<View> plain(given.begin(), given.end());
      std::vector<glm::dvec3> eyes;
      for (const View& view : plain) eyes.push_back(eye_of(view));
      viewer.depth_factor = easy_depth_factor(eyes_before(plain, kApartMm), half_mm, -half_mm, kEasyParallaxDeg);
      const auto flat = (*sink)->views(viewer);
      const double before = most_deg(plain, eyes, std::min(half_mm, 200.0), -half_mm);
      const double after = most_deg(flat, eyes, half_mm, -half_mm);
      EXPECT_LE(after, 1.001 * kEasyParallaxDeg) << name << ", " << half_mm << " mm";
      deep += before > 1.1 * kEasyParallaxDeg;
      if (viewer.depth_factor == 1.0) {
        EXPECT_LE(before, 1.001 * kEasyParallaxDeg) << name;
      } else if (plain.size() == 2) {
        EXPECT_GE(after, 0.9 * kEasyParallaxDeg) << name << " is flatter than it has to be";
      }
    }
  }
  EXPECT_GE(deep, 20) << "else nothing had to be flattened";
}

}  // namespace
}  // namespace dubsar
