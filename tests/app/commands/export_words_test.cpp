// What is said to the program so that it writes what is published; the options that people choose in the window.

#include "app/commands/export_words.h"

#include <algorithm>

#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

bool says(const std::vector<std::string>& words, const std::string& option, const std::string& value) {
  const auto at = std::find(words.begin(), words.end(), option);
  return at != words.end() && at + 1 != words.end() && at[1] == value;
}

TEST(Export, WordsFollowTheChoiceAndWhatIsSeen) {
  Bench bench;
  for (const char* const how : {"width 170", "dpi 300", "ground grey", "hand filled", "labels"})
    bench.run(std::string("export_as ") + how);
  const ExportChoice& choice = bench.editor.ui().choosing.publishing;
  Document document = bench.now();
  document.parts[1].visible = false;
  document.style.name = "raking";
  document.edition.record.museum_number = "AO 1";
  const ExportFiles files{"/a b/t.exa", "/tmp/s.json", "/a b/t_out"};
  const auto figure = export_words("figure", files, choice, document, "reverse");
  EXPECT_EQ(figure.front(), "render");
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--view", "back"},
                                                                                      {"--width-mm", "170"},
                                                                                      {"--dpi", "300"},
                                                                                      {"--ground", "grey"},
                                                                                      {"--style", "raking"},
                                                                                      {"--partition", "tablet"},
                                                                                      {"-o", "/a b/t_out"}})
    EXPECT_TRUE(says(figure, option, value)) << option;
  EXPECT_NE(std::find(figure.begin(), figure.end(), "--scale-bar"), figure.end());
  const auto copy = export_words("handcopy", files, choice, document, "obverse");
  EXPECT_TRUE(says(copy, "--work", "/tmp/s.json") && says(copy, "--style", "filled") && says(copy, "--title", "AO 1"));
  EXPECT_TRUE(says(export_words("plate", files, choice, document, "top"), "--ground", "grey"));
  EXPECT_EQ(export_words("stl", files, choice, document, "top"),
            (std::vector<std::string>{"export", "/a b/t.exa", "/a b/t_out", "--partition", "tablet"}));
  EXPECT_EQ(export_words("film", files, choice, document, "top")[0], "animate");
  EXPECT_TRUE(export_words("atf", files, choice, document, "top").empty());
}

TEST(Export, WhatCannotBeChosenIsRefusedAndWhatIsWrittenGoesToThePlace) {
  Bench bench;
  EXPECT_NE(bench.refusal("export_as ground pink").find("expected width"), std::string::npos);
  EXPECT_NE(bench.refusal("export_as dpi 3"), "accepted");
  EXPECT_NE(bench.refusal("export lid").find("expected plate"), std::string::npos);
  bench.run("export figure /nowhere/f.png");
  EXPECT_EQ(bench.place.published, std::vector<std::string>{"figure /nowhere/f.png"});
  bench.run("stop_export");
  EXPECT_TRUE(bench.place.published.empty());
}

}  // namespace
}  // namespace dubsar::app
