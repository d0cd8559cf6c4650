#include "core/edition/line_label.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(LineLabel, IsWhatEditionsWrite) {
  EXPECT_EQ(line_label({"tablet", "obverse", 0, "3"}), "o. 3");
  EXPECT_EQ(line_label({"tablet", "reverse", 2, "4'"}), "r. ii 4'");
  EXPECT_EQ(line_label({"tablet", "seal 1", 0, "1"}), "seal 1: 1");
}

TEST(LineLabel, ComesBackAndOtherHabitsAreRead) {
  for (const char* surface : {"obverse", "bottom", "reverse", "top", "left", "right", "edge b", "seal 1"})
    for (const int column : {0, 1, 4, 9})
      for (const char* number : {"1", "12'", "3a", "1-2"}) {
        const TextSpot spot{"tablet", surface, column, number};
        EXPECT_EQ(spot_of_label(line_label(spot)), spot) << line_label(spot);
      }
  EXPECT_EQ(spot_of_label("5")->surface, "obverse");
  EXPECT_EQ(spot_of_label("b.e. 1")->surface, "bottom");
  EXPECT_EQ(spot_of_label("l.e. 1")->surface, "left");
  EXPECT_EQ(spot_of_label("r.e. 1")->surface, "right");
  EXPECT_EQ(spot_of_label("r 1")->surface, "reverse");
  for (const char* none : {"", "o.", "here", "o. here", "o. xx y 3", "x. 1"}) EXPECT_FALSE(spot_of_label(none)) << none;
}

}  // namespace
}  // namespace dubsar
