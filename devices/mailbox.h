#pragma once
// Where a reader thread leaves the newest thing it has read, and how it is doing.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>

namespace dubsar {

/// One thread puts and tells, others take and ask. Things are swapped, not copied, so that their memory goes round.
template <class Thing, class State>
class Mailbox {
 public:
  explicit Mailbox(State state) : state_(state) {}

  /// Replaces what nobody has taken; `newest` gets older memory back.
  void put(Thing& newest) {
    {
      const std::lock_guard lock(mutex_);
      std::swap(newest, newest_);
      fresh_ = true;
    }
    changed_.notify_all();
  }
  /// `keeps`: what is in the box may still be taken.
  void tell(State state, std::string reason = {}, bool keeps = true) {
    {
      const std::lock_guard lock(mutex_);
      state_ = state;
      reason_ = std::move(reason);
      fresh_ = fresh_ && keeps;
    }
    changed_.notify_all();
  }

  /// True: `newest` has not been taken before.
  bool take(Thing& newest) {
    const std::lock_guard lock(mutex_);
    return take_locked(newest);
  }
  /// take() that waits at most `timeout`, and no longer than the state is `running`.
  bool wait(Thing& newest, std::chrono::milliseconds timeout, State running) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return fresh_ || state_ != running; });
    return take_locked(newest);
  }
  State state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  std::string reason() const {
    const std::lock_guard lock(mutex_);
    return reason_;
  }

 private:
  bool take_locked(Thing& newest) {
    if (!std::exchange(fresh_, false)) return false;
    std::swap(newest, newest_);
    return true;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_;
  std::string reason_;
  Thing newest_{};
  bool fresh_ = false;
};

}  // namespace dubsar
