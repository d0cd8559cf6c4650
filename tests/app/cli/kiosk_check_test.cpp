// dubsar kiosk check: what people get wrong in a gallery's profile, each told in one sentence with its place and what
// to do; and a picture of each screen.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "core/image_io/png_file.h"
#include "tests/app/cli/block_obj.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
using nlohmann::json;

/// A profile of nine lines without a fault: 1 to 9.
const std::vector<std::string> kGood{
    R"({"format": "dubsar kiosk",)",
    R"( "version": 1,)",
    R"( "objects": [{"file": "block.obj", "title": {"de": "Ein Block", "en": "A block"}, "tour": "tour.json"}],)",
    R"( "languages": ["de", "en"],)",
    R"( "words": "words.json",)",
    R"( "inputs": [],)",
    R"( "quiet": ["18:00-09:30"],)",
    R"( "brightness": 0.9,)",
    R"( "pin": "4711"})"};
constexpr const char* kTour = R"({"format": "dubsar tour", "version": 1, "steps": [
 {"title": {"de": "Eins", "en": "One"}, "keyframes": [{"time_s": 2}]},
 {"title": {"de": "Zwei", "en": "Two"}, "keyframes": [{"time_s": 2, "camera": {"zoom": 1.5}}]}]})";

class KioskCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / fmt::format("check_{}", ::getpid());
    std::filesystem::create_directories(folder_);
    write("block.obj", kBlockObj);
    write("broken.ply", "ply\nformat ascii 1.0\nelement vertex three\n");
    write("tour.json", kTour);
    write("words.json", R"({"de": {"grab": "Zugreifen!"}})");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  /// With lines of the good profile that are other ones.
  void profile(const std::vector<std::pair<int, std::string>>& other) const {
    std::string text;
    for (std::size_t i = 0; i < kGood.size(); ++i) {
      std::string line = kGood[i];
      for (const auto& [number, words] : other)
        if (number == static_cast<int>(i) + 1) line = words;
      text += line + "\n";
    }
    write("kiosk.json", text);
  }
  std::vector<std::string> faults(int* exit_code = nullptr) const {
    const auto run = run_dubsar({"kiosk", "check", file("kiosk.json"), "--json", "-"});
    if (exit_code != nullptr) *exit_code = run.exit_code;
    std::vector<std::string> out;
    const json said = json::parse(run.out, nullptr, false);
    if (said.is_discarded()) return {run.err};
    for (const auto& fault : said.at("faults")) out.push_back(fault);
    return out;
  }
  std::filesystem::path folder_;
};

struct Slip {
  int line, column;   ///< of the profile, of its words or its tour
  std::string with;   ///< that line
  std::string words;  ///< in the sentence: what is wrong, and what to do
  const char* file = "kiosk.json";
};

std::string longer(int letters) {
  std::string out = "Ein Siegel";
  while (static_cast<int>(out.size()) < letters) out += out.size() % 7 == 0 ? ' ' : 'e';
  return out;
}

std::vector<Slip> slips() {
  const std::string object = R"( "objects": [{"file": "block.obj", "title": {"de": "Ein Block", "en": "A block"}, )";
  return {
      // What is no JSON.
      {3, 2, "", "a comma is missing before \"objects\""},  // line 2 lost its comma
      {9, 15, R"( "pin": "4711",})", "a comma too many before }"},
      {8, 16, R"( "brightness": 0,9,)", "0,9 found, expected a decimal point: 0.9"},
      {4, 16, R"( "languages": [„de“, "en"],)", "the quote „ found, expected the straight \""},
      {5, 26, R"( "words": "words.json",  // ours)", "a comment found; JSON has none, take it out"},
      {4, 2, R"( languages: ["de", "en"],)", "languages found, expected a name in quotes"},
      {5, 10, R"( "words" "words.json",)", "a colon is missing after \"words\""},
      {8, 16, R"( "brightness": .9,)", ".9 is no number of JSON, expected one such as 0.5"},
      {7, 25, R"( "quiet": ["18:00-09:30";],)", "; found, expected a comma"},
      {10, 1, R"( "pin": "4711")", "the text ends before the } that closes the { of line 1"},
      {5, 18, R"( "words": "museum\words.json",)", "a single \\ before w found in a text, expected \\\\"},
      // What no kiosk understands.
      {2, 2, R"( "version": 7,)", "version 7 found, expected 1"},
      {9, 2, R"( "pni": "4711", "key_file": "key"})", "\"pni\" is unknown, expected one of: format"},
      {9, 2, R"( "pin": "47"})", "\"pin\" is no text of 4 to 12 digits"},
      {1, 1, R"( "attract_after_s": 9})", "neither \"pin\" nor \"key_file\" is given"},
      {8, 2, R"( "brightness": 7,)", "brightness is 7, expected 0.1 to 1"},
      {8, 2, R"( "idle_reset_s": "soon",)", "idle_reset_s is string, expected a number of 5 to 3600"},
      {7, 12, R"( "quiet": ["25:00-09:00"],)", "25:00-09:00"},
      {7, 2, R"( "quiet": ["00:00-12:00", "12:00-00:00"],)", "dark all day and night; expected hours"},
      {4, 2, R"( "languages": [],)", "\"languages\" names none, expected such as"},
      {4, 28, R"( "languages": ["de", "en", "it"],)", "language \"it\" found, expected de, en, fr"},
      {9, 17, R"( "pin": "4711", "pin": "4712"})", "\"pin\" is there twice and the last one counts; take one out"},
      // Objects and their texts.
      {3, 15, R"( "objects": [{"file": "gone.exa"}],)", "gone.exa is not there; expected a file"},
      {3, 15, R"( "objects": [{"file": "C:\\Users\\me\\tablet.exa"}],)", "a path of Windows found"},
      {3, 15, R"( "objects": [{"file": "broken.ply"}],)", "broken.ply"},
      {3, 36, R"( "objects": [{"file": "block.obj", "style": "reliev"}],)", "did you mean \"relief\""},
      {3, 38, R"( "objects": [{"file": "block.obj"}, {"file": "block.obj"}],)", "once more; take one out"},
      {3, 14, R"( "objects": [{"tour": "tour.json"}],)", "\"file\" is missing, expected a surface such as tablet.exa"},
      {3, 36, R"( "objects": [{"file": "block.obj", "title": {"de": "Ein Block"}}],)",
       "no text in \"en\"; add it, else \"Ein Block\" is shown"},
      {3, 68, R"( "objects": [{"file": "block.obj", "title": {"de": "A", "en": "B", "deutsch": "C"}}],)",
       "a text in \"deutsch\", which is none of the profile's languages"},
      {3, 46, R"( "objects": [{"file": "block.obj", "title": {"de": ")" + longer(240) + R"(", "en": "A"}}],)",
       "where 2 stand beside the object; shorten it"},
      {3, 46, R"( "objects": [{"file": "block.obj", "title": {"de": "Die Tafel 楔形", "en": "A"}}],)",
       "letters that the font lacks (U+6954, U+5F62)"},
      // Other files.
      {3, 83, object + R"("tour": "gone.json"}],)", "gone.json is not there"},
      {3, 69, R"( {"title": {"de": "Zwei", "en": "Two"}, "keyframes": [{"time_s": 2, "unpack": 4}]}]})",
       "unpack is 4, expected 0 to 1", "tour.json"},
      {1, 9, R"({"de": {"grap": "Zugreifen!"}})", "a line \"grap\", which does not exist", "words.json"},
      // Displays and devices.
      {6, 13, R"( "inputs": ["leapmotion"],)", "leapmotion"},
      {5, 2, R"( "display": "lookingglass",)", "lookingglass"},
      {5, 14, R"( "panels": [{"display": "hologram", "monitor": "DP-9"}],)", "hologram"},
  };
}

TEST_F(KioskCheck, NothingIsWrongWithAGoodProfile) {
  profile({});
  EXPECT_TRUE(faults().empty()) << faults().front();
}

TEST_F(KioskCheck, EachSlipIsOneSentenceWithLineColumnAndRemedy) {
  const std::vector<Slip> all = slips();
  EXPECT_GE(all.size(), 36U);
  for (const Slip& slip : all) {
    write("tour.json", kTour);
    write("words.json", R"({"de": {"grab": "Zugreifen!"}})");
    profile({});
    const std::string which = slip.file;
    if (which == "words.json") {
      write("words.json", slip.with);
    } else if (which == "tour.json") {
      std::string text = kTour;
      text.replace(text.rfind('\n') + 1, std::string::npos, slip.with);
      write("tour.json", text);
    } else if (slip.words.find("comma is missing") != std::string::npos) {
      profile({{2, R"( "version": 1)"}});
    } else if (slip.line == 10 || slip.line == 1) {
      profile({{9, slip.with}});
    } else {
      profile({{slip.line, slip.with}});
    }
    int exit_code = 0;
    const auto said = faults(&exit_code);
    ASSERT_EQ(said.size(), 1U) << slip.with << "\n" << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find(slip.words), std::string::npos) << said[0];
    std::smatch place;
    ASSERT_TRUE(std::regex_search(said[0], place, std::regex(which + ", line ([0-9]+), column ([0-9]+): "))) << said[0];
    EXPECT_EQ(place[1], std::to_string(slip.line)) << said[0];
    EXPECT_EQ(place[2], std::to_string(slip.column)) << said[0];
    EXPECT_EQ(said[0].find('\n'), std::string::npos);
    EXPECT_TRUE(exit_code == 78 || exit_code == 66 || exit_code == 65 || exit_code == 69) << exit_code << said[0];
  }
}

TEST_F(KioskCheck, AllFaultsAreToldAtOnceAfterThoseOfTheJsonToo) {
  profile({{2, R"( "version": 1)"},
           {4, R"( "languages": ["de", "it",],)"},
           {7, R"( "quiet": ["18:00-09:30"], "brigtness": 1,)"},
           {8, R"( "brightness": 0,9,)"},
           {9, R"( "pin": "47"})"}});
  const auto said = faults();
  ASSERT_EQ(said.size(), 6U) << ::testing::PrintToString(said);
  for (const auto& [i, words] :
       std::vector<std::pair<std::size_t, std::string>>{{0, "line 3, column 2: a comma is missing"},
                                                        {1, "line 4, column 22: language \"it\" found"},
                                                        {2, "line 4, column 26: a comma too many"},
                                                        {3, "line 7, column 28: \"brigtness\" is unknown"},
                                                        {4, "line 8, column 16: 0,9 found"},
                                                        {5, "line 9, column 2: \"pin\" is no text"}})
    EXPECT_NE(said[i].find(words), std::string::npos) << said[i];
}

TEST_F(KioskCheck, WritesAPictureOfEachScreen) {
  profile({});
  const auto run = run_dubsar({"kiosk", "check", file("kiosk.json"), "--pictures", file("p"), "--panel", "400x300"});
  std::vector<std::string> names;
  for (const auto& one : std::filesystem::directory_iterator(folder_ / "p")) names.push_back(one.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"object-1-1-attract.png", "object-1-2-teaching.png", "object-1-3-object.png",
                                      "object-1-4-text.png", "object-1-5-operator.png"}))
      << run.err << run.out;
  const auto attract = read_png(file("p/object-1-1-attract.png"));
  ASSERT_TRUE(attract);
  EXPECT_EQ(attract->width, 960);
  EXPECT_EQ(attract->height, 720);
}

}  // namespace
}  // namespace dubsar::test
