// What a tired stranger types, and what is answered: one sentence that says what was found and what to do, before any
// large file is read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/files/atomic_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class Words : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = fs::temp_directory_path() / fmt::format("dubsar_words_{}", ::getpid());
    fs::create_directories(folder());
    ASSERT_EQ(run_dubsar({"phantom", at("scan.h5"), "--size", "160x96x160", "--seed", "5"}).exit_code, 0);
    processed() = run_dubsar({"process", at("scan.h5"), "--no-ao"});
    ASSERT_EQ(processed().exit_code, 0) << processed().err;
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  static fs::path& folder() {
    static fs::path path;
    return path;
  }
  static ProgramRun& processed() {
    static ProgramRun run;
    return run;
  }
  static std::string at(const std::string& name) { return (folder() / name).string(); }
  static void answered(const std::vector<std::string>& arguments, int exit_code, const std::string& says) {
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << ::testing::PrintToString(arguments);
    EXPECT_THAT(run.err, HasSubstr(says)) << ::testing::PrintToString(arguments);
    EXPECT_EQ(run.err.find("error: "), 0u) << run.err;
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "one sentence: " << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
};

TEST_F(Words, SlipsAreNamed) {
  answered({"proces", "a.h5"}, 64, "did you mean \"process\"?");
  answered({"devices", "lst"}, 64, "did you mean \"list\"?");
  answered({"render", at("scan.exa"), "-o", at("a.png"), "--style", "rakin"}, 64, "did you mean \"raking\"?");
  answered({"process", at("scan.h5"), "--denoise", "jont"}, 64, "did you mean \"joint\"?");
  answered({"render", at("scan.exa"), "--display", "anaglyf"}, 64, "did you mean \"anaglyph\"?");
  answered({"process", at("scan.h")}, 66, "did you mean \"" + at("scan.h5") + "\"?");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"export", at("scan.exa"), at("a.stl"), "--partition", "tabel"},
        {"render", at("scan.exa"), "--hide", "tabel"},
        {"fatcross", at("scan.exa"), "--part", "tabel"},
        {"view", at("scan.exa"), "--offscreen", "--partition", "tabel"}})
    answered(arguments, 64, "there is no part \"tabel\"");
}

TEST_F(Words, WhatIsMissingComesWithAnExample) {
  answered({"process"}, 64, "IN is missing");
  answered({"process"}, 64, "for example: dubsar process scan.h5");
  answered({"fatcross", at("scan.exa"), "--dpi"}, 64, "--dpi found without");
  answered({"fatcross", at("scan.exa"), "--dpi", "abc"}, 64, "--dpi: abc found, expected 50 to 4800");
  answered({"info", at("scan.exa"), "more"}, 64, "\"more\" is more than dubsar info expects");
}

TEST_F(Words, AFileInsteadOfAVerbIsAnsweredWithTheVerb) {
  answered({at("scan.h5")}, 64, "dubsar process " + at("scan.h5"));
  answered({at("scan.exa")}, 64, "dubsar view " + at("scan.exa"));
}

TEST_F(Words, OptionsThatCannotBeUnderstoodAreObjectsForPrograms) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", "--json", "-"},
                                                    {"process", "a.h5", "--nonsense", "--json=-"},
                                                    {"nonsense", "--json", "-"}}) {
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 64);
    const json object = json::parse(run.out, nullptr, false);
    ASSERT_TRUE(object.is_object()) << run.out;
    EXPECT_EQ(object["error"]["exit_code"], 64);
    EXPECT_FALSE(object["error"]["message"].get<std::string>().empty());
  }
}

TEST_F(Words, HelpOfAVerbIsFoundBothWays) {
  EXPECT_EQ(run_dubsar({"help", "process"}).out, run_dubsar({"process", "--help"}).out);
  EXPECT_EQ(run_dubsar({"help"}).exit_code, 0);
  EXPECT_THAT(run_dubsar({"--help"}).out, HasSubstr("fatcross"));
}

TEST_F(Words, AfterProcessTheSizeThePartsWhatIsInferredAndWhatToDoNext) {
  const std::string& text = processed().out;
  EXPECT_THAT(text, HasSubstr("a tablet inside its envelope"));
  EXPECT_THAT(text, ::testing::ContainsRegex("tablet +[0-9.]+ x [0-9.]+ x [0-9.]+ mm"));
  EXPECT_THAT(text, ::testing::ContainsRegex("tablet +[0-9.]+ mm2, [0-9.]+ % of its surface"));
  EXPECT_THAT(text, HasSubstr("dubsar view " + at("scan.exa")));
  EXPECT_THAT(text, Not(HasSubstr("wall s"))) << "the table is for --verbose";
  const ProgramRun verbose =
      run_dubsar({"process", at("scan.h5"), "-o", at("v.exa"), "--detail", "half", "--no-ao", "--verbose"});
  EXPECT_THAT(verbose.out, HasSubstr("wall s"));
  EXPECT_THAT(verbose.out, HasSubstr("dubsar view"));
}

TEST_F(Words, InfoOfASurfaceChecksItsSumsAndMeasuresIt) {
  const ProgramRun info = run_dubsar({"info", at("scan.exa")});
  EXPECT_THAT(info.out, HasSubstr("all sums are good"));
  EXPECT_THAT(info.out, ::testing::ContainsRegex("box +[0-9.]+ x [0-9.]+ x [0-9.]+ mm"));
  std::string bytes = *read_text_file(at("scan.exa"), 1 << 28);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  ASSERT_TRUE(write_file_atomically(at("bad.exa"), bytes));
  const ProgramRun bad = run_dubsar({"info", at("bad.exa"), "--json", "-"});
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_TRUE(json::parse(bad.out)["error"].is_object());
}

TEST_F(Words, OutputsThatWereNotNamedLieBesideTheInput) {
  ASSERT_EQ(run_dubsar({"export", at("scan.exa")}).exit_code, 0);
  EXPECT_TRUE(fs::exists(at("scan.ply")));
  ASSERT_EQ(run_dubsar({"render", at("scan.exa"), "--size", "64x48"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(at("scan_front.png")));
  ASSERT_EQ(run_dubsar({"fatcross", at("scan.exa"), "--dpi", "80", "--no-sides"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(at("scan_fatcross.tif")));
}

TEST_F(Words, StlOfSeveralPartsSaysThatTheirPatchesLieOnEachOther) {
  const ProgramRun all = run_dubsar({"export", at("scan.exa"), at("all.stl"), "--json", "-"});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  const json result = json::parse(all.out);
  EXPECT_GT(result["coincident_triangles"].get<int>(), 0);
  EXPECT_FALSE(result["watertight"].get<bool>());
  EXPECT_FALSE(json::parse(run_dubsar({"info", at("all.stl"), "--json", "-"}).out)["watertight"].get<bool>())
      << "a reader that joins equal points agrees";
  EXPECT_THAT(run_dubsar({"export", at("scan.exa"), at("all.stl")}).out, HasSubstr("--partition tablet"));
  const json one =
      json::parse(run_dubsar({"export", at("scan.exa"), at("t.stl"), "--partition", "tablet", "--json", "-"}).out);
  EXPECT_EQ(one["coincident_triangles"], 0);
  EXPECT_TRUE(one["watertight"].get<bool>());
  EXPECT_TRUE(json::parse(run_dubsar({"info", at("t.stl"), "--json", "-"}).out)["watertight"].get<bool>())
      << "a reader that joins equal points agrees";
}

}  // namespace
}  // namespace dubsar::test
