// How the page of help lies on a page.

#include "app/panels/help_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace dubsar::app {
namespace {

/// So many sections of so many rows.
std::vector<HelpSection> some_help(int sections, int rows) {
  std::vector<HelpSection> out;
  for (int s = 0; s < sections; ++s) {
    out.push_back({"section " + std::to_string(s), {}});
    for (int r = 0; r < rows; ++r) out.back().rows.push_back({"ctrl+shift+k", "does what it says, in some words"});
  }
  return out;
}

/// Lines of the tallest column, as long as no row is broken.
std::size_t tallest(const HelpColumns& columns, const std::vector<HelpSection>& help) {
  std::size_t most = 0;
  for (std::size_t c = 0; c < columns.starts.size(); ++c) {
    const std::size_t last = c + 1 < columns.starts.size() ? columns.starts[c + 1] : help.size();
    std::size_t lines = 0;
    for (std::size_t s = columns.starts[c]; s < last; ++s) lines += help[s].rows.size() + 2;
    most = std::max(most, lines);
  }
  return most;
}

TEST(HelpColumns, LettersAreAsLargeAsThePageAllows) {
  const auto help = some_help(8, 9);
  const HelpColumns small = arrange_help(help, 900, 500, 0.45f), large = arrange_help(help, 1800, 1000, 0.45f);
  EXPECT_TRUE(small.fits);
  EXPECT_TRUE(large.fits);
  EXPECT_GT(large.scale, 1.5f * small.scale);
  EXPECT_LE(17.0f * small.scale * static_cast<float>(tallest(small, help)), 500.0f);
}

TEST(HelpColumns, NoneAreSmallerThanAskedForAndWhatDoesNotFitGoesOnBelowThePage) {
  const auto help = some_help(12, 12);
  const HelpColumns columns = arrange_help(help, 720, 400, 1.0f);
  EXPECT_FALSE(columns.fits);
  EXPECT_FLOAT_EQ(columns.scale, 1.0f);
  EXPECT_GT(17.0f * static_cast<float>(tallest(columns, help)), 400.0f);
  EXPECT_LE(tallest(columns, help), (12UL * 14 + columns.starts.size() - 1) / columns.starts.size() + 14) << "even";
  EXPECT_TRUE(std::is_sorted(columns.starts.begin(), columns.starts.end()));
  const HelpColumns narrow = arrange_help(help, 60, 400, 1.0f);
  EXPECT_EQ(narrow.starts.size(), 1u);
}

TEST(HelpColumns, ScrollingEndsAtBothEnds) {
  HelpScroll scroll{.most = 100.0f};
  scroll.by(-5.0f);
  EXPECT_EQ(scroll.at, 0.0f);
  scroll.by(70.0f);
  scroll.by(70.0f);
  EXPECT_EQ(scroll.at, 100.0f);
}

}  // namespace
}  // namespace dubsar::app
