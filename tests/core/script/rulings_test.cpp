// Rulings, beside those of a plate that is a formula and those of the phantom's obverse, without a scan between.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/phantom/phantom.h"
#include "core/script/correction/wedge_edits.h"
#include "core/script/rulings/find_rulings.h"
#include "tests/core/script/sheet.h"

namespace dubsar {
namespace {

struct Drawn {
  double from, to, up, slope, bend, depth;
  double at(double x) const { return up + slope * x + bend * x * x; }
};

double ruled_height(const std::vector<Drawn>& drawn, double x, double y) {
  double z = -0.002 * (x * x + y * y);  // a cushion
  for (const Drawn& d : drawn)
    if (x > d.from && x < d.to) z -= d.depth * std::exp(-std::pow((y - d.at(x)) / 0.22, 2));
  return z;
}

TEST(Rulings, EndAndRunAsTheyWereDrawnWithinATenthOfAMillimetreInNoise) {
  const std::vector<Drawn> drawn{
      {-17, 16, 9, 0.01, 0.0004, 0.15}, {-12, 17, 1, -0.03, 0, 0.12}, {-17, 3, -8, 0.02, -0.0005, 0.15}};
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0.0, 0.02);
  const TriMesh mesh = sheet_of(20, 0.2, [&](double x, double y) { return ruled_height(drawn, x, y) + noise(random); });
  const auto found = find_rulings(mesh, TextSides{TabletFrame{}}, {});
  ASSERT_EQ(found.size(), drawn.size()) << "seed " << seed;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    EXPECT_EQ(found[k].side, TextSide::kObverse);
    EXPECT_NEAR(found[k].line_mm.front().x, drawn[k].from, 0.5) << k << " seed " << seed;
    EXPECT_NEAR(found[k].line_mm.back().x, drawn[k].to, 0.5) << k << " seed " << seed;
    for (const glm::dvec3& p : found[k].line_mm) EXPECT_NEAR(p.y, drawn[k].at(p.x), 0.25) << k << " seed " << seed;
    EXPECT_NEAR(found[k].depth_mm, drawn[k].depth, 0.4 * drawn[k].depth) << k << " seed " << seed;
  }
}

TEST(Rulings, LevelClayScratchesAndRowsOfPitsAreNone) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0.0, 0.02);
  const TriMesh level = sheet_of(20, 0.2, [&](double, double) { return noise(random); });
  EXPECT_TRUE(find_rulings(level, TextSides{TabletFrame{}}, {}).empty()) << "seed " << seed;
  // A scratch of 5 mm, and a row of pits on half of a line: horizontals that nobody found.
  const TriMesh pits = sheet_of(20, 0.2, [&](double x, double y) {
    double z = noise(random);
    if (std::abs(x) < 2.5) z -= 0.15 * std::exp(-std::pow((y - 6) / 0.22, 2));
    if (std::fmod(x + 40.0, 4.0) < 2.0) z -= 0.7 * std::exp(-std::pow((y + 5) / 0.5, 2));
    return z;
  });
  EXPECT_TRUE(find_rulings(pits, TextSides{TabletFrame{}}, {}).empty()) << "seed " << seed;
}

/// The phantom's obverse as a sheet, its wedges as people would draw them, and its lines; mm along right, up and front.
struct Obverse {
  TriMesh mesh;
  std::vector<ScriptWedge> wedges;
  std::vector<std::vector<glm::dvec3>> lines;
};

Obverse obverse_of(const phantom::Phantom& truth, double step_mm) {
  Obverse out;
  glm::dvec3 right(0), front(0);
  for (const phantom::Wedge& w : truth.wedges())
    if (w.owner == phantom::Owner::kTablet && w.side == phantom::Side::kObverse)
      right = w.place.right, front += w.outward;
  front = glm::normalize(front - glm::dot(front, right) * right);
  const glm::dvec3 up = glm::cross(front, right);
  const double mm = truth.options().voxel_mm;
  const auto flat = [&](const glm::dvec3& p) {
    return mm * glm::dvec3(glm::dot(p, right), glm::dot(p, up), glm::dot(p, front));
  };
  for (const phantom::RuledLine& line : truth.ruled_lines()) {
    if (line.owner != phantom::Owner::kTablet || line.side != phantom::Side::kObverse) continue;
    auto& places = out.lines.emplace_back();
    for (const glm::dvec3& p : line.points) places.push_back(flat(p));
  }
  glm::dvec3 middle(0);
  double highest = -1e30;
  int count = 0;
  for (const phantom::Wedge& w : truth.wedges()) {
    if (w.owner != phantom::Owner::kTablet || w.side != phantom::Side::kObverse) continue;
    const glm::dvec3 across = w.head_half_width * glm::cross(w.outward, w.tail);
    const glm::dvec3 corner[2]{flat(w.place.head + across), flat(w.place.head - across)};
    const glm::dvec3 n = flat(w.outward);
    if (auto drawn =
            drawn_wedge({{corner[0], corner[1]}, flat(w.place.end), glm::normalize(n)}, TextSides{TabletFrame{}}))
      out.wedges.push_back(*drawn);
    middle += flat(w.position);
    highest = std::max(highest, flat(w.position).z);
    ++count;
  }
  middle /= count;
  const double half = 34.0;
  const auto grid = [&](double x, double y, double z) { return (x * right + y * up + z * front) / mm; };
  out.mesh = sheet_of(half, step_mm, [&](double x, double y) {
    double z = highest + 1.0;
    for (int k = 0; k < 60 && z > highest - 9.0; ++k) {
      const double d = mm * truth.tablet_distance(grid(middle.x + x, middle.y + y, z));
      z -= 0.8 * d;
      if (std::abs(d) < 0.003) break;
    }
    return z;
  });
  for (glm::vec3& p : out.mesh.positions) p += glm::vec3(middle.x, middle.y, 0);
  std::erase_if(out.mesh.triangles, [&](const Triangle& t) {  // beyond the edge
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return out.mesh.positions[v].z < highest - 8.0; });
  });
  return out;
}

double off_line(const std::vector<glm::dvec3>& line, const glm::dvec3& p) {
  double best = 1e30;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const glm::dvec2 a(line[k - 1]), b(line[k]), q(p), along = b - a;
    const double t = std::clamp(glm::dot(q - a, along) / glm::dot(along, along), 0.0, 1.0);
    best = std::min(best, glm::distance(q, a + t * along));
  }
  return best;
}

TEST(Rulings, ThePhantomsAreFoundWithTheirEndsWithinHalfAMillimetre) {
  int wanted = 0, found_of = 0, falsely = 0, ends = 0, near = 0;
  for (const std::uint64_t seed : {811001u, 811002u}) {
    phantom::PhantomOptions options;
    options.dims = {256, 160, 240};
    options.seed = seed;
    const auto truth = phantom::Phantom::create(options);
    ASSERT_TRUE(truth) << truth.error().message;
    const Obverse side = obverse_of(**truth, 0.2);
    const auto found = find_rulings(side.mesh, TextSides{TabletFrame{}}, side.wedges);
    std::vector<char> used(side.lines.size(), 0);
    for (const ScriptRuling& ruling : found) {
      if (ruling.side != TextSide::kObverse) continue;
      const auto on = [&](const std::vector<glm::dvec3>& line) {
        return std::count_if(ruling.line_mm.begin(), ruling.line_mm.end(), [&](const glm::dvec3& p) {
                 return off_line(line, p) < 0.5;
               }) > static_cast<std::ptrdiff_t>(ruling.line_mm.size() * 8 / 10);
      };
      const auto at = std::find_if(side.lines.begin(), side.lines.end(), on);
      if (at == side.lines.end()) {
        ++falsely;
        continue;
      }
      used[static_cast<std::size_t>(at - side.lines.begin())] = 1;
      for (const double off : {ruling.line_mm.front().x - at->front().x, ruling.line_mm.back().x - at->back().x}) {
        ++ends;
        near += std::abs(off) <= 0.5 ? 1 : 0;
        std::printf("seed %d end off %.2f mm, at %.1f of %.1f to %.1f\n", static_cast<int>(seed), off,
                    ruling.line_mm.front().y, at->front().x, at->back().x);
      }
    }
    wanted += static_cast<int>(side.lines.size());
    found_of += static_cast<int>(std::count(used.begin(), used.end(), 1));
  }
  std::printf("%d of %d found, %d falsely, %d of %d ends within .5 mm\n", found_of, wanted, falsely, near, ends);
  EXPECT_EQ(falsely, 0);
  EXPECT_GE(found_of, wanted - 1);
  EXPECT_GE(near, ends * 9 / 10);
}

}  // namespace
}  // namespace dubsar
