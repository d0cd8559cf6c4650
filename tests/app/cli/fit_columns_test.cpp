// Text on a terminal that is narrower than it.

#include "app/cli/fit_columns.h"

#include <gtest/gtest.h>

namespace dubsar::app {
namespace {

TEST(FitColumns, WhatFitsStaysAsItIs) {
  const std::string table = "  name         bytes   share\n  a               12    0.5 %\n\nlast";
  EXPECT_EQ(fit_columns(table, 30), table);
  EXPECT_EQ(fit_columns("", 30), "");
  EXPECT_EQ(fit_columns("\n", 30), "\n");
}

TEST(FitColumns, FiguresGoOnBelowThemselves) {
  EXPECT_EQ(fit_columns("  voxel size   0.139566 x 0.139566 x 0.139566 mm (/entry/data axes z, y, x)\n", 60),
            "  voxel size   0.139566 x 0.139566 x 0.139566 mm\n"
            "               (/entry/data axes z, y, x)\n");
  EXPECT_EQ(fit_columns("a sentence that is too long", 12), "a sentence\n  that is\n  too long");
}

TEST(FitColumns, LettersOfSeveralBytesCountOnceAndLongWordsStayWhole) {
  EXPECT_EQ(fit_columns("\u0161\u0161\u0161\u0161 mm\u00b2", 8), "\u0161\u0161\u0161\u0161 mm\u00b2");
  EXPECT_EQ(fit_columns("see /a/very/long/path now", 10), "see\n  /a/very/long/path\n  now");
  EXPECT_EQ(fit_columns("/a/very/long/path", 5), "/a/very/long/path");
}

TEST(FitColumns, AnyWidthEndsAndLosesNoWord) {
  const std::string text = "  part 1       tablet: 10.0 mm2, 3.0 mm3, watertight   and   more words than fit";
  for (int columns = 0; columns < 90; ++columns) {
    std::string found, expected;
    for (const char c : fit_columns(text, columns))
      if (c != ' ' && c != '\n') found += c;
    for (const char c : text)
      if (c != ' ') expected += c;
    EXPECT_EQ(found, expected) << columns;
  }
}

}  // namespace
}  // namespace dubsar::app
