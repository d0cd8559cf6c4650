// Labels beside their places: none covers another, and none jumps while things turn.

#include "app/stage/label_layout.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "app/panels/panel_font.h"
#include "display/render/images/label_font.h"

namespace dubsar::app {
namespace {

constexpr PixelSize kPicture{400, 400};  // a pixel a mm

class LabelLayouts : public ::testing::Test {
 protected:
  LabelLayouts() : font_(LabelFont::create(panel_font()).value()) {
    view_.clip_from_view = glm::ortho(-200.0, 200.0, -200.0, 200.0, -200.0, 200.0);
  }
  LabelItem label(const std::string& text, const glm::dvec3& at) const {
    LabelItem out;
    out.font = font_.get();
    out.text = text;
    out.at_mm = at;
    out.shift_px = {9.0, 7.0};
    out.height_px = 19.0;
    return out;
  }
  std::vector<LabelItem> arranged(std::vector<LabelItem> labels) {
    layout_.arrange(labels, {0, 0, 0}, view_, kPicture);
    return labels;
  }
  int covered(const std::vector<LabelItem>& labels) const {
    int out = 0;
    for (std::size_t i = 0; i < labels.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        out += cover(label_rects(labels[i], view_, kPicture), label_rects(labels[j], view_, kPicture));
    return out;
  }
  std::unique_ptr<LabelFont> font_;
  View view_;
  LabelLayout layout_;
};

TEST_F(LabelLayouts, WhatStandsAloneStaysWhereItWas) {
  const std::vector<LabelItem> labels{label("o. 1  sila", {0, 0, 5}), label("1: 12.3 mm", {0, 100, 5})};
  EXPECT_EQ(arranged(labels), labels);
}

TEST_F(LabelLayouts, NearNeighboursDoNotCoverEachOtherAndAllAreThere) {
  std::vector<LabelItem> labels;
  for (int i = 0; i < 4; ++i) labels.push_back(label(fmt::format("o. {}  lugal", i + 1), {4.0 * i, 3.0 * (i % 2), 5}));
  ASSERT_GT(covered(labels), 3);
  const auto out = arranged(labels);
  EXPECT_EQ(out.size(), 4u);
  EXPECT_EQ(covered(out), 0);
}

TEST_F(LabelLayouts, WhatFindsNoRoomGoesAndComesBackWhenThereIsSome) {
  std::vector<LabelItem> labels;
  for (int i = 0; i < 12; ++i) labels.push_back(label(fmt::format("o. {}  lugal", i + 1), {0.5 * i, 0, 5}));
  const auto tight = arranged(labels);
  EXPECT_GE(tight.size(), 5u);
  EXPECT_LT(tight.size(), labels.size());
  EXPECT_EQ(covered(tight), 0);
  EXPECT_EQ(tight.front().text, labels.front().text) << "the first ones choose first";
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i].at_mm.y = 30.0 * static_cast<double>(i) - 180.0;
  EXPECT_EQ(arranged(labels).size(), labels.size());
}

TEST_F(LabelLayouts, NearerOnesGoBeforeThoseOfTheFarSide) {
  const auto out = arranged({label("r. 1  behind", {0, 0, -5}), label("o. 1  before", {2, 0, 5})});
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[1].shift_px, glm::dvec2(9.0, 7.0));
  EXPECT_NE(out[0].shift_px, glm::dvec2(9.0, 7.0));
}

TEST_F(LabelLayouts, TextsAlongLinesStayAndOthersGiveThemRoom) {
  LabelItem along = label("a line of text along its writing", {-20, -5, 5});
  along.along_mm = {60, 0, 0};
  const auto out = arranged({label("o. 2", {10, -5, 5}), along});
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[1], along);
  EXPECT_EQ(covered(out), 0);
}

// Two notes whose places pass each other by a tenth of a pixel a picture: each changes its side at most once.
TEST_F(LabelLayouts, LettersDoNotJumpToAndFroWhileThingsTurn) {
  int changes = 0;
  std::vector<LabelItem> before;
  for (int step = 0; step < 400; ++step) {
    const double wobble = 0.4 * std::sin(0.9 * step);  // a hand that trembles
    auto out = arranged({label("o. 1  lugal", {0, 0, 5}), label("o. 2  ensi", {-20.0 + 0.1 * step + wobble, 14, 5})});
    ASSERT_EQ(out.size(), 2u) << step;
    EXPECT_EQ(covered(out), 0) << step;
    for (std::size_t i = 0; i < before.size(); ++i)
      changes += out[i].shift_px != before[i].shift_px || out[i].anchor != before[i].anchor;
    before = std::move(out);
  }
  EXPECT_LE(changes, 3);
}

// A line of 60 mm on the front of a tablet that is turned about its upright axis: its text is read from the front, not
// from behind, and not where it would stick out of the edge.
TEST_F(LabelLayouts, TextsAlongLinesAreReadFromTheFrontOnly) {
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * 3.14159265358979 / 180.0;
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0)));
    LabelItem text = label("IGI a-na-x", turn * glm::dvec3(-30, 0, 10));
    text.along_mm = turn * glm::dvec3(60, 0, 0);
    text.normal = turn * glm::dvec3(0, 0, 1);
    const bool read = turn_to_reader(text, view_);
    if (std::cos(angle) > 0.65) {
      EXPECT_TRUE(read) << degrees;
    } else if (std::cos(angle) < 0.55) {
      EXPECT_FALSE(read) << degrees;
    }
    LabelItem pin = label("o. 1", turn * glm::dvec3(0, 0, 10));
    pin.normal = turn * glm::dvec3(0, 0, 1);
    EXPECT_EQ(turn_to_reader(pin, view_), std::cos(angle) > 0.12) << degrees;
  }
}

TEST_F(LabelLayouts, TextsNeverStandOnTheirHeads) {
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const double angle = (degrees + 3) * 3.14159265358979 / 180.0;
    LabelItem text = label("kaspum", {5, 7, 1});
    text.along_mm = 40.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    const glm::dvec3 a = text.at_mm, b = text.at_mm + text.along_mm;
    ASSERT_TRUE(turn_to_reader(text, view_));
    EXPECT_GT(text.along_mm.x, 0.0) << degrees;
    EXPECT_LT(std::min(glm::distance(text.at_mm, a), glm::distance(text.at_mm, b)), 1e-9) << "it begins at an end";
    EXPECT_LT(std::min(glm::distance(text.at_mm + text.along_mm, a), glm::distance(text.at_mm + text.along_mm, b)),
              1e-9);
  }
}

TEST_F(LabelLayouts, InPerspectiveThePlaceCounts) {
  View near;
  near.clip_from_view = glm::perspective(1.0, 1.0, 10.0, 1000.0);
  near.view_from_world = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -100));
  LabelItem side = label("l. e. 1", {40, 0, 0});
  side.normal = {1, 0, 0};  // looks away from an eye in the middle, 100 mm before
  EXPECT_FALSE(turn_to_reader(side, near));
  side.at_mm.x = -40;  // the eye is on the side that it looks to
  EXPECT_TRUE(turn_to_reader(side, near));
}

}  // namespace
}  // namespace dubsar::app
