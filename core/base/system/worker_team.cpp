#include "core/base/system/worker_team.h"

#include <pthread.h>
#include <signal.h>

#include <thread>

namespace dubsar {
namespace {

/// Of a look at what another thread may change soon, before sleeping: some ten microseconds, about what waking takes.
constexpr int kLooks = 400;

thread_local bool t_at_work = false;

void pause() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Returns the first value that is not `old`.
template <class T>
T wait_while(std::atomic<T>& value, T old) noexcept {
  for (int look = 0; look < kLooks; ++look) {
    if (const T now = value.load(std::memory_order_acquire); now != old) return now;
    pause();
  }
  for (;;) {
    value.wait(old, std::memory_order_acquire);
    if (const T now = value.load(std::memory_order_acquire); now != old) return now;
  }
}

/// Signals are for the threads that the program has of its own.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    ::sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  ::sigset_t before_{};
};

}  // namespace

WorkerTeam& WorkerTeam::instance() {
  static WorkerTeam* const team = new WorkerTeam();
  return *team;
}

void WorkerTeam::grow(std::size_t workers) {
  const SignalsBlocked blocked;
  while (workers_.size() < workers) {
    workers_.push_back(std::make_unique<Worker>());
    Worker& worker = *workers_.back();
    std::thread([this, &worker] { serve(worker); }).detach();
  }
}

void WorkerTeam::serve(Worker& worker) {
  t_at_work = true;
  for (;;) {
    wait_while<const std::function<void()>*>(worker.offer, nullptr);
    const std::function<void()>* const work = worker.offer.exchange(nullptr, std::memory_order_acq_rel);
    if (work == nullptr) continue;  // it was taken back
    (*work)();
    if (at_work_.fetch_sub(1, std::memory_order_acq_rel) == 1) at_work_.notify_one();
  }
}

void WorkerTeam::run(int threads, const std::function<void()>& work) {
  std::unique_lock<std::mutex> lock(busy_, std::defer_lock);
  if (threads <= 1 || t_at_work || !lock.try_lock()) {
    work();
    return;
  }
  const auto helpers = static_cast<std::size_t>(threads - 1);
  grow(helpers);
  at_work_.store(static_cast<int>(helpers), std::memory_order_relaxed);
  for (std::size_t i = 0; i < helpers; ++i) {
    workers_[i]->offer.store(&work, std::memory_order_release);
    workers_[i]->offer.notify_one();
  }
  t_at_work = true;
  work();
  t_at_work = false;
  for (std::size_t i = 0; i < helpers; ++i)
    if (workers_[i]->offer.exchange(nullptr, std::memory_order_acq_rel) != nullptr)
      at_work_.fetch_sub(1, std::memory_order_acq_rel);
  for (int left = at_work_.load(std::memory_order_acquire); left != 0;) left = wait_while(at_work_, left);
}

}  // namespace dubsar
