// The user's folder: what replaces what, and files that somebody broke.

#include "display/panels/panel_set.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "display/panels/embedded_profiles.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class PanelFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void file(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file_atomically(folder_ / name, text));
  }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_panel_set_{}", ::getpid());
};

constexpr const char* kGood = R"({"name": "mine", "kind": "lens_sheet", "width_px": 1920, "height_px": 1080, "dpi": 90,
  "view_cone_deg": 22, "views": 7, "lens": {"pitch": 40, "slope": 5}})";

TEST_F(PanelFolder, AUsersProfileReplacesTheOneOfTheSameName) {
  json profile = json::parse(kGood);
  profile["name"] = "lens-sheet-24-5-views";
  file("mine.json", profile.dump());
  const PanelSet panels = load_panels(folder_);
  EXPECT_EQ(panels.profiles.size(), built_in_panels().profiles.size());
  EXPECT_EQ(panels.find("lens-sheet-24-5-views")->views, 7);
  EXPECT_TRUE(panels.problems.empty());
  EXPECT_EQ(load_panels("/nonexistent").profiles.size(), built_in_panels().profiles.size());
}

TEST_F(PanelFolder, ABadFileLosesItselfAndNotItsNeighbours) {
  file("a.json", "[1]");
  file("b.json", "{ broken");
  file("c.json", kGood);
  file("d.json", std::string(2 << 20, ' '));
  file("e.json", R"([{"name": "half"}, )" + std::string(kGood).replace(10, 4, "also") + "]");
  file("f.json", "[]");
  fs::create_directories(folder_ / "g.json");
  ASSERT_EQ(::symlink("/nowhere", (folder_ / "h.json").c_str()), 0);
  file("i.txt", "not ours");
  const PanelSet panels = load_panels(folder_);
  EXPECT_TRUE(panels.find("mine"));
  EXPECT_TRUE(panels.find("also")) << "of the same file";
  EXPECT_TRUE(panels.find("looking-glass-go"));
  std::string files;
  for (const PanelProblem& problem : panels.problems) {
    files += problem.file.filename().string() + " ";
    EXPECT_NE(problem.reason.find(problem.file.filename().string()), std::string::npos) << problem.reason;
  }
  EXPECT_EQ(files, "a.json b.json d.json e.json f.json g.json h.json ");
  const auto half = panels.find("half");
  EXPECT_EQ(half.error().kind, ErrorKind::kConfig) << "it is there, and wrong";
  const auto unknown = panels.find("other");
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_NE(unknown.error().message.find("b.json"), std::string::npos) << "it may have been in there";
}

TEST_F(PanelFolder, ABrokenReplacementDoesNotFallBackToTheProgramsFigures) {
  json profile = json::parse(kGood);
  profile["name"] = "looking-glass-go";
  profile["views"] = "many";
  file("go.json", profile.dump());
  const auto lost = load_panels(folder_).find("looking-glass-go");
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().kind, ErrorKind::kConfig);
  EXPECT_NE(lost.error().message.find("views is string"), std::string::npos) << lost.error().message;
}

/// Every place of a document that holds a value.
std::vector<json::json_pointer> places_of(const json& document) {
  std::vector<json::json_pointer> places{json::json_pointer()};
  const json flat = document.flatten();  // outlives its items
  for (const auto& [place, value] : flat.items())
    for (json::json_pointer at(place); !at.empty(); at = at.parent_pointer()) places.push_back(at);
  return places;
}

TEST_F(PanelFolder, EveryJsonTypeInEveryFieldEndsInAProfileOrASentence) {
  const std::vector<json> hostile{nullptr,
                                  true,
                                  -1,
                                  0,
                                  1,
                                  1e300,
                                  -0.5,
                                  18446744073709551615u,
                                  "",
                                  "text",
                                  "\u001b[31m",
                                  json::array(),
                                  json::array({1}),
                                  json::array({json::array({1, 2})}),
                                  json::object(),
                                  json{{"value", json::object()}},
                                  json{{"value", 1}},
                                  json{{"R", {1e300, 0}}}};
  int refused = 0, taken = 0;
  for (const auto& [name, text] : embedded_profiles())
    for (const json& profile : json::parse(text))
      for (const json::json_pointer& place : places_of(profile)) {
        for (const json& value : hostile) {
          json changed = profile;
          changed[place] = value;
          const auto read = parse_profile(changed, "hostile.json");
          if (read) {
            ++taken;
            EXPECT_TRUE(panel_optics(*read, viewing_distance_mm(*read)) || (!read->sheet && !read->optics));
            continue;
          }
          ++refused;
          EXPECT_EQ(read.error().kind, ErrorKind::kConfig);
          EXPECT_NE(read.error().message.find("expected"), std::string::npos) << read.error().message;
          EXPECT_EQ(read.error().message.find('\x1b'), std::string::npos) << "terminals would obey it";
        }
        json without = profile;
        if (!place.empty() && without[place.parent_pointer()].is_object()) {
          without[place.parent_pointer()].erase(place.back());
          static_cast<void>(parse_profile(without, "hostile.json"));
        }
      }
  EXPECT_GT(refused, 3000);
  EXPECT_GT(taken, 500);
}

TEST_F(PanelFolder, NamesAreFileNames) {
  for (const char* bad : {"", ".hidden", "a/b", "../a", "a b", "a,b", "a=b", "\x1b[31m", "\u00e9"})
    EXPECT_FALSE(is_panel_name(bad)) << bad;
  EXPECT_FALSE(is_panel_name(std::string(65, 'a')));
  for (const PanelProfile& profile : built_in_panels().profiles) EXPECT_TRUE(is_panel_name(profile.name));
}

}  // namespace
}  // namespace dubsar
