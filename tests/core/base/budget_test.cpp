#include "core/base/system/budget.h"

#include <gtest/gtest.h>

#include <array>

namespace dubsar {
namespace {

TEST(Budget, ProductOfTheFullScannerFits) {
  const std::array<std::uint64_t, 3> dims{3072, 3072, 1944};
  EXPECT_EQ(*check_dims("scan", dims, 4), 18345885696);
}

TEST(Budget, ZeroHugeAndOverflowingDimsAreRefused) {
  EXPECT_FALSE(check_dims("scan", std::array<std::uint64_t, 3>{0, 2, 2}, 4));
  EXPECT_FALSE(check_dims("scan", std::array<std::uint64_t, 3>{std::uint64_t{1} << 40, std::uint64_t{1} << 20, 4}, 4));
  EXPECT_FALSE(check_dims("scan", std::array<std::uint64_t, 3>{65535, 65535, 65535}, 4));
}

TEST(Budget, CountsBeyondTheFileAreRefusedWithoutOverflow) {
  EXPECT_TRUE(check_count("ply", 10, 12, 120));
  EXPECT_FALSE(check_count("ply", 11, 12, 120));
  EXPECT_FALSE(check_count("ply", ~std::uint64_t{0}, ~std::uint64_t{0}, 1000));
}

TEST(Budget, MemoryBeyondTheLimitIsTryAgain) {
  Budget budget;
  budget.memory_bytes = 1000;
  EXPECT_TRUE(check_memory("volume", 1000, budget));
  EXPECT_EQ(check_memory("volume", 1001, budget).error().kind, ErrorKind::kTryAgain);
  EXPECT_GT(available_memory_bytes(), 1u << 20);
}

TEST(Budget, TheMessageNamesNoFlagOfAnyProgram) {
  Budget budget;
  budget.memory_bytes = 1;
  EXPECT_EQ(check_memory("png", 3 << 20, budget).error().message.find("--"), std::string::npos);
}

TEST(Budget, TheLimitOfTheProcessCountsWhatItHasAlready) {
  const std::uint64_t unlimited = available_memory_bytes();
  constexpr std::uint64_t kGib = std::uint64_t{1} << 30;
  set_memory_limit(kGib);
  const std::uint64_t left = available_memory_bytes();
  set_memory_limit(1);
  const std::uint64_t nothing = available_memory_bytes();
  set_memory_limit(0);
  EXPECT_LT(left, kGib);  // the program itself is there
  EXPECT_GT(left, std::min(unlimited, kGib) / 2);
  EXPECT_EQ(nothing, 0U);
  EXPECT_GT(available_memory_bytes(), nothing);
}

}  // namespace
}  // namespace dubsar
