// Wedges found on a surface whose wedges are known: a plate on which the phantom's stylus wrote, as a mesh, without a
// scan between.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "core/script/copy_sheet.h"
#include "core/script/find_wedges.h"
#include "core/script/hand_copy.h"

namespace dubsar {
namespace {

struct Pressed {
  double x, y, angle;
};
constexpr double kPlateWidth = 2.0, kPlateDepth = 1.1, kPlateBack = 0.6, kPlateFront = 1.6, kPlateTail = 4.5;
constexpr double kPlateHalf = 22.0, kPlateThick = 4.0, kPlateStep = 0.2;

/// `push`: of the depth, how much clay of a later wedge's place moves into those before it.
double plate_depth(const std::vector<Pressed>& wedges, double x, double y, double push = 0.0) {
  double depth = 0.0;
  for (const Pressed& w : wedges) {
    const double c = std::cos(w.angle), s = std::sin(w.angle), a = c * (x - w.x) + s * (y - w.y),
                 b = std::abs(c * (y - w.y) - s * (x - w.x));
    const double head = std::min(
        kPlateDepth * (1 + a / kPlateBack),
        kPlateDepth * (1 - a / kPlateFront) - b * 2 * kPlateDepth * (1 + kPlateBack / kPlateFront) / kPlateWidth);
    const double tail =
        a < 0 ? 0.0 : 0.6 * kPlateDepth * (1 - a / kPlateTail) - b * 1.2 * kPlateDepth / (0.5 * kPlateWidth);
    const double beside = std::max(0.0, -(a < 0 ? head : std::max(head, tail))) / kPlateDepth;
    if (beside < 1.0) depth = std::max(0.0, depth - push * kPlateDepth * (1 - beside) * (1 - beside));
    depth = std::max({depth, head, tail});
  }
  return depth;
}

/// A closed box whose upper face (z = 0) is written.
TriMesh plate(const std::vector<Pressed>& wedges, double step = kPlateStep, double push = 0.0) {
  TriMesh mesh;
  mesh.frame.input_voxel.mm = glm::dvec3(1.0);
  mesh.frame.input_voxel.provenance = "test";
  const int n = static_cast<int>(2 * kPlateHalf / step);
  const auto add_face = [&](auto&& place, bool turned) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.positions.push_back(glm::vec3(place(i * 1.0 / n, j * 1.0 / n)));
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto at = [&](int u, int v) { return first + static_cast<std::uint32_t>(v * (n + 1) + u); };
        Triangle a{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, b{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
        if (turned) std::swap(a[1], a[2]), std::swap(b[1], b[2]);
        mesh.triangles.push_back(a);
        mesh.triangles.push_back(b);
      }
  };
  const auto at = [](double u) { return kPlateHalf * (2 * u - 1); };
  add_face([&](double u, double v) { return glm::dvec3(at(u), at(v), -plate_depth(wedges, at(u), at(v), push)); },
           false);
  add_face([&](double u, double v) { return glm::dvec3(at(u), at(v), -kPlateThick); }, true);
  for (const double side : {-1.0, 1.0}) {
    add_face([&](double u, double v) { return glm::dvec3(side * kPlateHalf, at(u), -kPlateThick * (1 - v)); },
             side < 0);
    add_face([&](double u, double v) { return glm::dvec3(at(u), side * kPlateHalf, -kPlateThick * (1 - v)); },
             side > 0);
  }
  return mesh;
}

std::vector<Pressed> page_of_wedges() {
  std::vector<Pressed> out;
  std::mt19937 random(5);
  std::normal_distribution<double> tremble(0.0, 0.05);
  int k = 0;
  for (double y = 15.0; y > -18.0; y -= 6.5)
    for (double x = -17.0; x < 15.0; x += 6.5, ++k) {
      constexpr std::array<double, 4> kAngles{0.0, -90.0, -90.0, -45.0};
      out.push_back({x, y, kAngles[static_cast<std::size_t>(k) % 4] * std::numbers::pi / 180.0 + tremble(random)});
    }
  return out;
}

TEST(PressedWedges, AreFoundWhereTheyWerePressed) {
  const std::vector<Pressed> page = page_of_wedges();
  Progress progress;
  const auto found = find_wedges(plate(page), {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  int hit = 0;
  for (const Pressed& w : page) {
    const glm::dvec3 along(std::cos(w.angle), std::sin(w.angle), 0.0),
        head = glm::dvec3(w.x, w.y, 0.0) - kPlateBack * along;
    for (const ScriptWedge& f : found->wedges)
      if (glm::distance(f.head_mm, head) < 0.15 && glm::dot(f.direction, along) > std::cos(0.08)) {
        ++hit;
        double deepest = 0.0;  // of the mesh's vertices
        for (double y = -kPlateHalf; y < kPlateHalf; y += kPlateStep)
          for (double x = -kPlateHalf; x < kPlateHalf; x += kPlateStep)
            if (std::hypot(x - w.x, y - w.y) < 0.4) deepest = std::max(deepest, plate_depth(page, x, y));
        EXPECT_NEAR(f.depth_mm, deepest, 0.08 * kPlateDepth);
        EXPECT_NEAR(f.width_mm, kPlateWidth, 0.15 * kPlateWidth);
        break;
      }
  }
  EXPECT_GE(hit, 0.95 * static_cast<double>(page.size()))
      << found->wedges.size() << " wedges of a usual width of " << found->scale.width_mm << " mm at " << found->places
      << " places";
  EXPECT_LE(found->wedges.size(), page.size() + 1);
}

/// What the stylus of these plates left: head to tail's end, and between the head's corners; less a tenth, as its sharp
/// valleys lie between vertices: half an edge of ten at either corner. Scans are judged by script_bench.
TEST(PressedWedges, AreAsLongAndAsBroadAsWhatTheStylusLeft) {
  Progress progress;
  const auto found = find_wedges(plate(page_of_wedges()), {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  std::vector<double> lengths, widths;
  for (const ScriptWedge& w : found->wedges) {
    lengths.push_back(w.length_mm / (kPlateBack + kPlateTail));
    widths.push_back(w.width_mm / kPlateWidth);
    EXPECT_NEAR(glm::distance(w.head_mm, w.tail_mm), w.length_mm, 0.02 * w.length_mm);
    EXPECT_NEAR(glm::distance(w.corner_mm[0], w.corner_mm[1]), w.width_mm, 1e-9);
  }
  ASSERT_GE(lengths.size(), 20U);
  for (auto* ratios : {&lengths, &widths}) {
    std::sort(ratios->begin(), ratios->end());
    const auto at = [&](double share) {
      return (*ratios)[static_cast<std::size_t>(share * static_cast<double>(ratios->size() - 1))];
    };
    EXPECT_NEAR(at(0.5), 1.0, 0.12) << (ratios == &lengths ? "length" : "width");
    EXPECT_GE(at(0.1), 0.8) << (ratios == &lengths ? "length" : "width");
    EXPECT_LE(at(0.9), 1.2) << (ratios == &lengths ? "length" : "width");
  }
}

/// Patches, tiles and samples are laid by axes: the tablet's own, not those of its file.
TEST(PressedWedges, HowTheMeshLiesDoesNotMatter) {
  const TriMesh lying = plate(page_of_wedges(), 0.8);
  TriMesh turned = lying;
  const glm::dmat3 turn(glm::mat3_cast(glm::normalize(glm::dquat(0.4, -0.7, 0.2, 0.55))));
  for (glm::vec3& p : turned.positions) p = glm::vec3(turn * glm::dvec3(p));
  Progress progress;
  const auto one = find_wedges(lying, {}, progress), other = find_wedges(turned, {}, progress);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(other->scale.width_mm, one->scale.width_mm, 0.01 * one->scale.width_mm);
  ASSERT_EQ(other->wedges.size(), one->wedges.size());
  for (const ScriptWedge& w : one->wedges) {
    double near = 1e30;
    for (const ScriptWedge& o : other->wedges)
      near = std::min(near, glm::distance(turn * w.head_mm, o.head_mm) + glm::distance(turn * w.tail_mm, o.tail_mm) +
                                glm::distance(turn * w.normal, o.normal));
    EXPECT_LT(near, 0.1) << w.order;
  }
}

TEST(PressedWedges, AreAsWideOnACoarseMeshAsOnAFineOne) {
  const std::vector<Pressed> page = page_of_wedges();
  Progress progress;
  for (const double step : {0.2, 0.5, 0.8}) {  // a head is ten, four and two and a half edges wide
    const auto found = find_wedges(plate(page, step), {}, progress);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_NEAR(found->scale.width_mm, kPlateWidth, 0.25 * kPlateWidth) << "edges of " << step << " mm";
  }
}

/// Uprights over horizontals and the other way about.
std::vector<Pressed> page_of_crossings() {
  std::vector<Pressed> page;
  bool upright_first = false;
  for (double y = 14.0; y > -18.0; y -= 7.5)
    for (double x = -15.0; x < 16.0; x += 7.5, upright_first = !upright_first) {
      const Pressed upright{x, y, -std::numbers::pi / 2}, level{x - 1.6, y - 1.2, 0.0};
      page.push_back(upright_first ? upright : level);
      page.push_back(upright_first ? level : upright);
    }
  return page;
}

/// What was pressed later is whole.
TEST(PressedWedges, TheLaterOfTwoIsWhole) {
  const std::vector<Pressed> page = page_of_crossings();
  const std::size_t couples = page.size() / 2;
  const auto pairs = static_cast<double>(couples);
  Progress progress;
  const auto found = find_wedges(plate(page, kPlateStep, 0.15), {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  const auto which = [&](const ScriptWedge& f) {
    std::size_t best = 0;
    const auto off = [&](std::size_t k) {
      const glm::dvec3 along(std::cos(page[k].angle), std::sin(page[k].angle), 0.0);
      return glm::distance(f.head_mm, glm::dvec3(page[k].x, page[k].y, 0.0) - kPlateBack * along) +
             glm::distance(f.direction, along);
    };
    for (std::size_t k = 1; k < page.size(); ++k)
      if (off(k) < off(best)) best = k;
    return best;
  };
  int told = 0, right = 0;
  for (const ScriptWedge& later : found->wedges)
    for (const WedgeBefore& before : later.pressed_after) {
      const std::size_t k = which(later), j = which(found->wedges[static_cast<std::size_t>(before.order) - 1]);
      if (k / 2 != j / 2) continue;
      ++told;
      right += k > j;
    }
  EXPECT_GE(told, 0.8 * pairs) << found->wedges.size() << " wedges, usual width " << found->scale.width_mm << " misfit "
                               << found->scale.misfit << " broad " << found->scale.fitted;
  EXPECT_GE(right, 0.9 * told);
}

TEST(PressedWedges, WhereNoClayWasPushedNoOrderIsTold) {
  Progress progress;
  const auto found = find_wedges(plate(page_of_crossings()), {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_GE(found->wedges.size(), 40U);
  for (const ScriptWedge& w : found->wedges) EXPECT_TRUE(w.pressed_after.empty()) << w.order;
}

TEST(PressedWedges, UnwrittenClayHasNone) {
  Progress progress;
  const auto found = find_wedges(plate({}), {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->wedges.empty());
}

TEST(PressedWedges, TheHandCopyShowsThemWhereTheyAre) {
  const std::vector<Pressed> page = page_of_wedges();
  const TriMesh mesh = plate(page);
  Progress progress;
  const auto found = find_wedges(mesh, {}, progress);
  ASSERT_TRUE(found);
  const auto sheet = hand_copy(mesh, *found, {});
  ASSERT_TRUE(sheet) << sheet.error().message;
  // Heads are as long on paper as on the clay, wherever the sheet puts them.
  std::size_t drawn = 0;
  for (const CopyLayer& layer : sheet->layers)
    for (const CopyGroup& group : layer.groups) {
      ++drawn;
      const ScriptWedge& w = found->wedges[static_cast<std::size_t>(std::stoi(group.id.substr(1))) - 1];
      const auto& head = group.paths.front().points;
      EXPECT_NEAR(glm::distance(head[0], head[1]), glm::distance(w.corner_mm[0], w.corner_mm[1]), 0.02) << group.id;
    }
  EXPECT_EQ(drawn, found->wedges.size());
}

/// The points of each path of this class in an SVG file.
std::vector<std::vector<glm::dvec2>> paths_of(const std::string& svg, const std::string& name) {
  std::vector<std::vector<glm::dvec2>> out;
  const std::string before = "class=\"" + name + "\" d=\"";
  for (std::size_t at = svg.find(before); at != std::string::npos; at = svg.find(before, at)) {
    at += before.size();
    std::string numbers = svg.substr(at, svg.find('"', at) - at);
    for (char& c : numbers)
      if ((c < '0' || c > '9') && c != '.' && c != '-') c = ' ';
    std::istringstream words(numbers);
    out.emplace_back();
    for (glm::dvec2 q; words >> q.x >> q.y;) out.back().push_back(q);
  }
  return out;
}

/// The drawing laid over the side as it is seen orthographically: by its outline, which is the plate's. What the file
/// says is what was pressed: the corners of the stylus's head.
TEST(PressedWedges, CornersOfHeadsInTheSvgLieWhereTheStylusHadThem) {
  const std::vector<Pressed> page = page_of_wedges();
  const TriMesh mesh = plate(page);
  Progress progress;
  const auto found = find_wedges(mesh, {}, progress);
  ASSERT_TRUE(found) << found.error().message;
  HandCopyOptions options;
  options.whole_plate = false;
  const auto sheet = hand_copy(mesh, *found, options);
  ASSERT_TRUE(sheet) << sheet.error().message;
  const std::string svg = svg_of(*sheet);
  const auto outlines = paths_of(svg, "outline");
  ASSERT_FALSE(outlines.empty());
  glm::dvec2 low(1e30), high(-1e30);
  for (const glm::dvec2& q : outlines[0]) low = glm::min(low, q), high = glm::max(high, q);
  // As exact as a cell of the outline's mask on either side.
  EXPECT_NEAR(high.x - low.x, 2 * kPlateHalf, 0.21);
  EXPECT_NEAR(high.y - low.y, 2 * kPlateHalf, 0.21);
  const TabletFrame& frame = found->sides.frame();
  ASSERT_GT(frame.front.z, 0.9);
  const glm::dvec2 middle = 0.5 * (low + high);
  const auto on_paper = [&](const glm::dvec3& p) {  // the plate's middle is at 0
    return glm::dvec2(middle.x + glm::dot(p, frame.right), middle.y - glm::dot(p, frame.up));
  };
  std::vector<std::array<glm::dvec2, 2>> pressed;
  for (const Pressed& w : page) {
    const glm::dvec3 along(std::cos(w.angle), std::sin(w.angle), 0.0), across(-along.y, along.x, 0.0);
    const glm::dvec3 head = glm::dvec3(w.x, w.y, 0.0) - kPlateBack * along;
    pressed.push_back({on_paper(head + 0.5 * kPlateWidth * across), on_paper(head - 0.5 * kPlateWidth * across)});
  }
  double squares = 0.0, corners = 0.0;
  for (const std::vector<glm::dvec2>& drawn : paths_of(svg, "head")) {
    ASSERT_EQ(drawn.size(), 2U);
    double best = 1e30;
    for (const auto& [left, right] : pressed)
      for (const bool turned : {false, true}) {
        const glm::dvec2 a = drawn[turned ? 1 : 0] - left, b = drawn[turned ? 0 : 1] - right;
        best = std::min(best, glm::dot(a, a) + glm::dot(b, b));
      }
    squares += best, corners += 2.0;
  }
  EXPECT_GE(corners, 2 * 0.95 * static_cast<double>(page.size()));
  RecordProperty("rms_mm", std::to_string(std::sqrt(squares / corners)));
  EXPECT_LE(std::sqrt(squares / corners), 0.15);
}

}  // namespace
}  // namespace dubsar
