#include "app/kiosk/tour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/document/document.h"
#include "app/kiosk/tour_walk.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr TimestampNs kTourStep = 20'000'000;

Document enclosed() {
  Document out;
  out.parts = {{"tablet", 1}, {"envelope", 2}};
  out.home.rotation = turn_of({0.2, 0.4, -0.1});
  out.now = out.home;
  return out;
}

Keyframe home_of_parts(const Document& document) {
  Keyframe out = keyframe_of(document, 0.0);
  out.camera = document.home;
  return out;
}

const char* const kTwoSteps = R"({"format": "dubsar tour", "version": 1, "steps": [
  {"title": {"en": "Seals", "de": "Siegel"}, "text": "Two witnesses",
   "labels": [{"text": {"en": "first witness"}, "part": "envelope", "at_mm": [1, 2, 3], "normal": [0, 0, 2]}],
   "keyframes": [{"time_s": 2, "camera": {"zoom": 1.5}, "light": {"elevation_deg": 10}},
                 {"time_s": 5, "unpack": 1, "parts": [{"name": "envelope", "opacity": 0.5, "offset_mm": [0, 0, 4]}]}]},
  {"stays_s": 1, "keyframes": [{"time_s": 1.5, "camera": {"pan": [0.1, 0]}}]}]})";

TEST(Tour, WhatAKeyframeDoesNotSayIsAsBefore) {
  const auto tour = parse_tour(kTwoSteps, "tour.json");
  ASSERT_TRUE(tour) << tour.error().message;
  ASSERT_EQ(tour->steps.size(), 2U);
  const TourStep &first = tour->steps[0], &second = tour->steps[1];
  EXPECT_EQ(text_in(first.title, "de"), "Siegel");
  EXPECT_EQ(text_in(first.text, "fr"), "Two witnesses");
  EXPECT_EQ(first.labels.at(0).normal, glm::dvec3(0, 0, 1));
  EXPECT_EQ(first.keyframes.at(1).camera.zoom, 1.5);
  EXPECT_EQ(first.keyframes.at(1).light.elevation_deg, 10.0);
  EXPECT_EQ(first.keyframes.at(1).light.azimuth_deg, LightPlace().azimuth_deg);
  EXPECT_EQ(second.keyframes.at(0).unpack, 1.0);
  EXPECT_EQ(second.keyframes.at(0).parts.at(0).opacity, 0.5);
  EXPECT_EQ(second.keyframes.at(0).camera.pan, glm::dvec2(0.1, 0.0));
  EXPECT_EQ(second.keyframes.at(0).time_s, 1.5);
  EXPECT_EQ(parse_tour(format_tour(*tour), "again"), *tour);
}

TEST(Tour, WhatIsWrongIsSaidInOneSentenceThatNamesTheStep) {
  const json good = json::parse(kTwoSteps);
  const auto said = [](const json& wrong) {
    const auto tour = parse_tour(wrong.dump(), "t.json");
    return tour ? std::string("it was taken") : tour.error().message;
  };
  const auto with = [&](const char* pointer, const json& value) {
    json wrong = good;
    wrong[json::json_pointer(pointer)] = value;
    return said(wrong);
  };
  EXPECT_EQ(with("/steps/1/keyframes/0/unpack", 3), "t.json: steps[1]: keyframes[0].unpack is 3, expected 0 to 1");
  EXPECT_EQ(with("/steps/0/keyframes/0/camra", json::object()),
            "t.json: steps[0]: keyframes[0]: \"camra\" is unknown, expected one of: time_s, camera, light, unpack, "
            "style, parts");
  EXPECT_EQ(with("/steps/0/keyframes/1/camera", {{"zom", 2}}),
            "t.json: steps[0]: keyframes[1].camera: \"zom\" is unknown, expected one of: rotation_wxyz, zoom, pan");
  EXPECT_EQ(with("/steps/0/keyframes", json::array()), "t.json: steps[0]: no keyframe found, expected at least one");
  EXPECT_EQ(with("/steps/0/titel", "x"),
            "t.json: steps[0]: \"titel\" is unknown, expected one of: title, text, labels, stays_s, says_s, keyframes");
  EXPECT_EQ(with("/steps/0/labels/0/at_mm", {1, 2}), "t.json: steps[0]: labels[0]: \"at_mm\" is no list of 3 numbers");
  EXPECT_EQ(with("/steps/0/title", 7), "t.json: steps[0]: \"title\" is neither a text nor texts by language");
  EXPECT_EQ(with("/version", 2), "t.json: version 2 found, expected 1; a newer dubsar may have written it");
  EXPECT_EQ(with("/steps", json::array()), "t.json: \"steps\" is no list of 1 to 64 steps");
  EXPECT_NE(with("/steps/0/keyframes/0/time_s", 0).find("expected times above 0"), std::string::npos);
  EXPECT_NE(with("/steps/0/keyframes/1/time_s", 2).find("expected more than 2"), std::string::npos);
  EXPECT_NE(with("/steps/0/stays_s", -1).find("stays_s"), std::string::npos);
  EXPECT_NE(said(json::array()).find("expected \"format\": \"dubsar tour\""), std::string::npos);
}

TEST(Tour, NoCutOrBentTextOfOneIsTakenOrCrashes) {
  const std::string text = format_tour(*parse_tour(kTwoSteps, "t"));
  for (std::size_t length = 0; length + 2 < text.size(); length += 3)
    EXPECT_FALSE(parse_tour(text.substr(0, length), "t"));
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string bent = text;
    bent[at] = static_cast<char>(bent[at] ^ 0x11);
    static_cast<void>(parse_tour(bent, "t"));
  }
}

TEST(Tour, AnyTabletHasOneInEveryLanguageFromItsHomeView) {
  const Document document = enclosed();
  const Tour tour = default_tour(document, Words());
  ASSERT_EQ(tour.steps.size(), 5U);
  EXPECT_EQ(parse_tour(format_tour(tour), "made"), tour);
  double length = 0.0, peeled_at = 0.0;
  for (const TourStep& step : tour.steps) {
    for (const char* language : {"en", "de", "fr"}) {
      EXPECT_TRUE(step.title.contains(language));
      EXPECT_TRUE(step.text.contains(language));
    }
    if (step.keyframes.back().unpack == 1.0 && peeled_at == 0.0) peeled_at = length + step.keyframes.back().time_s;
    length += step_length_s(step);
  }
  EXPECT_GT(peeled_at, 0.0);
  EXPECT_LT(length, 75.0);
  const auto envelope = [](const Keyframe& key) { return key.parts.at(1).opacity; };
  EXPECT_EQ(envelope(tour.steps[0].keyframes[0]), 1.0);
  EXPECT_EQ(envelope(tour.steps[4].keyframes[0]), 0.0);
  const Keyframe &begins = tour.steps[4].keyframes[0], &ends = tour.steps[4].keyframes[1];
  EXPECT_GT(begins.camera.pan.x, ends.camera.pan.x) << "the line's beginning is to the left of its end";
  EXPECT_LT(turn_between_deg(begins.camera.rotation, document.home.rotation), 1e-9);
  Document bare;
  bare.parts = {{"tablet", 1}};
  EXPECT_EQ(default_tour(bare, Words()).steps.size(), 2U);
}

struct Walked {
  double fastest_deg_per_s = 0.0, largest_unpack = 0.0, largest_opacity = 0.0, largest_zoom = 0.0;
  int steps = 0;
};

/// Goes on until nothing is shown, or for a time; says how things moved from picture to picture.
Walked go_on(TourWalk& walk, TimestampNs& now, Keyframe& shown, double longest_s) {
  Walked out;
  for (double s = 0.0; s < longest_s; s += 0.02, now += kTourStep) {
    const auto moment = walk.update(now);
    if (!moment) break;
    const Keyframe& next = moment->frame;
    if (moment->camera) {
      out.fastest_deg_per_s =
          std::max(out.fastest_deg_per_s, turn_between_deg(next.camera.rotation, shown.camera.rotation) / 0.02);
      out.largest_zoom = std::max(out.largest_zoom, std::abs(std::log(next.camera.zoom / shown.camera.zoom)));
    }
    out.largest_unpack = std::max(out.largest_unpack, std::abs(next.unpack - shown.unpack));
    for (std::size_t p = 0; p < shown.parts.size(); ++p)
      out.largest_opacity =
          std::max(out.largest_opacity, std::abs(next.parts.at(p).opacity - shown.parts.at(p).opacity));
    shown = next;
    if (moment->settles) ++out.steps;
  }
  return out;
}

/// The default tour of an enclosed tablet, before its first step.
class TourWalkTest : public ::testing::Test {
 protected:
  TourWalkTest() { walk.begin(default_tour(document, Words()), shown); }
  const Document document = enclosed();
  TourWalk walk;
  Keyframe shown = home_of_parts(document);
  TimestampNs now = 5'000'000'000;
};

TEST_F(TourWalkTest, NothingJumpsFromWhereAHandLeftItToTheEnd) {
  shown.camera.rotation = turn_of({1.0, -2.0, 0.5}) * shown.camera.rotation;
  shown.camera.zoom = 2.2;
  walk.go(shown);
  const Walked walked = go_on(walk, now, shown, 200.0);
  EXPECT_LT(now, 90'000'000'000) << "it does not end";
  EXPECT_FALSE(walk.walks());
  EXPECT_EQ(walked.steps, 1) << "hands take over once, when it is back";
  EXPECT_LT(turn_between_deg(shown.camera.rotation, document.home.rotation), 1e-9);
  EXPECT_LT(walked.fastest_deg_per_s, 120.0);
  EXPECT_LT(walked.largest_unpack, 0.03);
  EXPECT_LT(walked.largest_opacity, 0.03);
  EXPECT_LT(walked.largest_zoom, 0.03);
  EXPECT_EQ(shown.unpack, 1.0) << "the tablet stays to be seen";
  EXPECT_EQ(shown.parts.at(1).opacity, 1.0) << "an envelope that can be closed again";
}

TEST_F(TourWalkTest, IsLeftAndTakenUpAgainAtTheSameStep) {
  walk.go(shown);
  go_on(walk, now, shown, 12.0);
  EXPECT_EQ(walk.at(), 1U);
  walk.leave();
  const auto taken = walk.update(now += kTourStep);
  ASSERT_TRUE(taken && taken->settles && taken->camera);
  EXPECT_LT(turn_between_deg(taken->frame.camera.rotation, shown.camera.rotation), 1e-9) << "it stays where it is";
  go_on(walk, now, shown, 5.0);
  EXPECT_FALSE(walk.update(now));
  walk.go(shown);
  EXPECT_EQ(walk.at(), 1U);
  walk.next();
  EXPECT_EQ(walk.at(), 2U);
  walk.leave();
  walk.forget();
  walk.go(shown);
  EXPECT_EQ(walk.at(), 0U);
}

TEST_F(TourWalkTest, ASuspendedMachineGoesOnWhereItWas) {
  walk.go(shown);
  go_on(walk, now, shown, 3.0);
  const Keyframe before = walk.update(now)->frame;
  now += 3'600'000'000'000;
  const Keyframe after = walk.update(now)->frame;
  EXPECT_LT(turn_between_deg(after.camera.rotation, before.camera.rotation), 5.0);
  EXPECT_EQ(walk.at(), 0U);
  EXPECT_TRUE(walk.update(now - 7'200'000'000'000)) << "a clock that goes back";
}

}  // namespace
}  // namespace dubsar::app
