#pragma once
// One watch for all sources of a session: each of them hears that devices have come or gone.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "devices/transport/hotplug_watch.h"

namespace dubsar {

/// Counts changes of the device nodes. Any thread.
class HotplugBell {
 public:
  HotplugBell() = default;  ///< rings only by hand
  /// Watches this machine's device nodes; where that is not possible devices are found by their retry pauses.
  static std::shared_ptr<HotplugBell> of_this_machine();
  explicit HotplugBell(HotplugWatch watch) : watch_(std::move(watch)) {}

  /// Changes so far. Never blocks: while another thread looks, the last count holds.
  std::uint64_t count() noexcept {
    if (const std::unique_lock lock(mutex_, std::try_to_lock); lock && watch_ && watch_->changed()) ring();
    return count_;
  }
  void ring() noexcept { ++count_; }

 private:
  std::mutex mutex_;
  std::optional<HotplugWatch> watch_;  // guarded by mutex_
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace dubsar
