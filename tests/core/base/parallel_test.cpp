#include "core/base/system/parallel.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "core/base/system/clock.h"

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

TEST(Parallel, ALoopInsideALoopIsRunByItsThread) {
  set_thread_count(4);
  std::vector<std::atomic<int>> visits(64 * 64);
  parallel_for(64, 1, [&](std::int64_t i) {
    const auto outer = std::this_thread::get_id();
    parallel_for(64, 1, [&](std::int64_t k) {
      EXPECT_EQ(std::this_thread::get_id(), outer);
      ++visits[static_cast<std::size_t>(64 * i + k)];
    });
  });
  for (const auto& v : visits) EXPECT_EQ(v.load(), 1);
  set_thread_count(0);
}

TEST(Parallel, LoopsOfSeveralThreadsDoNotDisturbEachOther) {
  set_thread_count(3);
  std::vector<std::thread> callers;
  std::array<std::atomic<std::int64_t>, 4> sums{};
  for (std::size_t c = 0; c < sums.size(); ++c)
    callers.emplace_back([&sums, c] {
      for (int round = 0; round < 300; ++round) parallel_for(50, 1, [&](std::int64_t i) { sums[c] += i; });
    });
  for (std::thread& caller : callers) caller.join();
  for (const auto& sum : sums) EXPECT_EQ(sum.load(), 300 * 49 * 50 / 2);
  set_thread_count(0);
}

TEST(Parallel, ManyShortLoopsOneAfterAnother) {
  set_thread_count(7);
  std::int64_t sum = 0;
  for (std::int64_t round = 0; round < 20'000; ++round) {
    std::array<std::int64_t, 3> parts{};
    parallel_for(3, 1, [&](std::int64_t i) { parts[static_cast<std::size_t>(i)] = round + i; });
    sum += parts[0] + parts[1] + parts[2];
  }
  EXPECT_EQ(sum, 3 * (19'999LL * 20'000 / 2) + 3 * 20'000);
  set_thread_count(0);
}

TEST(Parallel, ThreadsThatWaitTakeNoTimeOfAProcessor) {
  set_thread_count(4);
  std::atomic<int> calls{0};
  double waited = 0.0;
  for (int round = 0; round < 20; ++round) {
    parallel_for(4, 1, [&](std::int64_t) { ++calls; });
    const double before = process_cpu_seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // as a thread does that waits for a disk
    waited += process_cpu_seconds() - before;
  }
  EXPECT_EQ(calls.load(), 80);
  EXPECT_LT(waited, 0.05) << "three threads that spin would take .3 s";
  set_thread_count(0);
}

TEST(Parallel, ExclusiveScanReturnsTheTotal) {
  std::vector<std::int64_t> counts{3, 0, 5, 1};
  EXPECT_EQ(exclusive_scan(counts), 9);
  EXPECT_EQ(counts, (std::vector<std::int64_t>{0, 3, 3, 8}));
}

}  // namespace
}  // namespace dubsar
