#include "core/pipeline/detail.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

constexpr std::uint64_t kGib = 1024ull * 1024ull * 1024ull;

TEST(Detail, AutoTakesTheScansResolutionWhereTimeAndMemoryAllowAndSaysWhy) {
  const DetailChoice fits = choose_detail(Detail::kAuto, {512, 272, 472}, 8 * kGib);
  EXPECT_EQ(fits.detail, Detail::kScan);
  EXPECT_FALSE(fits.resample());
  EXPECT_EQ(fits.why, "66 million voxels fit in 8.0 GiB");
  const DetailChoice narrow = choose_detail(Detail::kAuto, {512, 272, 472}, kGib / 10 * 9);
  EXPECT_EQ(narrow.detail, Detail::kHalf);
  EXPECT_EQ(narrow.why,
            "the scan's resolution takes about 746 MiB, more than four fifths of the 922 MiB that are left");
  const DetailChoice long_run = choose_detail(Detail::kAuto, {1871, 999, 1723}, 512 * kGib);
  EXPECT_EQ(long_run.detail, Detail::kHalf);
  EXPECT_NE(long_run.why.find("3221 million voxels"), std::string::npos) << long_run.why;
  EXPECT_EQ(choose_detail(Detail::kAuto, {935, 499, 861}, 4 * kGib).detail, Detail::kScan);
  EXPECT_EQ(choose_detail(Detail::kAuto, {1250, 667, 1150}, 20 * kGib).detail, Detail::kScan);
}

TEST(Detail, WhatIsAskedForIsDone) {
  EXPECT_EQ(choose_detail(Detail::kScan, {1871, 999, 1723}, kGib).detail, Detail::kScan);
  EXPECT_EQ(choose_detail(Detail::kHalf, {32, 32, 32}, 512 * kGib).detail, Detail::kHalf);
}

TEST(Detail, OnlyLargeSurfacesOfTheScansResolutionShareRays) {
  EXPECT_EQ(sharers_of_rays(Detail::kHalf, 20'000'000), 1);
  EXPECT_EQ(sharers_of_rays(Detail::kScan, 300'000), 1);
  EXPECT_GT(sharers_of_rays(Detail::kScan, 5'000'000), 1);
}

}  // namespace
}  // namespace dubsar
