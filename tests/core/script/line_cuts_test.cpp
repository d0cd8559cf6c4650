// Lines of text from where wedges lie.

#include "core/script/line_cuts.h"

#include <gtest/gtest.h>

#include <random>

namespace dubsar {
namespace {

/// Lines of bodies at random heights within each, written `climb` upwards for each mm along, `sag` mm lower in the
/// middle of 60 mm than at their ends.
struct Written {
  std::vector<TextBody> bodies;
  std::vector<int> lines;
};
Written written(int lines, double pitch, double climb, double sag, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Written out;
  for (int line = 1; line <= lines; ++line)
    for (int k = 0; k < 18; ++k) {
      const double along = 60.0 * share(random), aside = (along - 30.0) / 30.0;
      const double base = -line * pitch + climb * along + sag * aside * aside;
      const double low = 0.12 + 0.35 * share(random), high = low + 0.1 + (0.78 - low) * share(random);
      out.bodies.push_back({along, base + low * pitch, base + std::min(0.9, high) * pitch});
      out.lines.push_back(line);
    }
  return out;
}

double share_right(const std::vector<int>& found, const std::vector<int>& wanted) {
  int right = 0;
  for (std::size_t k = 0; k < found.size(); ++k) right += found[k] == wanted[k];
  return static_cast<double>(right) / static_cast<double>(found.size());
}

TEST(LineCuts, LinesAreCountedFromAbove) {
  for (const double climb : {0.0, 0.03, -0.05})
    for (int lines = 2; lines <= 9; ++lines) {
      const Written text = written(lines, 5.0, climb, 0.0, static_cast<unsigned>(lines));
      EXPECT_GE(share_right(lines_of({text.bodies}, 1.8)[0], text.lines), 0.97)
          << lines << " lines that climb " << climb;
    }
}

TEST(LineCuts, LinesMayBend) {
  for (const double sag : {1.5, -1.5})
    for (int lines = 3; lines <= 8; ++lines) {
      const Written text = written(lines, 5.0, 0.02, sag, static_cast<unsigned>(10 + lines));
      EXPECT_GE(share_right(lines_of({text.bodies}, 1.8)[0], text.lines), 0.97) << lines << " lines that sag " << sag;
    }
}

/// An edge has too few wedges to tell its rows of wedges from lines: the broad sides know how high lines are.
TEST(LineCuts, AnEdgeHasLinesAsHighAsBroadSides) {
  const Written text = written(6, 5.0, 0.0, 0.0, 30);
  const std::vector<TextBody> edge{{3.0, 0.3, 1.3}, {3.2, 1.8, 2.8}, {3.1, 3.2, 4.2}, {9.0, 1.7, 2.9}};
  const std::vector<std::vector<int>> found = lines_of({text.bodies, edge, {}}, 1.8);
  EXPECT_GE(share_right(found[0], text.lines), 0.97);
  EXPECT_EQ(found[1], std::vector<int>(4, 1));
  EXPECT_TRUE(found[2].empty());
}

TEST(LineCuts, OneWedgeIsOneLine) {
  EXPECT_EQ(lines_of({{{0.0, 0.0, 1.0}}}, 1.0)[0], std::vector<int>{1});
  EXPECT_TRUE(lines_of({}, 1.0).empty());
}

}  // namespace
}  // namespace dubsar
