// Lines of text from where wedges lie.

#include "core/script/line_cuts.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

/// Lines of bodies at random heights within each, written `climb` upwards for each mm along.
struct Written {
  std::vector<TextBody> bodies;
  std::vector<int> lines;
};
Written written(int lines, double pitch, double climb, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Written out;
  for (int line = 1; line <= lines; ++line)
    for (int k = 0; k < 18; ++k) {
      const double along = 60.0 * share(random), base = -line * pitch + climb * along;
      const double low = 0.12 + 0.35 * share(random), high = low + 0.1 + (0.78 - low) * share(random);
      out.bodies.push_back({along, base + low * pitch, base + std::min(0.9, high) * pitch});
      out.lines.push_back(line);
    }
  return out;
}

TEST(LineCuts, LinesAreCountedFromAbove) {
  for (const double climb : {0.0, 0.03, -0.05})
    for (int lines = 2; lines <= 9; ++lines) {
      const Written text = written(lines, 5.0, climb, static_cast<unsigned>(lines));
      const std::vector<int> found = lines_of(text.bodies, 1.8);
      int right = 0;
      for (std::size_t k = 0; k < found.size(); ++k) right += found[k] == text.lines[k];
      EXPECT_GE(right, 0.97 * static_cast<double>(found.size())) << lines << " lines that climb " << climb;
    }
}

TEST(LineCuts, OneWedgeIsOneLine) {
  EXPECT_EQ(lines_of({{0.0, 0.0, 1.0}}, 1.0), std::vector<int>{1});
  EXPECT_TRUE(lines_of({}, 1.0).empty());
}

}  // namespace
}  // namespace dubsar
