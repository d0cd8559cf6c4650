// What a window shows and what the verbs draw is one thing: the same commands, the same bytes.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "app/commands/command_table.h"
#include "core/base/files/atomic_file.h"
#include "core/image_io/png_file.h"
#include "display/render/shading.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

class ToldCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_told_{}", ::getpid());
    fs::create_directories(folder_);
    ASSERT_EQ(run_dubsar({"phantom", file("scan.h5"), "--preset", "tiny"}).exit_code, 0);
    ASSERT_EQ(run_dubsar({"process", file("scan.h5"), "-o", file("tablet.exa"), "-q"}).exit_code, 0);
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string file(const std::string& name) { return (folder_ / name).string(); }

  /// The last picture of a session without a window that is told the commands.
  static Image of_session(const std::vector<std::string>& commands) {
    std::string steps;
    for (const std::string& text : commands) steps += "0 " + text + "\n";
    EXPECT_TRUE(write_file_atomically(file("steps.txt"), steps));
    fs::remove_all(file("frames"));
    const ProgramRun run =
        run_dubsar({"view", file("tablet.exa"), "--offscreen", "--size", "240x180", "--samples", "1", "--fps", "4",
                    "--every", "4", "--steps", file("steps.txt"), "--frames", file("frames")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    auto image = read_png(file("frames/frame-00004.png"));
    EXPECT_TRUE(image) << image.error().message;
    return image ? *std::move(image) : Image();
  }
  static Image of_render(const std::vector<std::string>& commands) {
    std::vector<std::string> arguments{"render", file("tablet.exa"), "-o",        file("told.png"),
                                       "--size", "240x180",          "--samples", "1"};
    for (const std::string& text : commands) {
      arguments.push_back("--do");
      arguments.push_back(text);
    }
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    auto image = read_png(file("told.png"));
    EXPECT_TRUE(image) << image.error().message;
    return image ? *std::move(image) : Image();
  }
  inline static fs::path folder_;
};

/// Those of every_command.txt that change the picture of one surface and write no file.
std::vector<std::string> drawing_commands() {
  std::vector<std::string> styles;
  for (const std::string_view name : shading_preset_names()) styles.emplace_back(name);
  const app::CommandTable table = app::CommandTable::standard(styles);
  const std::set<std::string> lasting{"sweep",      "play",      "upright",   "take_over",
                                      "set_beside", "take_away", "difference"};  // move on, or need what is not there
  std::istringstream lines(read_text_file(DUBSAR_EVERY_COMMAND).value());
  std::vector<std::string> out;
  const std::regex timed("^[+]?[0-9.]+ (.*)$");
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, timed)) continue;
    const std::string text = found[1];
    const app::Command* const command = table.find(app::split_command(text).first);
    if (command == nullptr || command->group == app::kWindowGroup || command->group == app::kFileGroup) continue;
    if (lasting.contains(command->name) || text.find("FOLDER") != std::string::npos) continue;
    if (command->name.find("slice") != std::string::npos) continue;  // of the scan's window
    out.push_back(text);
  }
  return out;
}

TEST_F(ToldCommand, EveryCommandGivesTheSamePictureThroughSessionAndRender) {
  const std::vector<std::string> all = drawing_commands();
  ASSERT_GT(all.size(), 60u);
  const Image expected = of_session(all), found = of_render(all);
  ASSERT_EQ(found.width, 240);
  EXPECT_TRUE(found.pixels == expected.pixels);
}

TEST_F(ToldCommand, EachOfThemGivesTheSamePictureAndAnotherThanNone) {
  const Image plain = of_render({"reset"});
  for (const std::vector<std::string>& told :
       std::vector<std::vector<std::string>>{{"side reverse"},
                                             {"unpack 100"},
                                             {"style msii", "blend raking 40"},
                                             {"cut front 30", "section"},
                                             {"add_note 0,0,8 um-ma", "side obverse"},
                                             {"part_opacity envelope 40"},
                                             {"light 90,15", "fog 60"}}) {
    const Image expected = of_session(told), found = of_render(told);
    EXPECT_TRUE(found.pixels == expected.pixels) << told.front();
    EXPECT_TRUE(found.pixels != plain.pixels) << told.front();
  }
}

TEST_F(ToldCommand, AnotherTabletStandsBesideInWindowRenderAndFilm) {
  const Image plain = of_render({"reset"});
  ASSERT_EQ(run_dubsar({"phantom", file("b.h5"), "--preset", "tiny", "--seed", "5"}).exit_code, 0);
  ASSERT_EQ(run_dubsar({"process", file("b.h5"), "-o", file("b.exa"), "-q"}).exit_code, 0);
  Image last = plain;
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {}, {"side reverse"}, {"unpack 60"}, {"difference 0.5"}, {"add_note 0,0,8 um-ma", "style msii"}}) {
    std::vector<std::string> told{"set_beside " + file("b.exa")};
    told.insert(told.end(), more.begin(), more.end());
    const Image expected = of_session(told), found = of_render(told);
    EXPECT_TRUE(found.pixels == expected.pixels) << told.back();
    EXPECT_TRUE(found.pixels != last.pixels) << told.back();
    last = found;
  }
  EXPECT_TRUE(of_render({"set_beside " + file("b.exa"), "take_away"}).pixels == plain.pixels);
  EXPECT_TRUE(of_render({"set_beside " + file("b.exa"), "undo"}).pixels == plain.pixels);
  // A film of one picture.
  std::ofstream(file("say.txt")) << "0 keyframe\n0 write_film " << file("film.json") << "\n";
  ASSERT_EQ(run_dubsar({"view", file("tablet.exa"), "--offscreen", "--fps", "4", "--steps", file("say.txt")}).exit_code,
            0);
  const auto film = [&](const std::vector<std::string>& more) {
    fs::remove_all(file("film"));
    std::vector<std::string> arguments{"animate", file("film.json"), file("tablet.exa"), "-o", file("film"),
                                       "--size",  "240x180",         "--samples",        "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    for (const auto& each : fs::directory_iterator(file("film")))
      if (each.path().extension() == ".png") return read_png(each.path()).value();
    return Image();
  };
  const Image pair = film({"--do", "set_beside " + file("b.exa")});
  ASSERT_EQ(pair.width, 240);
  int right = 0;
  for (int y = 40; y < 140; ++y) right += pair.at(180, y)[0] > 60 ? 1 : 0;
  EXPECT_GT(right, 60) << "the other one stands in the right half";
  EXPECT_TRUE(pair.pixels != film({}).pixels);
}

TEST_F(ToldCommand, SheetsAndReportsTakeTheLook) {
  const auto sheet = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"fatcross", file("tablet.exa"), "-o", file("sheet.png"), "--dpi",
                                       "60",       "--samples",        "1",  "--no-sides"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read_png(file("sheet.png")).value().pixels;
  };
  const auto plain = sheet({});
  EXPECT_EQ(sheet({"--do", "side reverse"}), plain) << "sheets have their own sides";
  EXPECT_EQ(sheet({"--do", "style msii"}), sheet({"--style", "msii"}));
  EXPECT_NE(sheet({"--do", "light 90,10"}), plain);
  const ProgramRun run = run_dubsar({"report", file("tablet.exa"), "-o", file("page.html"), "--do", "style msii"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(ToldCommand, WhatIsNoCommandOrCannotBeDoneIsSaidBeforeAPictureIsMade) {
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", file("tablet.exa"), "-o", file("none.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 64) << run.err;
    EXPECT_FALSE(fs::exists(file("none.png")));
    return run.err;
  };
  EXPECT_NE(refused({"--do", "fly away"}).find("--do \"fly away\": \"fly\" is no command"), std::string::npos);
  EXPECT_NE(refused({"--do", "delete_note 3"}).find("there is nothing to do it to now"), std::string::npos);
  EXPECT_NE(refused({"--do", "difference"}).find("there is nothing to do it to now"), std::string::npos);
  EXPECT_NE(refused({"--do", "unpack 50", "--cut", "front:50"}).find("--cut"), std::string::npos);
}

}  // namespace
}  // namespace dubsar::test
