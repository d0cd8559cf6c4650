#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace dubsar {
namespace {

TEST(Parallel, EveryItemIsVisitedOnceForAnyThreadCount) {
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    std::vector<std::atomic<int>> visits(1003);
    parallel_for(1003, 10, [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
    for (const auto& v : visits) EXPECT_EQ(v.load(), 1);
  }
  set_thread_count(0);
}

TEST(Parallel, FloatSumHasTheSameBitsForAnyThreadCount) {
  const auto sum = [] {
    return parallel_reduce<float>(
        100000, 1000, 0.0f,
        [](std::int64_t begin, std::int64_t end) {
          float s = 0;
          for (std::int64_t i = begin; i < end; ++i) s += std::sin(static_cast<float>(i));
          return s;
        },
        [](float a, float b) { return a + b; });
  };
  set_thread_count(1);
  const float one = sum();
  set_thread_count(7);
  EXPECT_EQ(one, sum());
  set_thread_count(0);
}

TEST(Parallel, ExceptionsReachTheCaller) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::int64_t i) {
                              if (i == 42) throw std::runtime_error("42");
                            }),
               std::runtime_error);
}

TEST(Parallel, ExclusiveScanReturnsTheTotal) {
  std::vector<std::int64_t> counts{3, 0, 5, 1};
  EXPECT_EQ(exclusive_scan(counts), 9);
  EXPECT_EQ(counts, (std::vector<std::int64_t>{0, 3, 3, 8}));
}

}  // namespace
}  // namespace dubsar
