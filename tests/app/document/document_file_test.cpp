#include "app/document/document_file.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>

namespace dubsar::app {
namespace {

/// Something in every field.
Document rich(unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&] { return std::uniform_real_distribution<>(-1000, 1000)(random); };
  const auto camera = [&] {
    return CameraPose{turn_of({real(), real(), real()}), 0.5 + std::abs(real()), {real(), real()}};
  };
  const auto mm = [&] { return std::round(real() * 1e3) / 1e3; };  // as files have them
  const auto vector = [&] { return glm::dvec3(mm(), mm(), mm()); };
  Document out;
  out.source = {"/scans/K\u00fcltepe \u0161/kt.exa", 123'456'789'012, "12-ab", "34-cd"};
  out.parts = {{"tablet", 1, true, {1, 2, 3}, 0.25, vector()}, {"envelope", 6, false, {255, 0, 9}, 1.0, vector()}};
  out.unpack = 0.375;
  out.home = camera();
  out.now = camera();
  out.home_light = {10, 20};
  out.light = {real(), real()};
  out.style = {"sky-sun", 1.7, false, false};
  out.clips = {{vector(), mm(), false}};
  out.fog = 0.125;
  out.measures = {
      {MeasureKind::kDistance, "wedge", "tablet", {vector(), vector()}, {1.5, 2.25, 3, 4, 0.125, {vector()}}, "m1"},
      {MeasureKind::kDepth, "", "", {vector()}, {}, "m2"}};
  out.notes = {{"tablet",
                "o. 5",
                "a-na \u1e2ba-x, \"\u02bes\u2082\"\nsecond line",
                vector(),
                vector(),
                {vector(), vector()},
                camera(),
                "n1",
                "to \u1e62illi",
                "2026-11-27"}};
  out.edition = {{"AO 8295", "P999001", "title", "Louvre", "CC BY", "A. Scribe", "akk-Latn", "en"},
                 "&P999001 = A\r\n1. \u0161u\n"};
  ScriptWedge wedge;
  wedge.by = WedgeBy::kCorrected;
  wedge.kind = WedgeKind::kObliqueUp;
  wedge.side = TextSide::kLeftEdge;
  wedge.column = 2;
  wedge.line = 7;
  wedge.order = 1;
  wedge.head_mm = vector();
  for (glm::dvec3& corner : wedge.corner_mm) corner = vector();
  wedge.tip_mm = vector();
  wedge.tail_mm = vector();
  wedge.depth_mm = 0.75;
  wedge.length_mm = 4.5;
  wedge.width_mm = 1.25;
  wedge.opening_deg = 91.5;
  wedge.confidence = 0.5;
  wedge.pressed_after = {{4, 0.125}};
  out.edition.wedges = {{wedge, "tablet", false, "w1"}, {ScriptWedge{}, "envelope", true, "w2"}};
  out.scan = {vector(), vector(), {0, 1, 0}, {0.6, 0, 0.8}, 2.5, real(), real(), 4};
  out.keyframes = {{1.5, camera(), {3, 4}, 0.5, "phong", {{"tablet", 0.5, vector()}}}, {}};
  return out;
}

TEST(DocumentFile, EveryFieldComesBackExactlyAndPlacesToAMicrometre) {
  for (const unsigned seed : {std::random_device()(), 1u, 2u}) {
    const Document document = rich(seed);
    const std::string text = format_document(document);
    const auto back = parse_document(text, "test");
    ASSERT_TRUE(back) << back.error().message << " seed " << seed;
    EXPECT_EQ(*back, document) << "seed " << seed;
    EXPECT_EQ(format_document(*back), text);
  }
  Document long_line;
  long_line.notes.emplace_back();
  for (int i = 0; i < 900; ++i) long_line.notes[0].line_mm.emplace_back(std::sqrt(i), std::cbrt(i), std::exp(-i));
  const std::string text = format_document(long_line);
  EXPECT_LT(text.size(), 900u * 30 + 3000) << "three digits, and a line for each place";
  const auto back = parse_document(text, "line").value();
  for (int i = 0; i < 900; ++i)
    EXPECT_LT(glm::distance(back.notes[0].line_mm[i], long_line.notes[0].line_mm[i]), 0.0005 * std::sqrt(3) + 1e-12);
}

TEST(DocumentFile, EveryTruncationMissingFieldAndWrongTypeIsRefusedInASentence) {
  const std::string text = format_document(rich(5));
  for (std::size_t n = 0; n + 2 < text.size(); n += 7) EXPECT_FALSE(parse_document(text.substr(0, n), "cut")) << n;
  using nlohmann::json;
  const json whole = json::parse(text);
  const json flat = whole.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    json without = whole;
    const json::json_pointer at(pointer);
    json& around = without.at(at.parent_pointer());
    const bool list_item = !around.is_object();
    if (list_item) {
      around.erase(std::stoul(at.back()));
    } else {
      around.erase(at.back());
    }
    const auto missing = parse_document(without.dump(), "x");
    const bool optional = at.back() == "uncertainty_mm";  // measures of earlier versions have none
    EXPECT_TRUE(!missing || list_item || optional) << pointer;
    for (const json& wrong : {json("text"), json(nullptr), json::array(), json(1e300), json::object()}) {
      if (wrong.type() == whole[at].type()) continue;
      if (wrong.is_number() && value.is_number()) continue;
      json changed = whole;
      changed[at] = wrong;
      const auto refused = parse_document(changed.dump(), "x");
      ASSERT_FALSE(refused) << pointer << " " << wrong;
      EXPECT_EQ(refused.error().kind, ErrorKind::kBadData);
    }
  }
}

TEST(DocumentFile, AnOlderVersionIsReadAndWhatItDidNotKnowIsAsUsual) {
  nlohmann::json old = nlohmann::json::parse(format_document(rich(11)));
  old["version"] = 1;
  old["style"].erase("evidence");
  for (auto& note : old["notes"]) note.erase("label"), note.erase("line_mm"), note.erase("part"), note.erase("id");
  old.erase("fog");
  old.erase("scan");
  old["slices"] = nlohmann::json::array();  // as they once were
  const auto back = parse_document(old.dump(), "old");
  ASSERT_TRUE(back) << back.error().message;
  Document expected = rich(11);
  expected.style.evidence = true;
  expected.fog = 0;
  expected.scan = {};
  expected.notes[0].label.clear();
  expected.notes[0].part.clear();
  expected.notes[0].line_mm.clear();
  expected.notes[0].id.clear();
  give_ids(expected);
  EXPECT_EQ(*back, expected);
}

TEST(DocumentFile, RangesAndOtherVersionsAreRefusedByName) {
  const auto refusal = [](auto change) {
    Document document = rich(6);
    change(document);
    const auto back = parse_document(format_document(document), "k.json");
    return back ? std::string("accepted") : back.error().message;
  };
  EXPECT_EQ(refusal([](Document& d) { d.now.zoom = 0; }), "k.json: zoom is 0, expected more than 0");
  EXPECT_EQ(refusal([](Document& d) { d.unpack = 2; }), "k.json: unpack is 2, expected 0 to 1");
  EXPECT_NE(refusal([](Document& d) { d.scan.zoom = 0; }).find("zoom 0"), std::string::npos);
  EXPECT_NE(refusal([](Document& d) { d.scan.large = 5; }).find("slice 5"), std::string::npos);
  EXPECT_NE(refusal([](Document& d) { d.scan.free_up = d.scan.free_right; }).find("across"), std::string::npos);
  EXPECT_NE(refusal([](Document& d) { d.now.rotation = {0, 0, 0, 0}; }).find("now.rotation_wxyz"), std::string::npos);
  EXPECT_NE(refusal([](Document& d) { d.notes[0].at_mm.x = 1e13; }).find("notes[0].at_mm"), std::string::npos);
  std::string text = format_document(rich(7));
  text.replace(text.find("\"version\": 7"), 12, "\"version\": 8");
  const auto newer = parse_document(text, "k.json");
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().message, "k.json: version 8 found, expected 1 to 7; a newer dubsar may have written it");
  EXPECT_FALSE(parse_document("[]", "k.json"));
}

TEST(DocumentFile, EveryBrokenByteIsRefusedOrReadAsADocument) {
  const std::string text = format_document(rich(10));
  for (std::size_t i = 0; i < text.size(); i += 3)
    for (const char c : {'0', '-', '"', '}', '\xff'}) {
      std::string broken = text;
      broken[i] = c;
      const auto parsed = parse_document(broken, "broken");
      EXPECT_TRUE(parsed || parsed.error().kind == ErrorKind::kBadData);
      if (parsed) {
        EXPECT_TRUE(parse_document(format_document(*parsed), "again")) << i << c;
      }
    }
}

}  // namespace
}  // namespace dubsar::app
