#include "app/session/background_job.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "core/base/system/clock.h"
#include "core/base/system/guarded.h"

namespace dubsar::app {
namespace {

double seconds_now() { return 1e-9 * static_cast<double>(SteadyClock().now()); }

}  // namespace

class BackgroundJob::Running final : public Progress {
 public:
  Running(std::string name, Work work, std::vector<PlannedStage> plan)
      : name_(std::move(name)), planned_(!plan.empty()), whole_(std::move(plan)) {
    thread_ = std::jthread([this, work = std::move(work)] {
      auto made = guarded(name_, [&] { return work(*this); });
      const std::scoped_lock lock(mutex_);
      made_ = std::move(made);
      changed_.notify_all();
    });
  }
  ~Running() override { cancel(); }

  bool done() const {
    const std::scoped_lock lock(mutex_);
    return made_.has_value();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return made_.has_value(); });
  }
  Result<void> take() {
    const std::scoped_lock lock(mutex_);
    return std::move(*made_);
  }
  JobState state() const {
    const std::scoped_lock lock(mutex_);
    return {name_, share_, planned_ ? whole_.remaining_s(seconds_now()) : std::nullopt};
  }

 protected:
  void on_begin(std::string_view stage, std::int64_t total, std::string_view) override {
    const std::scoped_lock lock(mutex_);
    total_ = total;
    if (!planned_) whole_ = OverallProgress({{std::string(stage), 1.0}});
    whole_.begin(stage, seconds_now());
  }
  void on_advance(std::int64_t done) override {
    const std::unique_lock lock(mutex_, std::try_to_lock);  // who works waits for nobody
    if (!lock || total_ <= 0) return;
    whole_.advance(static_cast<double>(done) / static_cast<double>(total_), seconds_now());
    share_ = std::max(share_, whole_.fraction());
  }
  void on_end() override {
    const std::scoped_lock lock(mutex_);
    whole_.end(seconds_now());
  }

 private:
  const std::string name_;
  const bool planned_;
  mutable std::mutex mutex_;  // for those below
  std::condition_variable changed_;
  std::int64_t total_ = 0;
  OverallProgress whole_;
  double share_ = 0.0;
  std::optional<Result<void>> made_;
  std::jthread thread_;  // goes first
};

BackgroundJob::BackgroundJob() = default;

BackgroundJob::~BackgroundJob() {
  stop();
  for (const auto& each : left_) each->cancel();
}

void BackgroundJob::begin(std::string name, Work work, std::vector<PlannedStage> plan) {
  stop();
  running_ = std::make_unique<Running>(std::move(name), std::move(work), std::move(plan));
}

bool BackgroundJob::stop() {
  std::erase_if(left_, [](const auto& each) { return each->done(); });
  if (!running_) return false;
  running_->cancel();
  left_.push_back(std::move(running_));
  return true;
}

std::optional<Result<void>> BackgroundJob::take() {
  if (!running_ || !running_->done()) return std::nullopt;
  const std::unique_ptr<Running> done = std::move(running_);
  return done->take();
}

void BackgroundJob::wait() {
  if (running_) running_->wait();
}

std::optional<JobState> BackgroundJob::state() const {
  return running_ ? std::optional(running_->state()) : std::nullopt;
}

}  // namespace dubsar::app
