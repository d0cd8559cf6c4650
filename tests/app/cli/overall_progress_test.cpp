// What is said about the whole of a run: how far, how long, in a line that fits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/console_progress.h"
#include "app/cli/default_output.h"

namespace dubsar::app {
namespace {
using ::testing::HasSubstr;
using ::testing::Not;

/// A machine and a scan: seconds that each share of volume and surface work takes.
struct Scan {
  double volume = 1.0, surface = 1.0;
};
const std::vector<PlannedStage> kPlan{{"read", 1.0},         {"denoise", 3.0},       {"denoise", 3.0},
                                      {"smooth", 4.0, true}, {"segment", 6.0, true}, {"ambient occlusion", 20.0, true}};

/// Runs the plan in steps of a twentieth of a stage; calls look(progress, time, time of the whole).
template <class Look>
void run(const Scan& scan, const std::vector<PlannedStage>& stages, const Look& look) {
  double all = 0.0;
  for (const PlannedStage& s : stages) all += s.share * (s.surface ? scan.surface : scan.volume);
  OverallProgress progress(kPlan);
  double now = 100.0;
  for (const PlannedStage& s : stages) {
    const double seconds = s.share * (s.surface ? scan.surface : scan.volume);
    progress.begin(s.name, now);
    for (int k = 1; k <= 20; ++k)
      progress.advance(k / 20.0, now + seconds * k / 20.0), look(progress, now + seconds * k / 20.0 - 100.0, all);
    now += seconds;
  }
}

TEST(OverallProgress, HalfWayTheEstimateIsWithinThirtyPercent) {
  for (const Scan& scan : {Scan{1, 1}, Scan{0.3, 3}, Scan{8, 1}, Scan{10, 40}})
    run(scan, kPlan, [](const OverallProgress& progress, double now, double all) {
      if (now < 0.5 * all) return;
      const auto left = progress.remaining_s(now + 100.0);
      if (!left) {
        EXPECT_LT(progress.fraction(), 7.1 / 37.0) << "only while the surface is not known";
        return;
      }
      EXPECT_NEAR(*left, all - now, 0.3 * (all - now) + 1e-6) << "at " << now << " of " << all;
    });
}

TEST(OverallProgress, NothingIsSaidBeforeThereIsAnythingToGoBy) {
  OverallProgress progress(kPlan);
  progress.begin("read", 0.0);
  progress.advance(0.5, 1.0);
  EXPECT_FALSE(progress.remaining_s(1.0)) << "after a second";
  EXPECT_FALSE(OverallProgress().remaining_s(100.0)) << "without a plan";
}

TEST(OverallProgress, ItNeverGoesBackAndEndsWhole) {
  std::vector<PlannedStage> stages = kPlan;
  stages.insert(stages.begin() + 3, {"settle", 2.0, true});   // nobody planned it
  stages.erase(stages.begin() + 2);                           // the second pass is left out
  stages.insert(stages.begin() + 5, {"segment", 6.0, true});  // once more
  double before = 0.0;
  run({1, 1}, stages, [&](const OverallProgress& progress, double, double) {
    EXPECT_GE(progress.fraction(), before);
    before = progress.fraction();
  });
  EXPECT_DOUBLE_EQ(before, 1.0);
}

TEST(ProgressLine, FitsTheTerminalAndLosesTheBarFirst) {
  const ProgressLine line{"closing holes", 0.414, 4321.0, 4100.0};
  for (int columns = 20; columns < 200; ++columns)
    EXPECT_LT(progress_line(line, columns).size(), static_cast<std::size_t>(columns) + (columns == 20 ? 1 : 0))
        << columns;
  EXPECT_THAT(progress_line(line, 60), HasSubstr(" 41 %  1:12:01, about 1 h 10 min left"));
  EXPECT_THAT(progress_line(line, 80), HasSubstr("["));
  EXPECT_THAT(progress_line(line, 50), Not(HasSubstr("[")));
  EXPECT_THAT(progress_line({"reading", std::nullopt, 3.0, std::nullopt}, 60), HasSubstr("reading"));
  EXPECT_THAT(progress_line({"reading", std::nullopt, 3.0, std::nullopt}, 60), HasSubstr("0:03"));
  EXPECT_THAT(progress_line({"reading", std::nullopt, 3.0, std::nullopt}, 60), Not(HasSubstr("%")));
  EXPECT_THAT(progress_line({"reading", 0.5, 3.0, std::nullopt}, 60), HasSubstr("0:03"));
  EXPECT_THAT(progress_line({"reading", 0.5, 3.0, std::nullopt}, 60), Not(HasSubstr("left")));
}

TEST(RoughDuration, IsAsExactAsAnEstimate) {
  EXPECT_EQ(rough_duration(4), "a few seconds");
  EXPECT_EQ(rough_duration(23), "about 25 s");
  EXPECT_EQ(rough_duration(64), "about 1 min");
  EXPECT_EQ(rough_duration(100), "about 2 min");
  EXPECT_EQ(rough_duration(1500), "about 25 min");
  EXPECT_EQ(rough_duration(3600), "about 1 h");
  EXPECT_EQ(rough_duration(7000), "about 2 h");
  EXPECT_EQ(rough_duration(8400), "about 2 h 20 min");
}

TEST(DefaultOutput, LiesBesideTheInput) {
  EXPECT_EQ(output_beside("scans/tablet.h5", ".exa"), "scans/tablet.exa");
  EXPECT_EQ(output_beside("tablet.h5:/entry/data", ".exa"), "tablet.exa");
  EXPECT_EQ(output_beside("/tmp/", ".exa"), "/tmp.exa");
  EXPECT_EQ(output_beside("tablet.v2.exa", "_fatcross.tif"), "tablet.v2_fatcross.tif");
  EXPECT_EQ(output_beside("", ".exa"), "");
}

TEST(DefaultOutput, NamesAreQuotedWhereAShellNeedsIt) {
  EXPECT_EQ(quoted("scans/tablet.exa"), "scans/tablet.exa");
  EXPECT_EQ(quoted("AO 8295.exa"), "'AO 8295.exa'");
  EXPECT_EQ(quoted("it's.exa"), "'it'\\''s.exa'");
}

}  // namespace
}  // namespace dubsar::app
