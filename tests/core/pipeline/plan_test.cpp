// The table of stages agrees with itself, with the figures of docs/speed.md, and with what runs take.

#include "core/pipeline/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace dubsar {
namespace {

RunShape paper(bool half, double vertices, int threads = 2) {
  RunShape run;
  run.scan = {1871, 999, 1723};
  run.half = half;
  run.vertices = vertices;
  run.threads = threads;
  return run;
}

TEST(Plan, StagesStandInTheirOrderAndReadOnlyWhatEarlierOnesHaveWritten) {
  unsigned written = 1U << static_cast<unsigned>(Value::kScan);
  for (std::size_t i = 0; i < kStages; ++i) {
    const StagePlan& stage = kRunPlan[i];
    EXPECT_EQ(stage.stage, static_cast<RunStage>(i));
    EXPECT_EQ(stage.reads.bits & ~(written | stage.writes.bits), 0U) << stage.when;
    written |= stage.writes.bits;
    double shares = 0.0;
    for (const StagePhase& phase : stage.phases) shares += phase.share;
    EXPECT_TRUE(shares == 0.0 || std::abs(shares - 1.0) < 1e-9) << stage.when;
    EXPECT_GE(stage.serial, 0.0);
    EXPECT_LT(stage.serial, 1.0);
  }
}

TEST(Plan, EveryCostGrowsWithTheScanAndItsSurface) {
  RunShape run = paper(false, 2e7);
  run.straight.emplace();
  RunShape more = run;
  more.scan.z *= 2;
  more.vertices *= 2.0;
  for (const StagePlan& stage : kRunPlan) {
    EXPECT_GE(bytes_while(stage, more), bytes_while(stage, run)) << stage.when;
    EXPECT_GE(stage.core_s(more), stage.core_s(run)) << stage.when;
  }
  EXPECT_GT(cost_of(run).bytes, cost_of(run, RunStage::kLight).bytes);
  const auto with = [](int threads) { return cost_of(paper(false, 2e7, threads)); };
  EXPECT_GT(with(1).wall_s, with(2).wall_s);
  EXPECT_GT(with(2).wall_s, with(16).wall_s);
  EXPECT_LT(with(2).bytes, with(16).bytes);
}

// Of docs/speed.md: two cores, and sixteen of another machine; what a run takes there within a third.
TEST(Plan, ThePapersSizeTakesWhatItTook) {
  const auto near = [](double planned, double took) { return std::abs(planned - took) <= took / 3.0; };
  EXPECT_TRUE(near(cost_of(paper(true, 5.39e6, 2)).wall_s, 68.0)) << cost_of(paper(true, 5.39e6, 2)).wall_s;
  EXPECT_TRUE(near(cost_of(paper(false, 22.2e6, 2)).wall_s, 167.0)) << cost_of(paper(false, 22.2e6, 2)).wall_s;
  EXPECT_TRUE(near(cost_of(paper(false, 22.2e6, 16)).wall_s, 69.0)) << cost_of(paper(false, 22.2e6, 16)).wall_s;
}

TEST(Plan, AGridOnTheDiskTakesNoMemoryAndAStraightenedOneStaysUntilTheContactIsTraced) {
  RunShape run = paper(false, 2e7);
  const double half_grid = 4.0 * static_cast<double>(grid_of(run.scan, true).count());
  EXPECT_GT(bytes_while(kRunPlan[1], run), half_grid);
  run.half_place = GridPlace::kScratch;
  EXPECT_LT(bytes_while(kRunPlan[1], run), half_grid);
  EXPECT_EQ(cost_of(run).scratch_bytes, half_grid);
  RunShape straight = run;
  straight.straight.emplace();
  const double grid = 4.0 * static_cast<double>(run.scan.count());
  for (const StagePlan& stage : kRunPlan) {
    const double more = bytes_while(stage, straight) - bytes_while(stage, run);
    EXPECT_NEAR(more, stage.stage < RunStage::kRays || stage.stage > RunStage::kContact ? 0.0 : grid, 0.1 * grid)
        << stage.when;
  }
}

// The mesh of a surface that is made fair lies beside the bricks near it, whether it is or not; time is its own.
TEST(Plan, ASurfaceThatIsMadeFairTakesTimeAndMemoryOnlyWhereItIsFound) {
  RunShape run = paper(false, 22.2e6), noisy = run, unfiltered = run;
  noisy.noise.made_fair = true;
  unfiltered.noise.passes = 0;
  for (const StagePlan& stage : kRunPlan) {
    const bool finds = stage.stage == RunStage::kSurface;
    EXPECT_EQ(stage.core_s(noisy) > stage.core_s(run), finds) << stage.when;
    EXPECT_EQ(bytes_while(stage, noisy), bytes_while(stage, run)) << stage.when;
    EXPECT_EQ(bytes_while(stage, run) > bytes_while(stage, unfiltered), finds) << stage.when;
  }
  EXPECT_EQ(cost_of(run).bytes, cost_of(unfiltered).bytes);  // other stages need more
}

TEST(Plan, TheRefusalSaysWhatForWhenAndHowMuch) {
  const auto fits = check_fits(paper(false, 22.2e6), 1ULL << 30);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().kind, ErrorKind::kTryAgain);
  for (const char* part :
       {"22.20 million vertices", "1871 x 999 x 1723", "GiB of memory while the contact is traced", "1.0 GiB are left"})
    EXPECT_NE(fits.error().message.find(part), std::string::npos) << fits.error().message;
  EXPECT_TRUE(check_fits(paper(false, 22.2e6), 1ULL << 40));
}

}  // namespace
}  // namespace dubsar
