// Folders of slices as people and programs name them.

#include "core/volume/formats/slice_names.h"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace dubsar {
namespace {
using ::testing::HasSubstr;

using Names = std::vector<std::string>;

Result<SliceSeries> order(const Names& names) {
  std::vector<std::filesystem::path> files(names.begin(), names.end());
  std::shuffle(files.begin(), files.end(), std::mt19937(7));
  return order_slices(files, "scan");
}

void expect_order(const Names& wanted, const std::string& warning = "") {
  const auto series = order(wanted);
  ASSERT_TRUE(series) << series.error().message;
  Names found;
  for (const auto& file : series->files) found.push_back(file.string());
  EXPECT_EQ(found, wanted);
  const std::string said = fmt::format("{}", fmt::join(series->warnings, "; "));
  if (warning.empty())
    EXPECT_EQ(said, "");
  else
    EXPECT_THAT(said, HasSubstr(warning));
}

TEST(SliceNames, GoByTheirNumberWhateverItLooksLike) {
  expect_order({"s_8.tif", "s_9.tif", "s_10.tif", "s_11.tif"});
  expect_order({"0001.TIF", "0002.tif", "0003.tiff"});
  expect_order({"z_0.tif", "z_0.05.tif", "z_0.1.tif", "z_0.15.tif", "z_0.2.tif"});
  expect_order({"z_0,5.tif", "z_1,0.tif", "z_1,5.tif", "z_2,0.tif"});
  expect_order({"z_-0.2.tif", "z_-0.1.tif", "z_0.tif", "z_0.1.tif"});
  expect_order({"z-2.tif", "z-1.tif", "z0.tif", "z1.tif", "z2.tif"});
  expect_order({"scan-001.tif", "scan-002.tif", "scan-003.tif"});
  expect_order({"(-10).tif", "(-5).tif", "(0).tif"});
  expect_order({"-3.tif", "-2.tif", "-1.tif", "0.tif", "1.tif"});
  expect_order({"z_0.tif", "z_5e-05.tif", "z_0.0001.tif"});
  expect_order({"2024-05-01_a_8.tif", "2024-05-01_a_9.tif", "2024-05-01_a_10.tif"});
  expect_order({"part2.8.tif", "part2.9.tif", "part2.10.tif", "part2.11.tif"});
  expect_order({"t120000_i1.tif", "t120017_i2.tif", "t120034_i3.tif"});
  expect_order({"first.tif", "second.tif"});
}

TEST(SliceNames, SeveralSeriesAreRefusedByName) {
  for (const auto& [names, words] : std::vector<std::pair<Names, std::string>>{
           {{"a_0.tif", "a_1.tif", "mask_0.tif"}, "several series of names: a_*.tif (2 files) and mask_*.tif (1 file)"},
           {{"scanA_1.tif", "scanA_2.tif", "scanB_1.tif", "scanB_2.tif"}, "scanA_*.tif (2 files) and scanB_*.tif"},
           {{"preview.tif", "s1.tif", "s2.tif"}, "preview.tif (1 file) and s*.tif (2 files)"},
           {{"scan1_001.tif", "scan1_002.tif", "scan2_001.tif", "scan2_002.tif"},
            "more than one slice of a number, such as scan1_001.tif and scan2_001.tif"},
           {{"z1_ch1.tif", "z1_ch2.tif", "z2_ch1.tif", "z2_ch2.tif"}, "more than one slice of a number"},
           {{"1.tif", "01.tif", "2.tif"}, "more than one slice of a number"},
       }) {
    const auto series = order(names);
    ASSERT_FALSE(series) << fmt::format("{}", fmt::join(names, " "));
    EXPECT_EQ(series.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(series.error().message, HasSubstr(words));
    EXPECT_THAT(series.error().message, HasSubstr("pattern such as"));
  }
}

TEST(SliceNames, MissingNumbersAndUnevenStepsAreTold) {
  expect_order({"rec_0018.tif", "rec_0019.tif", "rec_0021.tif", "rec_0022.tif"}, "1 slice is missing");
  expect_order({"rec_0018.tif", "rec_0019.tif", "rec_0021.tif", "rec_0022.tif"}, "(rec_0020)");
  expect_order({"a1.tif", "a2.tif", "a3.tif", "a4.tif", "a9.tif"},
               "4 slices are missing among the names of the files (a5, a6, a7, ...)");
  expect_order({"a0.tif", "a2.tif", "a4.tif", "a8.tif"}, "(a6)");
  expect_order({"z_0.0.tif", "z_0.1.tif", "z_0.2.tif", "z_0.4.tif"}, "(0.3)");
  expect_order({"z_0.0.tif", "z_0.1.tif", "z_0.2.tif", "z_0.35.tif", "z_0.45.tif"}, "uneven steps (1 of 4");
}

}  // namespace
}  // namespace dubsar
