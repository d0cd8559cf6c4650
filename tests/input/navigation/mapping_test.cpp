#include "input/navigation/mapping.h"

#include <gtest/gtest.h>

#include "input/navigation/embedded_mappings.h"

namespace dubsar {
namespace {

std::string refusal(std::string_view text) {
  const auto mapping = parse_mapping(text, "museum.json");
  if (mapping) return "accepted";
  EXPECT_EQ(mapping.error().kind, ErrorKind::kConfig);
  return mapping.error().message;
}

TEST(Mapping, DefaultHasThePapersMouseAndTheShippedGestureFigures) {
  const Mapping m = default_mapping().value();
  EXPECT_EQ(chord_action(m.mouse, kNoModifier, "left"), Action::kRotate);
  EXPECT_EQ(chord_action(m.mouse, kShift, "left"), Action::kPan);
  EXPECT_EQ(chord_action(m.mouse, kControl, "left"), Action::kZoom);
  EXPECT_EQ(chord_action(m.mouse, kShift | kControl, "left"), Action::kNone);
  const GestureOptions figures;  // gesture_options.h has the same figures
  EXPECT_EQ(m.gestures.grab.on, figures.grab.on);
  EXPECT_EQ(m.gestures.grab.off, figures.grab.off);
  EXPECT_DOUBLE_EQ(m.gestures.pinch.on_m, figures.pinch.on_m);
  EXPECT_DOUBLE_EQ(m.gestures.pinch.off_m, figures.pinch.off_m);
  EXPECT_DOUBLE_EQ(m.gestures.swipe.fast_mps, figures.swipe.fast_mps);
  EXPECT_EQ(m.gestures.cooldown_ns, figures.cooldown_ns);
  EXPECT_EQ(m.priority.size(), 4u);
}

TEST(Mapping, OnlyWhatDiffersNeedsToBeSaid) {
  const Mapping m =
      parse_mapping(
          R"({"hands": {"pinch": "none", "turn_deg_per_mm": 1.25}, "keys": {"home": null, "q": "side reverse"}})", "x")
          .value();
  EXPECT_EQ(m.hands.pinch, Action::kNone);
  EXPECT_EQ(m.hands.grab, Action::kRotate);
  EXPECT_DOUBLE_EQ(m.hands.turn_deg_per_mm, 1.25);
  EXPECT_EQ(m.keys.at("home"), "none");
  EXPECT_EQ(m.keys.at("q"), "side reverse");
  EXPECT_EQ(m.keys.count("left"), 0u) << "commands have their own keys";
}

TEST(Mapping, RefusesByNameAndRange) {
  EXPECT_EQ(refusal(R"({"hands": {"turn_deg_per_mm": 11}})"),
            "museum.json: hands: turn_deg_per_mm is 11, expected 0.01 to 10");
  EXPECT_EQ(refusal(R"({"hands": {"pinch": "explode"}})"),
            "museum.json: hands: pinch is \"explode\", expected one of: none, rotate, pan, zoom, light");
  EXPECT_NE(refusal(R"({"hand": {}})").find("\"hand\" is unknown, expected one of"), std::string::npos);
  EXPECT_NE(refusal(R"({"gestures": {"grab_onn": 1}})").find("\"grab_onn\" is unknown, expected one of"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"gestures": {"grab_on": 0.5}})").find("grab_off is not below grab_on"), std::string::npos);
  EXPECT_NE(refusal(R"({"gestures": {"pinch_off_mm": 20}})").find("pinch_off_mm is not above"), std::string::npos);
  EXPECT_NE(refusal(R"({"mouse": {"sideways": "pan"}})").find("no mouse chord"), std::string::npos);
  EXPECT_NE(refusal(R"({"mouse": {"gain": 3}})").find("\"gain\" is not known"), std::string::npos);
  EXPECT_NE(refusal(R"({"keys": {"x": 5}})").find("x is no command"), std::string::npos);
  EXPECT_NE(refusal(R"({"keys": {"x": ""}})").find("x is no command"), std::string::npos);
  EXPECT_NE(refusal(R"({"priority": ["mouse", "mouse"]})").find("priority"), std::string::npos);
  EXPECT_NE(refusal(R"({"priority": 5})").find("priority"), std::string::npos);
  EXPECT_NE(refusal(R"({"priority": ["none"]})").find("priority"), std::string::npos);
  EXPECT_NE(refusal(R"({"hands": {"zone_min_mm": [400, 0, 0]}})").find("zone_min_mm"), std::string::npos);
  EXPECT_NE(refusal(R"({"hands": {"zone_min_mm": [1, 2]}})").find("zone_min_mm"), std::string::npos);
  EXPECT_NE(refusal(R"({"hands": 5})").find("found number, expected an object"), std::string::npos);
  EXPECT_NE(refusal(R"({"hands": null})"), "accepted");
  EXPECT_NE(refusal(R"({"keys": 5})").find("keys is number"), std::string::npos);
  EXPECT_NE(refusal("[]"), "accepted");
  EXPECT_NE(refusal("{"), "accepted");
  EXPECT_NE(refusal(std::string(100, '[')), "accepted");
}

TEST(Mapping, EveryTruncationIsRefusedAndNothingCrashes) {
  const std::string text(embedded_mappings().front().second);
  const std::size_t whole = text.find_last_of('}');
  for (std::size_t n = 0; n <= whole; ++n) EXPECT_FALSE(parse_mapping(text.substr(0, n), "cut")) << n;
}

TEST(Mapping, EveryFieldWithAWrongTypeIsRefused) {
  for (const std::string field : {"key_step_deg", "key_zoom", "puck", "zoom_min", "zoom_max", "priority", "handover_ms",
                                  "hands", "gestures", "mouse", "keys"})
    for (const std::string value : {"\"text\"", "true", "null", "1e999", "[[]]"})
      EXPECT_NE(refusal("{\"" + field + "\": " + value + "}"), "accepted") << field << " " << value;
}

}  // namespace
}  // namespace dubsar
