#include "app/kiosk/kiosk_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/kiosk/words.h"
#include "core/base/files/atomic_file.h"

namespace dubsar::app {
namespace {

constexpr const char* kWhole = R"({"format": "dubsar kiosk", "version": 1,
  "objects": [{"file": "contract.exa", "title": {"en": "A sealed contract", "de": "Ein gesiegelter Vertrag"}, "style": "raking"},
              {"file": "/data/letter.exa", "tour": "letter.json", "parts": ["tablet"]}],
  "languages": ["de", "en"], "display": "lenticular:looking-glass-go", "monitor": "HDMI-1", "inputs": ["leap", "head:opentrack"],
  "panels": [{"display": "anaglyph", "monitor": "DP-2"}], "idle_reset_s": 60, "attract_after_s": 5, "quiet": ["18:00-09:30"], "brightness": 0.8, "pin": "4711", "journal": "log"})";

TEST(KioskProfile, SaysWhatIsShownHowAndToWhom) {
  const auto profile = parse_kiosk_profile(kWhole, "lobby.json", "/etc/kiosk");
  ASSERT_TRUE(profile) << profile.error().message;
  ASSERT_EQ(profile->objects.size(), 2U);
  EXPECT_EQ(profile->objects[0].file, "/etc/kiosk/contract.exa");
  EXPECT_EQ(profile->objects[1].file, "/data/letter.exa");
  EXPECT_EQ(profile->objects[1].tour, "/etc/kiosk/letter.json");
  EXPECT_EQ(profile->objects[1].parts, std::vector<std::string>{"tablet"});
  EXPECT_EQ(text_in(profile->objects[0].title, "de"), "Ein gesiegelter Vertrag");
  EXPECT_EQ(text_in(profile->objects[0].title, "fr"), "A sealed contract");
  EXPECT_EQ(profile->idle_reset_s, 60);
  EXPECT_EQ(profile->quiet, (std::vector<QuietHours>{{18 * 60, 9 * 60 + 30}}));
  EXPECT_EQ(profile->journal, "/etc/kiosk/log");
  ASSERT_EQ(profile->panels.size(), 1U);
  EXPECT_EQ(profile->panels[0].display, "anaglyph");
  EXPECT_EQ(profile->panels[0].monitor, "DP-2");
}

TEST(KioskProfile, RefusesWhatItDoesNotUnderstandInOneSentence) {
  const std::string base = R"({"format": "dubsar kiosk", "version": 1, "objects": [{"file": "a.exa"}], "pin": "1234")";
  const std::array<std::pair<std::string, std::string>, 15> wrong{{
      {"{}", "format"},
      {R"({"format": "dubsar kiosk", "version": 2})", "version 2 found"},
      {R"({"format": "dubsar kiosk", "version": 1, "pin": "1234"})", "objects"},
      {R"({"format": "dubsar kiosk", "version": 1, "objects": [{"tour": "a"}], "pin": "1234"})", "\"file\" is missing"},
      {R"({"format": "dubsar kiosk", "version": 1, "objects": [{"file": "a.exa"}]})", "nobody could end it"},
      {base + R"(, "pni": "1"})", "\"pni\" is unknown"},
      {base + R"(, "idle_reset_s": 1e999})", "lobby.json"},
      {base + R"(, "idle_reset_s": 2})", "idle_reset_s is 2"},
      {base + R"(, "brightness": 0})", "brightness is 0"},
      {base + R"(, "quiet": ["25:00-09:00"]})", "25:00-09:00"},
      {base + R"(, "languages": []})", "languages"},
      {base + R"(, "inputs": [3]})", "inputs"},
      {base + R"(, "panels": [{"display": "mono"}]})", "stand before the first panel"},
      {base + R"(, "panels": [{"monitor": "A", "dsplay": "mono"}]})", "panel 1: \"dsplay\" is unknown"},
      {R"({"format": "dubsar kiosk", "version": 1, "objects": [{"file": "a.exa"}], "pin": "12"})", "4 to 12 digits"},
  }};
  for (const auto& [text, said] : wrong) {
    const auto found = parse_kiosk_profile(text, "lobby.json", "");
    ASSERT_FALSE(found) << text;
    EXPECT_EQ(found.error().kind, ErrorKind::kConfig) << found.error().message;
    EXPECT_NE(found.error().message.find(said), std::string::npos) << found.error().message;
  }
}

TEST(KioskProfile, NamesTheFileThatIsNotThere) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "kiosk_profile";
  std::filesystem::create_directories(folder);
  const auto path = folder / "lobby.json";
  ASSERT_TRUE(write_file_atomically(
      path, std::string_view(
                R"({"format": "dubsar kiosk", "version": 1, "objects": [{"file": "gone.exa"}], "pin": "1234"})")));
  const auto found = read_kiosk_profile(path);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kConfig);
  EXPECT_NE(found.error().message.find("gone.exa is not there"), std::string::npos) << found.error().message;
  EXPECT_EQ(read_kiosk_profile(folder / "none.json").error().kind, ErrorKind::kNoInput);
}

TEST(QuietHours, GoOverMidnight) {
  const std::vector<QuietHours> night{*parse_quiet_hours("18:00-09:30")}, lunch{*parse_quiet_hours("12:00-13:00")};
  EXPECT_TRUE(is_quiet(night, 18 * 60));
  EXPECT_TRUE(is_quiet(night, 0));
  EXPECT_TRUE(is_quiet(night, 9 * 60 + 29));
  EXPECT_FALSE(is_quiet(night, 9 * 60 + 30));
  EXPECT_FALSE(is_quiet(night, 17 * 60 + 59));
  EXPECT_TRUE(is_quiet(lunch, 12 * 60));
  EXPECT_FALSE(is_quiet(lunch, 13 * 60));
  EXPECT_FALSE(is_quiet({}, 0));
  for (const char* wrong :
       {"", "18:00", "18:00-", "1800-0930", "18:00-24:00", "18:60-19:00", "18:00-09:300", "ab:cd-ef:gh"})
    EXPECT_FALSE(parse_quiet_hours(wrong)) << wrong;
}

TEST(Words, EveryLineIsSpokenInEveryLanguageAndShortEnough) {
  const Words words;
  EXPECT_THAT(words.languages(), ::testing::UnorderedElementsAre("en", "de", "fr"));
  for (const std::string& language : words.languages())
    for (std::size_t i = 0; i < kLineCount; ++i) {
      const std::string& said = words.say(static_cast<Line>(i), language);
      EXPECT_FALSE(said.empty()) << language << line_name(static_cast<Line>(i));
      EXPECT_LE(said.size(), 100U) << said;
      if (language != "en") {
        EXPECT_NE(said, words.say(static_cast<Line>(i), "en"));
      }
    }
  EXPECT_EQ(words.say(Line::kGrab, "tlh"), words.say(Line::kGrab, "en"));
  EXPECT_TRUE(Words::right_to_left("ar"));
  EXPECT_FALSE(Words::right_to_left("de"));
}

TEST(Words, AMuseumChangesThemAndAddsLanguages) {
  const auto changed = Words::parse(R"({"de": {"grab": "Zugreifen!"}})", "words.json");
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(changed->say(Line::kGrab, "de"), "Zugreifen!");
  EXPECT_EQ(changed->say(Line::kTurn, "de"), Words().say(Line::kTurn, "de"));
  std::string arabic = R"({"ar": {)";
  for (std::size_t i = 0; i < kLineCount; ++i)
    arabic += fmt::format("{}\"{}\": \"\u0633\u0637\u0631 {}\"", i ? ", " : "", line_name(static_cast<Line>(i)), i);
  const auto added = Words::parse(arabic + "}}", "words.json");
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_TRUE(added->has("ar"));
  for (const char* wrong : {R"({"de": {"grba": "x"}})", R"({"de": {"grab": ""}})", R"({"de": {"grab": 3}})",
                            R"({"ar": {"grab": "x"}})", R"({"German": {}})", "[]", "{"})
    EXPECT_FALSE(Words::parse(wrong, "words.json")) << wrong;
  EXPECT_FALSE(Words::parse(fmt::format(R"({{"de": {{"grab": "{}"}}}})", std::string(121, 'x')), "words.json"));
}

}  // namespace
}  // namespace dubsar::app
