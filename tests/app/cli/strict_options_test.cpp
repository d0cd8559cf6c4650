// Numbers on the command line are taken whole or refused: no trailing rubbish, no NaN, no infinity, nothing read as 0.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
using ::testing::HasSubstr;

void expect_refused(const std::vector<std::string>& arguments, const std::string& says) {
  const ProgramRun run = run_dubsar(arguments);
  EXPECT_EQ(run.exit_code, 64) << ::testing::PrintToString(arguments) << run.err;
  EXPECT_THAT(run.err, HasSubstr(says));
}

TEST(StrictOptions, LightsSizesAndPlacesAreReadToTheirEnd) {
  for (const char* light : {"nan,nan", "315,25,7", "315,25deg", "inf,20", "315", "315,", "315,91", "1e999,20", ""})
    if (*light) expect_refused({"render", "a.exa", "-o", "a.png", "--light", light}, "--light");
  for (const char* size : {"960x540x", "960x", "960", "960 x540", "0x0", "960x-540", "1e3x540"})
    expect_refused({"render", "a.exa", "-o", "a.png", "--size", size}, "--size");
  for (const char* size : {"960x540x", "15x540", "960x540.5"})
    expect_refused({"view", "a.exa", "--offscreen", "--size", size}, "--size");
  for (const char* viewer : {"0,0,nan", "0,0,600,1", "0,0", "0,0,600mm"})
    expect_refused({"render", "a.exa", "-o", "a.png", "--display", "anaglyph", "--viewer", viewer}, "--viewer");
  expect_refused({"render", "a.exa", "-o", "a.png", "--display", "mono", "--screen-mm", "344x194x"}, "--screen-mm");
}

TEST(StrictOptions, NumbersThatAreNoneAndNamesWithoutLettersAreRefusedBeforeAnythingIsRead) {
  for (const char* number : {"nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999"}) {
    for (const char* option : {"--threshold", "--sigma", "--concavity", "--max-error", "--ao-radius"})
      expect_refused({"process", "a.h5", option, number}, std::string(option) + ": " + number + " found");
    expect_refused({"animate", "film.json", "a.exa", "-o", "pictures", "--fps", number}, "--fps");
  }
  for (const char* seed : {"-1", "-18446744073709551615", "1e3", "18446744073709551616"})
    expect_refused({"phantom", "a.h5", "--seed", seed}, std::string("--seed: ") + seed + " found");
  expect_refused({"process", "a.h5", "-o", ""}, "--output: nothing found, expected a name");
  expect_refused({"info", "a.exa", "--json", ""}, "--json: nothing found, expected a name");
  expect_refused({"phantom", ""}, "OUT");
  expect_refused({"phantom", "a.h5", "--scanner", "loud"}, "\"loud\" is unknown, expected good, mild, medium, strong");
  expect_refused({"phantom", "a.h5", "--scanner", "good,colour=3"}, "colour");
  expect_refused({"phantom", "a.h5", "--scanner", "--snr", "20"}, "--snr, --blur and --rings");
}

TEST(StrictOptions, AnEyeBehindThePanelIsRefused) {
  expect_refused({"render", "a.exa", "-o", "a.png", "--display", "anaglyph", "--viewer", "0,0,-600"},
                 "behind the panel");
  expect_refused(
      {"render", "--pattern", "-o", "a.png", "--display", "lenticular:looking-glass-go", "--see-from", "0,0,0"},
      "behind the panel");
}

}  // namespace
}  // namespace dubsar::test
