#include "input/sources/threaded_source.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "input/event_limit.h"

namespace dubsar {
namespace {

constexpr milliseconds kReadTimeout{20};  // how long the destructor may have to wait
constexpr milliseconds kIdle{2};          // between looks at a bell while the device is lost

/// What a reader has to say besides its measurements.
struct ReaderState {
  bool connected = false, finished = false;
  std::string reason, note;
};

/// What was read last, on its way from the reader's thread to the session. Any thread.
class ReadInput {
 public:
  /// One turn of the reader; `measured` is null when it brought nothing.
  void put(ReaderState state, const InputFrame* measured) {
    const std::lock_guard lock(mutex_);
    state.finished = state.finished || state_.finished;
    if (state.connected) state.reason = std::move(state_.reason);
    state_ = std::move(state);
    if (measured == nullptr) return;
    fresh_ = measured_ = true;
    frame_.time = measured->time;
    frame_.space_mouse = measured->space_mouse;
    frame_.hands = measured->hands;
    frame_.heads = measured->heads;
    for (const TouchFrame& touch : measured->touches) add_touch_frame(frame_.touches, touch, kMostTouchFrames);
    const std::size_t room = kMostEvents - std::min(kMostEvents, frame_.events.size());
    const auto count = static_cast<std::ptrdiff_t>(std::min(room, measured->events.size()));
    frame_.events.insert(frame_.events.end(), measured->events.begin(), measured->events.begin() + count);
  }

  /// Nothing more will come.
  void fail(std::string reason) {
    const std::lock_guard lock(mutex_);
    state_.connected = fresh_ = false;
    state_.reason = std::move(reason);
  }

  /// InputSource::poll().
  Freshness take(TimestampNs now, const ThreadedSourceTraits& traits, InputFrame& newest) {
    newest.events.clear();
    newest.touches.clear();
    const std::lock_guard lock(mutex_);
    const bool fresh = std::exchange(fresh_, false);
    if (fresh) {
      newest.time = frame_.time;
      newest.space_mouse = frame_.space_mouse;
      newest.hands = frame_.hands;
      newest.heads = frame_.heads;
      newest.events.swap(frame_.events);
      newest.touches.swap(frame_.touches);
    }
    if (now - frame_.time > traits.stale_ns) {
      newest.hands.clear();
      newest.heads.clear();
    }
    silent_ = traits.silent_ns > 0 && (!measured_ || now - frame_.time > traits.silent_ns);
    if (!state_.connected) newest.space_mouse.reset();
    if (fresh && !silent_) return Freshness::kNew;
    return state_.connected && !silent_ ? Freshness::kUnchanged : Freshness::kLost;
  }

  bool finished() const {
    const std::lock_guard lock(mutex_);
    return state_.finished;
  }

  std::string words(const ThreadedSourceTraits& traits) const {
    const std::lock_guard lock(mutex_);
    if (!state_.connected) return state_.reason.empty() ? traits.name + ": not opened yet" : state_.reason;
    if (silent_) return state_.note.empty() ? traits.name + ": open, but it says nothing" : state_.note;
    return state_.note.empty() ? traits.note : state_.note;
  }

 private:
  mutable std::mutex mutex_;
  InputFrame frame_;  // events and touches: since the last take
  ReaderState state_;
  bool fresh_ = false, measured_ = false, silent_ = false;
};

/// The reader with what wakes and stops it. Of the thread that reads.
class ReaderTurns {
 public:
  ReaderTurns(std::unique_ptr<SourceReader> reader, const InputConfig& config, TimestampNs retry_ns)
      : reader_(std::move(reader)),
        hotplug_(config.hotplug),
        rings_(hotplug_ ? hotplug_->count() : 0),
        retry_ns_(retry_ns) {}

  /// From any thread: before the next turn.
  void recentre() noexcept { recentre_ = true; }

  enum class Turn { kMeasured, kNothing, kLost, kBroken };  ///< kLost: nothing, and there is no device
  /// An exception is a mistake of ours: it costs this source, not the session; no later turn reads anything.
  Turn take(TimestampNs now, milliseconds timeout, const std::string& name, ReadInput& read) noexcept {
    if (broken_) return Turn::kBroken;
    std::string what = "unknown";
    try {
      return take_turn(now, timeout, read);
    } catch (const std::exception& mistake) {
      what = mistake.what();
    } catch (...) {
    }
    broken_ = true;
    read.fail(name + ": reading has stopped by a mistake of this program: " + what);
    return Turn::kBroken;
  }

 private:
  Turn take_turn(TimestampNs now, milliseconds timeout, ReadInput& read) {
    if (hotplug_)
      if (const std::uint64_t rings = hotplug_->count(); rings != rings_) {
        rings_ = rings;
        reader_->wake();
      }
    if (retry_ns_ > 0 && !reader_->connected() && now >= next_retry_) {
      next_retry_ = now + retry_ns_;
      reader_->wake();
    }
    if (recentre_.exchange(false)) reader_->recentre();
    frame_.events.clear();
    frame_.touches.clear();
    const bool any = reader_->read(now, timeout, frame_);
    const bool connected = reader_->connected();
    read.put({connected, reader_->finished(), connected ? "" : reader_->reason(), reader_->note()},
             any ? &frame_ : nullptr);
    return any ? Turn::kMeasured : connected ? Turn::kNothing : Turn::kLost;
  }

  std::unique_ptr<SourceReader> reader_;
  const std::shared_ptr<HotplugBell> hotplug_;
  std::uint64_t rings_;
  const TimestampNs retry_ns_;
  TimestampNs next_retry_ = 0;
  InputFrame frame_;
  bool broken_ = false;
  std::atomic<bool> recentre_{false};
};

class ThreadedSource final : public InputSource {
 public:
  ThreadedSource(ThreadedSourceTraits traits, std::unique_ptr<SourceReader> reader, const InputConfig& config)
      : traits_(std::move(traits)),
        clock_(session_clock(config)),
        threaded_(!config.simulated_time),
        turns_(std::move(reader), config, traits_.retry_ns) {}

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
    if (!threaded_) turns_.take(now, milliseconds(0), traits_.name, read_);
    return read_.take(now, traits_, newest);
  }

  bool has_end() const noexcept override { return traits_.has_end; }
  bool finished() const noexcept override { return read_.finished(); }
  void recentre() noexcept override { turns_.recentre(); }
  std::string note() const override { return read_.words(traits_); }

 private:
  void read_loop() {
    for (;;) {
      const ReaderTurns::Turn turn = turns_.take(clock_.now(), kReadTimeout, traits_.name, read_);
      if (turn == ReaderTurns::Turn::kBroken) return;
      std::unique_lock lock(mutex_);
      if (turn == ReaderTurns::Turn::kLost) stop_.wait_for(lock, kIdle, [this] { return stopping_; });
      if (stopping_) return;
    }
  }

  const ThreadedSourceTraits traits_;
  const Clock& clock_;
  const bool threaded_;
  ReaderTurns turns_;  // the thread's while there is one
  ReadInput read_;
  std::mutex mutex_;  // for stopping_
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace

const Clock& session_clock(const InputConfig& config) {
  static const SteadyClock steady;
  return config.clock ? *config.clock : steady;
}

std::unique_ptr<InputSource> make_threaded_source(ThreadedSourceTraits traits, std::unique_ptr<SourceReader> reader,
                                                  const InputConfig& config) {
  return std::make_unique<ThreadedSource>(std::move(traits), std::move(reader), config);
}

}  // namespace dubsar
