#include "tests/app/kiosk/soak_figures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dubsar::app::test {
namespace {

std::vector<MemoryAt> growing(double mib_per_h, double at_first) {
  std::vector<MemoryAt> out;
  for (int i = 0; i < 200; ++i)
    out.push_back({0.05 * i, 90.0 + mib_per_h * 0.05 * i + 0.4 * std::sin(7.0 * i) + (i < 40 ? 0.0 : at_first)});
  return out;
}

TEST(SoakFigures, TheSlopeIsThatOfTheLineWhateverTheNoiseAndTheBeginning) {
  EXPECT_NEAR(slope_mib_per_h(growing(2.0, 0.0)), 2.0, 0.02);
  EXPECT_NEAR(settled_slope_mib_per_h(growing(2.0, 30.0)), 2.0, 0.03);
  EXPECT_GT(std::abs(slope_mib_per_h(growing(2.0, 30.0)) - 2.0), 1.0) << "else the first quarter is left out in vain";
  EXPECT_EQ(slope_mib_per_h({}), 0.0);
}

TEST(SoakFigures, EachLimitAloneBreaksIt) {
  SoakFigures good;
  good.memory = growing(0.1, 5.0);
  good.recovery_s["tracker"] = {0.1, 4.9};
  good.pictures = 1000;
  good.longest_ms = 249.0;
  EXPECT_TRUE(holds(good, true));
  SoakFigures bad = good;
  bad.memory = growing(1.2, 5.0);
  EXPECT_FALSE(holds(bad, true));
  bad = good;
  bad.recovery_s["suspend"] = {0.1, 5.1};
  EXPECT_FALSE(holds(bad, true));
  bad = good;
  bad.never_back = 1;
  EXPECT_FALSE(holds(bad, true));
  bad = good;
  bad.restarts = 1;
  EXPECT_FALSE(holds(bad, false));
  bad = good;
  bad.longest_ms = 251.0;
  EXPECT_FALSE(holds(bad, true));
  EXPECT_TRUE(holds(bad, false)) << "nothing was drawn";
  bad = good;
  for (int i = 0; i < 20; ++i) bad.hand_ms.add(i < 18 ? 30.0 : 101.0);
  EXPECT_FALSE(holds(bad, true));
  bad = good;
  bad.gl_errors = 1;
  EXPECT_FALSE(holds(bad, true));
  EXPECT_NE(describe(bad, true).find("does NOT hold"), std::string::npos);
}

TEST(SoakFigures, ThisProcessHasMemory) {
  const double before = resident_mib();
  std::vector<char> more(64 << 20, 'x');
  EXPECT_GT(resident_mib() - before, 50.0) << more.size();
}

}  // namespace
}  // namespace dubsar::app::test
