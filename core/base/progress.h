#pragma once
// Progress of long work, and the way to stop it.

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// One state of a stage, as the observer sees it.
struct ProgressState {
  std::string stage;       ///< e.g. "denoise"
  std::int64_t done = 0;   ///< work units done, 0..total
  std::int64_t total = 0;  ///< work units; 0: unknown
  std::string unit;        ///< e.g. "voxel", "ray"
};

/// Passed down to everything that takes longer than a blink. advance() and cancelled() may be called from any
/// thread and cost nothing much; call them once a slice or some thousand items. A worker that sees cancelled()
/// returns cancelled_error() soon (the program promises less than 2 s).
class Progress {
 public:
  virtual ~Progress() = default;

  void begin(std::string_view stage, std::int64_t total, std::string_view unit) {
    done_.store(0, std::memory_order_relaxed);
    on_begin(stage, total, unit);
  }
  void advance(std::int64_t units) { on_advance(done_.fetch_add(units, std::memory_order_relaxed) + units); }
  void end() { on_end(); }

  /// Safe in a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 protected:
  virtual void on_begin(std::string_view /*stage*/, std::int64_t /*total*/, std::string_view /*unit*/) {}
  virtual void on_advance(std::int64_t /*done*/) {}  ///< any thread
  virtual void on_end() {}

 private:
  std::atomic<std::int64_t> done_{0};
  std::atomic<bool> cancelled_{false};
};

/// For callers that do not care.
class SilentProgress final : public Progress {};

tl::unexpected<Error> cancelled_error();

/// Remaining seconds of a stage from its progress so far; negative while it is too early to say (less than 5 % done
/// and less than 3 s elapsed).
double estimate_remaining_s(std::int64_t done, std::int64_t total, double elapsed_s) noexcept;

}  // namespace dubsar
