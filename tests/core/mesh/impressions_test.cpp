// Where tails point, of pyramids that this file presses by itself: three planes, made with no template of the program.

#include "core/mesh/writing/impressions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <random>

#include "core/mesh/writing/tail_directions.h"

namespace dubsar {
namespace {

struct Wedge {
  glm::dvec2 head;       // middle of the head's edge, steps
  double direction_deg;  // of the tail
  double width, length;  // steps
};

/// Depth below the plane in steps: three planes through the deepest point, each of which leaves the clay along one edge
/// of the triangle of the head's two corners and the tail's end.
double depth_of(const Wedge& w, const glm::dvec2& p) {
  const double a = w.direction_deg * std::numbers::pi / 180.0;
  const glm::dvec2 along(std::cos(a), std::sin(a)), across(-along.y, along.x);
  const std::array<glm::dvec2, 3> corners{w.head - 0.5 * w.width * across, w.head + w.length * along,
                                          w.head + 0.5 * w.width * across};
  const glm::dvec2 deepest = w.head + 0.3 * w.width * along;
  double depth = 0.5 * w.width;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 edge = glm::normalize(corners[(k + 1) % 3] - corners[k]), inwards(-edge.y, edge.x);
    const double here = glm::dot(p - corners[k], inwards), there = glm::dot(deepest - corners[k], inwards);
    depth = std::min(depth, 0.5 * w.width * here / there);
  }
  return std::max(0.0, depth);
}

HeightMap pressed_sheet(int width, int height, const std::vector<Wedge>& wedges, double rise = 0.0) {
  HeightMap map;
  map.width = width;
  map.height = height;
  map.step_mm = 0.17;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = 2.0 * x / width - 1.0, v = 2.0 * y / height - 1.0;
      double z = -rise * (u * u + v * v);
      for (const Wedge& w : wedges) {
        const glm::dvec2 p(x, y);
        if (glm::distance(p, w.head) < 2.0 * w.length) z = std::min(z, -rise * (u * u + v * v) - depth_of(w, p));
      }
      map.mm.push_back(static_cast<float>(map.step_mm * z));
    }
  return map;
}

double off_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

TEST(Impressions, TailsPointWhereTheyWerePressedTo) {
  std::mt19937 random(20260408);
  std::uniform_real_distribution<double> any(0.0, 360.0), width(6.0, 11.0), longer(1.5, 2.6);
  std::vector<Wedge> wedges;
  for (int y = 40; y < 360; y += 40)
    for (int x = 40; x < 360; x += 40) {
      const double w = width(random);
      wedges.push_back({{x, y}, any(random), w, longer(random) * w});
    }
  const HeightMap map = pressed_sheet(400, 400, wedges, 12.0);
  int right = 0;
  for (const Wedge& w : wedges) {
    double least = 1e9, off = 180.0;
    for (const FoundWedge& i : find_impressions(map)) {
      const glm::dvec2 at(i.x * 399.f, i.y * 399.f);
      if (const double d = glm::distance(at, w.head); d < least) {
        least = d;
        off = off_deg(360.0 * i.tail / kTailDirections, w.direction_deg);
      }
    }
    if (least < w.width && off < 20.0) ++right;
  }
  EXPECT_GE(right, static_cast<int>(0.9 * static_cast<double>(wedges.size()))) << "of " << wedges.size();
}

TEST(Impressions, LevelAndCurvedClayAndRulingsAreNone) {
  EXPECT_TRUE(find_impressions(pressed_sheet(200, 160, {})).empty());
  EXPECT_TRUE(find_impressions(pressed_sheet(200, 160, {}, 15.0)).empty());
  HeightMap ruled = pressed_sheet(200, 160, {});
  for (int y = 0; y < ruled.height; ++y)
    for (int x = 0; x < ruled.width; ++x)
      ruled.mm[ruled.index(x, y)] -= y % 30 < 3 ? 0.08f * static_cast<float>(kStepsPerWedge * ruled.step_mm) : 0.f;
  EXPECT_TRUE(find_impressions(ruled).empty());
  EXPECT_TRUE(find_impressions(HeightMap{}).empty());
}

std::vector<FoundWedge> tails(int horizontals, int verticals, int any) {
  std::vector<FoundWedge> out;
  for (int i = 0; i < horizontals; ++i) out.push_back({0});
  for (int i = 0; i < verticals; ++i) out.push_back({3 * kTailDirections / 4});
  for (int i = 0; i < any; ++i) out.push_back({i % kTailDirections});
  return out;
}

std::vector<FoundWedge> turned(std::vector<FoundWedge> all, int quarters) {
  for (FoundWedge& i : all) i.tail = (i.tail + quarters * kTailDirections / 4) % kTailDirections;
  return all;
}

std::vector<FoundWedge> mirrored(std::vector<FoundWedge> all) {
  for (FoundWedge& i : all) i.tail = (kTailDirections / 2 - i.tail + kTailDirections) % kTailDirections;
  return all;
}

TEST(TextTurns, AreFoundByQuartersAndAlsoOfMirrorImages) {
  for (const auto& text : {tails(30, 25, 20), tails(10, 40, 20), tails(40, 10, 20)})
    for (int quarters = 0; quarters < 4; ++quarters) {
      const TextTurns found = text_turns(turned(text, quarters)), image = text_turns(turned(mirrored(text), quarters));
      for (int other = 0; other < 4; ++other) {
        const auto k = static_cast<std::size_t>(other), best = static_cast<std::size_t>(quarters);
        if (other == quarters) continue;
        EXPECT_GT(found.written[best], found.written[k] + 3.0) << quarters << other;
        EXPECT_GT(image.mirrored[best], image.mirrored[k] + 3.0) << quarters << other;
      }
    }
}

TEST(TextTurns, MarksWithoutADirectionSayNothing) {
  const TextTurns nothing = text_turns({});
  const TextTurns grain = text_turns(tails(0, 0, 480));
  const TextTurns leaning = text_turns(tails(20, 0, 480));  // the grain of clay or of a mesh, which prefers one
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(nothing.written[k], 0.0);
    EXPECT_EQ(nothing.mirrored[k], 0.0);
    EXPECT_NEAR(grain.written[k], grain.written[0], 1e-9);
    EXPECT_NEAR(leaning.written[k], leaning.written[0], 0.01);
  }
}

}  // namespace
}  // namespace dubsar
