// Hands of slow and of fast trackers through the program, in its own simulated time.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/cli/block_obj.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {

struct Steps {
  double hands_hz, pictures_hz;
};

class HandsOfEveryRate : public ::testing::TestWithParam<Steps> {};

/// A hand that rests, wipes 200 mm to the right in 400 ms, and rests.
TEST_P(HandsOfEveryRate, AWipeTurnsTheObjectToItsNextSide) {
  const auto [hands_hz, pictures_hz] = GetParam();
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / fmt::format("hands_{}_{}_{}", ::getpid(), hands_hz, pictures_hz);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "block.obj") << kBlockObj;
  std::ofstream(folder / "wipe.json") << fmt::format(
      R"({{"seed": 3, "duration_s": 4, "rate_hz": {}, "noise_mm": 0.4, "hands": [{{"keys": [
        {{"t": 0.2, "at_mm": [-100, 0, 250]}}, {{"t": 1.2, "at_mm": [-100, 0, 250]}}, {{"t": 1.6, "at_mm": [100, 0, 250]}},
        {{"t": 2.6, "at_mm": [100, 0, 250]}}]}}]}})",
      hands_hz);
  const auto done = run_dubsar({"view", (folder / "block.obj").string(), "--offscreen", "--script",
                                (folder / "wipe.json").string(), "--seconds", "4", "--fps",
                                fmt::format("{}", pictures_hz), "--every", "1000", "--size", "64x48", "--json", "-"});
  std::filesystem::remove_all(folder);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NEAR(nlohmann::json::parse(done.out).at("view").at("turned_deg").get<double>(), 90.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Rates, HandsOfEveryRate,
                         ::testing::Values(Steps{25, 30}, Steps{30, 30}, Steps{60, 30}, Steps{90, 30}, Steps{110, 30},
                                           Steps{120, 30}, Steps{30, 60}, Steps{110, 120}),
                         [](const auto& row) {
                           return fmt::format("Hz{:.0f}At{:.0f}Pictures", row.param.hands_hz, row.param.pictures_hz);
                         });

}  // namespace
}  // namespace dubsar::test
