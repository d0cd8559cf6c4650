// Which grid is taken follows from the plan's time and memory: a function of the scan, the threads and the room.

#include "core/pipeline/detail.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

constexpr std::uint64_t kGib = 1024ull * 1024ull * 1024ull;

RunShape usual(const Dims& scan, int threads) {
  RunShape run;
  run.scan = scan;
  run.vertices = usual_vertices(scan);
  run.threads = threads;
  return run;
}

TEST(Detail, ThePapersScanKeepsItsResolutionOnTwoThreadsAndOnSixteen) {
  for (const int threads : {2, 16}) {
    const DetailChoice choice = choose_detail(Detail::kAuto, usual({1871, 999, 1723}, threads), 32 * kGib);
    EXPECT_EQ(choice.detail, Detail::kScan) << choice.why;
    EXPECT_NE(choice.why.find(std::to_string(threads) + " threads"), std::string::npos) << choice.why;
  }
}

TEST(Detail, TheScannersFullVolumeKeepsItOnSixteenThreadsOnly) {
  const Dims full{3072, 3072, 1944};
  const DetailChoice two = choose_detail(Detail::kAuto, usual(full, 2), 256 * kGib);
  EXPECT_EQ(two.detail, Detail::kHalf);
  EXPECT_NE(two.why.find("minutes"), std::string::npos) << two.why;
  EXPECT_EQ(choose_detail(Detail::kAuto, usual(full, 16), 256 * kGib).detail, Detail::kScan);
}

TEST(Detail, WhatDoesNotFitIsHalvedAndTheReasonNamesBothSizes) {
  const DetailChoice narrow = choose_detail(Detail::kAuto, usual({512, 272, 472}, 2), kGib / 4);
  EXPECT_EQ(narrow.detail, Detail::kHalf);
  EXPECT_NE(narrow.why.find("MiB of the 256 MiB of memory"), std::string::npos) << narrow.why;
  EXPECT_EQ(choose_detail(Detail::kAuto, usual({512, 272, 472}, 2), 8 * kGib).detail, Detail::kScan);
}

TEST(Detail, WhatIsAskedForIsDone) {
  EXPECT_EQ(choose_detail(Detail::kScan, usual({3072, 3072, 1944}, 1), kGib).detail, Detail::kScan);
  EXPECT_EQ(choose_detail(Detail::kHalf, usual({32, 32, 32}, 16), 512 * kGib).detail, Detail::kHalf);
}

TEST(Detail, OnlyLargeSurfacesOfTheScansResolutionShareRays) {
  EXPECT_EQ(sharers_of_rays(true, 20e6), 1);
  EXPECT_EQ(sharers_of_rays(false, 0.3e6), 1);
  EXPECT_GT(sharers_of_rays(false, 5e6), 1);
}

}  // namespace
}  // namespace dubsar
