#include "core/base/system/parallel.h"

#include <omp.h>

#include <atomic>
#include <exception>

#include "core/base/system/worker_team.h"

namespace dubsar {
namespace {
int g_threads = 0;  // 0: all cores
}

void set_thread_count(int threads) { g_threads = std::max(threads, 0); }

int thread_count() noexcept { return g_threads > 0 ? g_threads : omp_get_num_procs(); }

void parallel_chunks(std::int64_t count, std::int64_t grain,
                     const std::function<void(std::int64_t, std::int64_t)>& body) {
  const std::int64_t step = std::max<std::int64_t>(grain, 1);
  const std::int64_t chunks = (count + step - 1) / step;
  std::exception_ptr first_error;
  std::atomic<bool> failed{false};
  std::atomic<std::int64_t> next{0};
  const auto work = [&]() noexcept {
    for (;;) {
      const std::int64_t chunk = next.fetch_add(1, std::memory_order_relaxed);
      if (chunk >= chunks || failed.load(std::memory_order_relaxed)) return;
      try {
        body(chunk * step, std::min(count, (chunk + 1) * step));
      } catch (...) {
        if (!failed.exchange(true)) first_error = std::current_exception();
      }
    }
  };
  WorkerTeam::instance().run(static_cast<int>(std::min<std::int64_t>(thread_count(), chunks)), work);
  if (first_error) std::rethrow_exception(first_error);
}

std::int64_t exclusive_scan(std::span<std::int64_t> counts) {
  std::int64_t sum = 0;
  for (std::int64_t& count : counts) {
    const std::int64_t here = count;
    count = sum;
    sum += here;
  }
  return sum;
}

}  // namespace dubsar
