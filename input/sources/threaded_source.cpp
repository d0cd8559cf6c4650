#include "input/sources/threaded_source.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace dubsar {
namespace {

constexpr milliseconds kReadTimeout{20};  // how long the destructor may have to wait
constexpr milliseconds kIdle{2};          // between looks at a bell while the device is lost
constexpr std::size_t kMostEvents = 4096;

class ThreadedSource final : public InputSource {
 public:
  ThreadedSource(ThreadedSourceTraits traits, std::unique_ptr<SourceReader> reader, const InputConfig& config)
      : traits_(std::move(traits)),
        clock_(session_clock(config)),
        threaded_(!config.simulated_time),
        hotplug_(config.hotplug),
        reader_(std::move(reader)),
        rings_(hotplug_ ? hotplug_->count() : 0) {}

  ~ThreadedSource() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    stop_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  std::string_view name() const noexcept override { return traits_.name; }

  Result<void> start() override {
    if (threaded_ && !thread_.joinable()) thread_ = std::thread([this] { read_loop(); });
    return {};
  }

  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    if (traits_.before_poll) traits_.before_poll();
    if (!threaded_) read_guarded(now, milliseconds(0));
    newest.events.clear();
    const std::lock_guard lock(mutex_);
    const bool fresh = std::exchange(fresh_, false);
    if (fresh) {
      newest.time = frame_.time;
      newest.puck = frame_.puck;
      newest.hands = frame_.hands;
      newest.heads = frame_.heads;
      newest.events.swap(events_);
    }
    if (now - frame_.time > traits_.stale_ns) {
      newest.hands.clear();
      newest.heads.clear();
    }
    silent_ = traits_.silent_ns > 0 && (!measured_ || now - frame_.time > traits_.silent_ns);
    if (!connected_) newest.puck.reset();
    if (fresh && !silent_) return Freshness::kNew;
    return connected_ && !silent_ ? Freshness::kUnchanged : Freshness::kLost;
  }

  bool has_end() const noexcept override { return traits_.has_end; }
  bool finished() const noexcept override {
    const std::lock_guard lock(mutex_);
    return finished_;
  }
  void recentre() noexcept override { recentre_ = true; }
  std::string note() const override {
    const std::lock_guard lock(mutex_);
    if (!connected_) return reason_.empty() ? traits_.name + ": not opened yet" : reason_;
    if (silent_) return note_.empty() ? traits_.name + ": open, but it says nothing" : note_;
    return note_.empty() ? traits_.note : note_;
  }

 private:
  void read_loop() {
    while (read_guarded(clock_.now(), kReadTimeout)) {
    }
  }

  /// An exception is a mistake of ours: it costs this source, not the session. False: nothing more will be read.
  bool read_guarded(TimestampNs now, milliseconds timeout) noexcept {
    if (broken_) return false;
    std::string what = "unknown";
    try {
      return read_once(now, timeout);
    } catch (const std::exception& mistake) {
      what = mistake.what();
    } catch (...) {
    }
    broken_ = true;
    const std::lock_guard lock(mutex_);
    connected_ = fresh_ = false;
    reason_ = traits_.name + ": reading has stopped by a mistake of this program: " + what;
    return false;
  }

  /// False: the source is being destroyed.
  bool read_once(TimestampNs now, milliseconds timeout) {
    if (hotplug_)
      if (const std::uint64_t rings = hotplug_->count(); rings != rings_) {
        rings_ = rings;
        reader_->wake();
      }
    if (traits_.retry_ns > 0 && !reader_->connected() && now >= next_retry_) {
      next_retry_ = now + traits_.retry_ns;
      reader_->wake();
    }
    if (recentre_.exchange(false)) reader_->recentre();
    working_.events.clear();
    const bool any = reader_->read(now, timeout, working_);
    std::unique_lock lock(mutex_);
    connected_ = reader_->connected();
    finished_ = finished_ || reader_->finished();
    if (!connected_) reason_ = reader_->reason();
    if (std::string note = reader_->note(); note != note_) note_ = std::move(note);
    if (any) {
      fresh_ = measured_ = true;
      frame_.time = working_.time;
      frame_.puck = working_.puck;
      frame_.hands = working_.hands;
      frame_.heads = working_.heads;
      const std::size_t room = kMostEvents - std::min(kMostEvents, events_.size());
      const auto count = static_cast<std::ptrdiff_t>(std::min(room, working_.events.size()));
      events_.insert(events_.end(), working_.events.begin(), working_.events.begin() + count);
    }
    if (timeout.count() > 0 && !any && !connected_) stop_.wait_for(lock, kIdle, [this] { return stopping_; });
    return !stopping_;
  }

  const ThreadedSourceTraits traits_;
  const Clock& clock_;
  const bool threaded_;
  const std::shared_ptr<HotplugBell> hotplug_;

  // The reader thread's while there is one.
  std::unique_ptr<SourceReader> reader_;
  std::uint64_t rings_;
  TimestampNs next_retry_ = 0;
  bool broken_ = false;
  InputFrame working_;

  std::atomic<bool> recentre_{false};
  mutable std::mutex mutex_;
  std::condition_variable stop_;
  InputFrame frame_;                // guarded by mutex_, without events
  std::vector<InputEvent> events_;  // guarded by mutex_; since the last poll
  std::string reason_, note_;       // guarded by mutex_
  bool fresh_ = false, measured_ = false, connected_ = false, silent_ = false, finished_ = false,
       stopping_ = false;  // likewise
  std::thread thread_;
};

}  // namespace

const Clock& session_clock(const InputConfig& config) {
  static const SteadyClock kSteady;
  return config.clock ? *config.clock : kSteady;
}

std::unique_ptr<InputSource> make_threaded_source(ThreadedSourceTraits traits, std::unique_ptr<SourceReader> reader,
                                                  const InputConfig& config) {
  return std::make_unique<ThreadedSource>(std::move(traits), std::move(reader), config);
}

}  // namespace dubsar
