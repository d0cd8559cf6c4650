// Wedges as people draw, move and point at them.

#include "core/script/correction/wedge_edits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace dubsar {
namespace {

const TextSides kSides{TabletFrame{}};

ScriptWedge level_wedge(const glm::dvec3& head, double angle, double length, double width) {
  const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), across(-std::sin(angle), std::cos(angle), 0);
  return *drawn_wedge({{head + 0.5 * width * across, head - 0.5 * width * across}, head + length * along, {0, 0, 1}},
                      kSides);
}

TEST(WedgeEdits, ADrawnWedgeIsAsItsThreePlacesSayWhicheverEndIsClickedFirst) {
  for (const bool swapped : {false, true}) {
    const glm::dvec3 a(0, 1, 0), b(0, -1, 0);
    const auto w = drawn_wedge({{swapped ? b : a, swapped ? a : b}, {5, 0, 0}, {0, 0, 1}}, kSides);
    ASSERT_TRUE(w);
    EXPECT_EQ(w->kind, WedgeKind::kHorizontal);
    EXPECT_EQ(w->side, TextSide::kObverse);
    EXPECT_EQ(w->by, WedgeBy::kPerson);
    EXPECT_DOUBLE_EQ(w->width_mm, 2.0);
    EXPECT_DOUBLE_EQ(w->length_mm, 5.0);
    EXPECT_EQ(w->corner_mm[0], a) << "left of the tail's direction";
    EXPECT_EQ(w->corner_mm[1], b);
  }
  EXPECT_EQ(level_wedge({0, 0, 0}, -1.5708, 4, 1).kind, WedgeKind::kVertical);
  EXPECT_FALSE(drawn_wedge({{glm::dvec3(0), glm::dvec3(0)}, {5, 0, 0}, {0, 0, 1}}, kSides)) << "no width";
  EXPECT_FALSE(drawn_wedge({{glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)}, {0, 0, 3}, {0, 0, 1}}, kSides))
      << "the tail goes into the clay";
}

TEST(WedgeEdits, AMovedWedgeKeepsItsShapeUnderAnyTurn) {
  std::mt19937 random(std::random_device{}());
  const auto real = [&] { return std::uniform_real_distribution<>(-1, 1)(random); };
  ScriptWedge w = level_wedge({1, 2, 3}, 0.3, 4, 1.5);
  w.by = WedgeBy::kMachine;
  w.tip_mm = w.head_mm + 0.3 * w.direction - 0.8 * w.normal;
  w.depth_mm = 0.8;
  for (int k = 0; k < 20; ++k) {
    const glm::dquat turn = glm::normalize(glm::dquat(real(), real(), real(), real()));
    const glm::dvec3 head(real(), real(), real());
    const auto moved = moved_wedge(w, head, head + turn * (w.tail_mm - w.head_mm), turn * w.normal, kSides);
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->by, WedgeBy::kCorrected) << "the machine found it, a person moved it";
    for (const int c : {0, 1})
      EXPECT_NEAR(glm::distance(moved->corner_mm[c], head + turn * (w.corner_mm[c] - w.head_mm)), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(moved->tip_mm, head + turn * (w.tip_mm - w.head_mm)), 0.0, 1e-9);
    EXPECT_NEAR(moved->length_mm, w.length_mm, 1e-9);
    EXPECT_EQ(moved->width_mm, w.width_mm);
  }
}

TEST(WedgeEdits, APlaceIsThatOfTheWedgeItLiesIn) {
  std::vector<ScriptWedge> wedges{level_wedge({0, 0, 0}, 0, 6, 2), level_wedge({4, 0, 0}, -1.5708, 4, 2)};
  wedges[0].tip_mm = {0.4, 0, -1};
  wedges[1].tip_mm = {4, -0.4, -1};
  EXPECT_EQ(wedge_at(wedges, {0.5, 0.3, -0.5}), 0u);
  EXPECT_EQ(wedge_at(wedges, {4.2, -0.3, 0}), 1u) << "in both: its deepest place is nearer";
  EXPECT_EQ(wedge_at(wedges, {0.0, 1.4, 0}), 0u) << "a quarter of a width beside it";
  EXPECT_FALSE(wedge_at(wedges, {0.0, 1.6, 0})) << "level here";
  EXPECT_FALSE(wedge_at(wedges, {0.5, 0.3, -9})) << "the other side of the tablet";
  EXPECT_FALSE(wedge_at({}, {0, 0, 0}));
}

TEST(WedgeEdits, NumbersFollowTheOrderAndWhatWasPressedBeforeFollowsThem) {
  std::vector<ScriptWedge> wedges(4);
  for (int k = 0; k < 4; ++k) wedges[static_cast<std::size_t>(k)].order = k + 1;
  wedges[3].pressed_after = {{1, 0.1}, {2, 0.2}};
  wedges.erase(wedges.begin());     // the first is deleted
  std::swap(wedges[0], wedges[1]);  // and the third goes before the second
  number_in_order(wedges);
  EXPECT_EQ(wedges[0].order, 1);
  EXPECT_EQ(wedges[2].order, 3);
  ASSERT_EQ(wedges[2].pressed_after.size(), 1u);
  EXPECT_EQ(wedges[2].pressed_after[0].order, 2);
}

}  // namespace
}  // namespace dubsar
