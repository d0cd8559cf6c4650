// Cracks and sealings, beside those of plates that are formulas and of a phantom's envelope without a scan between.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <tuple>

#include "core/mesh/evidence.h"
#include "core/phantom/phantom.h"
#include "core/script/correction/wedge_edits.h"
#include "core/script/hand_copy.h"
#include "core/script/marks/script_marks.h"
#include "core/script/wedge_table.h"
#include "tests/core/script/mark_score.h"
#include "tests/core/script/sheet.h"

namespace dubsar {
namespace {

const TextSides kUpright{TabletFrame{}};

/// A bent gap from x = -9 to 7, as wide as `width`.
bool in_gap(double x, double y, double width) {
  return x > -9.0 && x < 7.0 && std::abs(y - 2.0 * std::sin(0.4 * x) - 0.2 * x) < 0.5 * width;
}

TEST(Cracks, ABentGapIsFoundAlongItsWayWhetherItsFloorIsSeenOrNot) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0.0, 0.02);
  for (const double floor : {-2.0, static_cast<double>(NAN)}) {
    const TriMesh mesh = sheet_of(15, 0.15, [&](double x, double y) {
      return -0.002 * (x * x + y * y) + noise(random) + (in_gap(x, y, 0.6) ? floor : 0.0);
    });
    const auto found = find_cracks(mesh, kUpright);
    ASSERT_EQ(found.size(), 1u) << "seed " << seed;
    EXPECT_EQ(found[0].side, TextSide::kObverse);
    const auto ends = std::minmax_element(found[0].line_mm.begin(), found[0].line_mm.end(),
                                          [](const auto& a, const auto& b) { return a.x < b.x; });
    EXPECT_NEAR(ends.first->x, -9.0, 0.5) << "seed " << seed;
    EXPECT_NEAR(ends.second->x, 7.0, 0.5) << "seed " << seed;
    for (const glm::dvec3& p : found[0].line_mm) {
      EXPECT_TRUE(in_gap(p.x, p.y, 1.2)) << p.x << " " << p.y << " seed " << seed;
      EXPECT_NEAR(p.z, -0.002 * (p.x * p.x + p.y * p.y), 0.15) << "seed " << seed;
    }
  }
}

TEST(Cracks, GroovesScratchesPoresAndGapsOfWallsThatMeetAtNinetyDegreesAreNone) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0.0, 0.02);
  const TriMesh mesh = sheet_of(15, 0.15, [&](double x, double y) {
    double z = noise(random);
    z -= std::max(0.0, 1.2 - 1.6 * std::abs(y - 8.0));                       // a tail along all of it
    z -= std::abs(y + 0.3 * x) < 0.2 ? 0.3 : 0.0;                            // a scratch as deep as wide
    z -= std::hypot(x - 5.0, y + 10.0) < 0.5 ? 2.0 : 0.0;                    // a pore
    z -= std::max(std::abs(x + 8.0), std::abs(y + 10.0)) < 2.0 ? 2.0 : 0.0;  // what broke away
    return z;
  });
  EXPECT_TRUE(find_cracks(mesh, kUpright).empty()) << "seed " << seed;
}

TEST(Sealings, LevelClayPitsGroovesAndAStepAreNone) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0.0, 0.02);
  const TriMesh mesh = sheet_of(18, 0.25, [&](double x, double y) {
    double z = noise(random) + 0.2 * std::sin(0.6 * x) * std::sin(0.5 * y);
    if (y > 4 && std::fmod(x + 40.0, 4.0) < 2.0)
      z -= 0.7 * std::exp(-std::pow(std::fmod(y + 50.0, 4.0) - 2.0, 2) / 0.3);
    if (std::fmod(y + 40.0, 4.0) < 0.4) z -= 0.15;
    return x > 10 ? z - 1.0 : z;
  });
  EXPECT_TRUE(find_sealings(mesh, kUpright, {}).empty()) << "seed " << seed;
}

/// A broad side of a phantom's envelope as a sheet in the scan's frame; `sides`: it is the obverse.
TriMesh envelope_side(const phantom::Phantom& truth, phantom::Side side, double step_mm, TextSides& sides) {
  glm::dvec3 right(0), front(0), middle(0);
  double count = 0;
  for (const phantom::Wedge& w : truth.wedges())
    if (w.owner == phantom::Owner::kEnvelope && w.side == side)
      right = w.place.right, front += w.outward, middle += w.position, ++count;
  front = glm::normalize(front - glm::dot(front, right) * right);
  const glm::dvec3 up = glm::cross(front, right);
  TabletFrame frame;
  frame.right = right, frame.up = up, frame.front = front;
  sides = TextSides(frame);
  const double mm = truth.options().voxel_mm;
  middle /= count;
  TriMesh mesh = sheet_of(29.5, step_mm, [&](double x, double y) {
    double z = 4.0;
    for (int k = 0; k < 80 && z > -6.0; ++k) {
      const double d = mm * truth.signed_distance(middle + (x * right + y * up + z * front) / mm);
      z -= 0.8 * d;
      if (std::abs(d) < 0.003) break;
    }
    return z > -6.0 ? z : static_cast<double>(NAN);
  });
  for (glm::vec3& p : mesh.positions)
    p = glm::vec3(middle * mm + static_cast<double>(p.x) * right + static_cast<double>(p.y) * up +
                  static_cast<double>(p.z) * front);
  return mesh;
}

/// The envelope's wedges as people would draw them.
std::vector<ScriptWedge> pressed_wedges(const phantom::Phantom& truth, const TextSides& sides) {
  std::vector<ScriptWedge> out;
  const double mm = truth.options().voxel_mm;
  for (const phantom::Wedge& w : truth.wedges()) {
    if (w.owner != phantom::Owner::kEnvelope) continue;
    const glm::dvec3 across = w.head_half_width * glm::cross(w.outward, w.tail);
    auto drawn =
        drawn_wedge({{mm * (w.place.head + across), mm * (w.place.head - across)}, mm * w.place.end, w.outward}, sides);
    if (!drawn) continue;
    drawn->depth_mm = mm * w.depth;
    out.push_back(*drawn);
  }
  return out;
}

TEST(Sealings, ThoseOfAPhantomsEnvelopeAreOutlined) {
  MarkScore all;
  for (const std::uint64_t seed : {821001u, 821002u}) {
    phantom::PhantomOptions options;
    options.dims = {256, 160, 240};
    options.seed = seed;
    const auto truth = phantom::Phantom::create(options);
    ASSERT_TRUE(truth) << truth.error().message;
    TextSides sides;
    const TriMesh mesh = envelope_side(**truth, phantom::Side::kObverse, 0.25, sides);
    const std::vector<ScriptWedge> wedges = pressed_wedges(**truth, sides);
    all.add(judge_marks(**truth, mesh, sides, phantom::Owner::kEnvelope, find_cracks(mesh, sides),
                        find_sealings(mesh, sides, wedges)));
  }
  std::printf("%s\n", all.text().c_str());
  EXPECT_GE(all.sealed_found, 0.85 * all.sealed);
  EXPECT_GE(all.outlined_real, 0.9 * all.outlined);
  EXPECT_EQ(all.sealings_false, 0);
}

/// Of the side that a sheet shows: its rim seen from the edges is no surface.
std::vector<ScriptCrack> of_sheet(std::vector<ScriptCrack> cracks) {
  std::erase_if(cracks, [](const ScriptCrack& crack) { return crack.side != TextSide::kObverse; });
  return cracks;
}

TEST(Cracks, ThoseOfPhantomsEnvelopesAreFoundAndNothingElse) {
  MarkScore all;
  int cracked = 0, whole = 0;
  for (std::uint64_t seed = 822001; cracked < 1 || whole < 1; ++seed) {
    phantom::PhantomOptions options;
    options.dims = {256, 160, 240};
    options.seed = seed;
    const auto truth = phantom::Phantom::create(options);
    ASSERT_TRUE(truth) << truth.error().message;
    if (((*truth)->cracked() ? cracked : whole)++ > 0) continue;
    TextSides sides;
    const TriMesh mesh = envelope_side(**truth, phantom::Side::kReverse, 0.25, sides);
    all.add(judge_marks(**truth, mesh, sides, phantom::Owner::kEnvelope, of_sheet(find_cracks(mesh, sides)), {}));
  }
  std::printf("%s\n", all.text().c_str());
  EXPECT_GE(all.wall_found, 0.6 * all.wall);
  EXPECT_GE(all.line_real, 0.9 * all.line);
  EXPECT_EQ(all.cracks_false, 0);
}

TEST(Marks, OfASurfaceThatTouchesAnotherRulingsAloneAreTold) {
  TriMesh mesh = sheet_of(15, 0.15, [](double x, double y) { return in_gap(x, y, 0.6) ? -2.0 : 0.0; });
  EXPECT_EQ(find_marks(mesh, kUpright, {}).cracks.size(), 1u);
  mesh.evidence.assign(mesh.positions.size(), evidence_byte(Evidence::kMeasured));
  EXPECT_EQ(find_marks(mesh, kUpright, {}).cracks.size(), 1u);
  std::fill_n(mesh.evidence.begin(), mesh.evidence.size() / 20, evidence_byte(Evidence::kInferred));
  EXPECT_TRUE(find_marks(mesh, kUpright, {}).cracks.empty());
}

TEST(Marks, EachKindHasALayerOfItsOwnInDrawingsAndAListInTables) {
  const TriMesh mesh = sheet_of(10, 1.0, [](double, double) { return 0.0; });
  HandCopyOptions options;
  options.marks.rulings = {{TextSide::kObverse, {{-8, 2, 0}, {8, 2, 0}}, 0.1, 20.0}};
  options.marks.cracks = {{TextSide::kObverse, {{-5, -3, 0}, {0, -1, 0}, {4, -2, 0}}, 0.4}};
  options.marks.sealings = {{TextSide::kObverse, {{-9, -9, 0}, {9, -9, 0}, {9, -5, 0}, {-9, -5, 0}}, 0.2}};
  WedgesFound found;
  found.sides = kUpright;
  const auto sheet = hand_copy(mesh, found, options);
  ASSERT_TRUE(sheet) << sheet.error().message;
  for (const auto& [layer, kind, places, closed] : {std::tuple("obverse-rulings", "ruling machine", 2u, false),
                                                    std::tuple("obverse-cracks", "crack machine", 3u, false),
                                                    std::tuple("obverse-seals", "seal machine", 4u, true)}) {
    const auto at =
        std::find_if(sheet->layers.begin(), sheet->layers.end(), [&](const CopyLayer& l) { return l.id == layer; });
    ASSERT_NE(at, sheet->layers.end()) << layer;
    ASSERT_EQ(at->groups.size(), 1u) << layer;
    EXPECT_EQ(at->groups[0].classes, kind);
    ASSERT_EQ(at->groups[0].paths.size(), 1u);
    EXPECT_EQ(at->groups[0].paths[0].points.size(), places);
    EXPECT_EQ(at->groups[0].paths[0].closed, closed);
  }
  EXPECT_NE(dxf_of(*sheet).find("OBVERSE-CRACKS"), std::string::npos);
  const auto json = nlohmann::json::parse(wedges_json(found, "dubsar 1", options.marks));
  EXPECT_EQ(json["rulings"][0]["line"].size(), 2u);
  EXPECT_EQ(json["cracks"][0]["line"][2][0], 4.0);
  EXPECT_EQ(json["cracks"][0]["width_mm"], 0.4);
  EXPECT_EQ(json["seals"][0]["outline"].size(), 4u);
  EXPECT_EQ(json["seals"][0]["side"], "obverse");
}

}  // namespace
}  // namespace dubsar
