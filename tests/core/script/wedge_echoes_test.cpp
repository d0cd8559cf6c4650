// What is drawn twice is taken out, what stands below another is not.

#include "core/script/wedge_echoes.h"

#include <gtest/gtest.h>

#include "core/script/wedge_measure.h"

namespace dubsar {
namespace {

ScriptWedge vertical_at(double x, double y, double depth) {
  ScriptWedge w;
  w.direction = {0, -1, 0};
  w.width_mm = 2.0, w.depth_mm = depth, w.length_mm = 6.0;
  w.head_mm = {x, y, 0}, w.tip_mm = {x, y - 0.6, -depth}, w.tail_mm = {x, y - 6.0, 0};
  return w;
}

TEST(WedgeEchoes, AShallowOneInTheTailOfADeepOneIsTheSame) {
  std::vector<ScriptWedge> wedges{vertical_at(0, 0, 1.0), vertical_at(0.3, -2.5, 0.5)};
  drop_echoes(wedges);
  ASSERT_EQ(wedges.size(), 1u);
  EXPECT_EQ(wedges[0].depth_mm, 1.0);
}

TEST(WedgeEchoes, WhatIsAsDeepOrBesideOrTurnedOrBeyondStays) {
  ScriptWedge turned = vertical_at(0, -2.5, 0.5);
  turned.direction = {1, 0, 0};
  for (const ScriptWedge& other :
       {vertical_at(0, -2.5, 0.8), vertical_at(1.2, -2.5, 0.5), vertical_at(0, -7.0, 0.5), turned}) {
    std::vector<ScriptWedge> wedges{vertical_at(0, 0, 1.0), other};
    drop_echoes(wedges);
    EXPECT_EQ(wedges.size(), 2u);
  }
}

TEST(WedgeConfidence, FallsWithTheMisfitAgainstWhatIsUsualOnTheTablet) {
  PlacedImprint placed;
  placed.imprint.p[Imprint::kDepth] = std::log(0.5);
  placed.gain = 0.01, placed.margin = 1.0, placed.depth = 0.5;
  WedgeScale scale{2.0, 1.0, 0.3, 1.0, 0.03};
  placed.misfit = 0.03;
  EXPECT_GT(wedge_confidence(placed, scale), 0.95);
  placed.misfit = 0.2;
  EXPECT_LT(wedge_confidence(placed, scale), 0.3);
  scale.misfit = 0.2;  // a coarse mesh: all of its wedges fit badly
  EXPECT_GT(wedge_confidence(placed, scale), 0.95);
}

TEST(WedgeConfidence, FallsWithTheWidthAgainstThatOfTheOthers) {
  PlacedImprint placed;
  placed.imprint.p[Imprint::kDepth] = std::log(0.5);
  placed.imprint.p[Imprint::kWidth] = std::log(1.6);
  placed.gain = 0.01, placed.margin = 1.0, placed.depth = 0.5;
  WedgeScale scale{2.0, 1.0, 0.3, 1.0, 0.03};
  EXPECT_LT(wedge_confidence(placed, scale), 0.3);
  scale.fitted = 1.4;  // all heads of this mesh look as wide
  EXPECT_GT(wedge_confidence(placed, scale), 0.9);
}

}  // namespace
}  // namespace dubsar
