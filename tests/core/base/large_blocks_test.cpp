#include "core/base/system/large_blocks.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cstdlib>
#include <memory>
#include <vector>

#include "core/base/system/budget.h"

namespace dubsar {
namespace {

constexpr std::size_t kMiB = 1 << 20, kLarge = 3 * kMiB, kBlocks = 32;

/// How much of 96 MiB, freed while small blocks between them live on, stays with this process, after an even larger
/// block was freed.
std::size_t held_bytes() {
  std::make_unique<std::vector<char>>(8 * kMiB).reset();
  const std::size_t before = mallinfo2().fordblks;
  std::vector<std::vector<char>> large(kBlocks), small(kBlocks);
  for (std::size_t i = 0; i < kBlocks; ++i) {
    large[i].resize(kLarge);
    small[i].resize(64 + i);
  }
  large.clear();
  const std::size_t now = mallinfo2().fordblks;
  return now > before ? now - before : 0;
}

[[noreturn]] void exit_with(bool good) { std::exit(good ? 0 : 1); }

// Each in a new process: it cannot be taken back, and what other tests freed would be taken first.
TEST(LargeBlocks, GoBackToTheSystemWhenTheyAreFreed) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "the C library's memory is not used here";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(exit_with(held_bytes() > kBlocks * kLarge / 2), ::testing::ExitedWithCode(0), "")
      << "else nothing is shown";
  EXPECT_EXIT(
      {
        return_large_blocks();
        exit_with(held_bytes() < kMiB);
      },
      ::testing::ExitedWithCode(0), "");
}

/// Pages that the system had to give while blocks of just below 1 MiB were filled and freed again and again.
long pages_of_blocks() {
  const auto faults = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
  };
  const auto fill = [] {
    std::vector<char> block(kMiB / 16 * 15);
    volatile char* const bytes = block.data();
    for (std::size_t i = 0; i < block.size(); i += 4096) bytes[i] = 1;
  };
  fill();
  const long before = faults();
  for (std::size_t i = 0; i < kBlocks; ++i) fill();
  return faults() - before;
}

TEST(LargeBlocks, ThoseOfAPictureAreUsedAgainWithoutNewPages) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "the C library's memory is not used here";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        return_large_blocks();
        exit_with(pages_of_blocks() < 256);
      },
      ::testing::ExitedWithCode(0), "")
      << "of 7680 that were filled";
}

TEST(LargeBlocks, StayForTheNextOnesWhereThatIsWanted) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "the C library's memory is not used here";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        keep_large_blocks();
        const std::size_t before = mallinfo2().hblkhd;
        { std::vector<char> large(256 * kMiB); }
        const struct mallinfo2 now = mallinfo2();
        exit_with(now.hblkhd == before && now.fordblks >= 256 * kMiB);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(LargeBlocks, OfMoreThanTwoGibibytesStayTooAndCountAsLeft) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "the C library's memory is not used here";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        constexpr std::size_t kBytes = 2560 * kMiB;
        keep_large_blocks();
        const std::uint64_t before = available_memory_bytes();
        {
          const std::unique_ptr<char[]> large(new char[kBytes]);  // nobody writes it: the machine need not have it
          volatile char* const bytes = large.get();
          bytes[0] = 1;
        }
        exit_with(spare_heap_bytes() >= kBytes && available_memory_bytes() > before + kBytes / 2);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace dubsar
