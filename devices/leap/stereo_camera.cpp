#include "devices/leap/stereo_camera.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "devices/leap/uvc_payload.h"

namespace dubsar {
namespace {

constexpr milliseconds kReadTimeout{50};    // how long stop() may have to wait
constexpr milliseconds kLongestDrain{4};    // after a picture, for newer ones
constexpr int kMaxFailures = 100;           // transfers in a row
constexpr int kMaxTransfersPerPoll = 4096;  // without a thread; about 200 frames

class Camera final : public StereoCamera {
 public:
  Camera(OpenTransport open, std::unique_ptr<StereoCameraKind> kind, bool own_thread, const Clock& clock)
      : open_(std::move(open)), kind_(std::move(kind)), own_thread_(own_thread), clock_(clock) {}
  ~Camera() override { Camera::stop(); }

  Result<void> start() override {
    stop();
    DUBSAR_ASSIGN(transport_, open_());
    auto prepared = kind_->prepare(*transport_);
    if (!prepared) {
      transport_.reset();
      return tl::unexpected<Error>(std::move(prepared).error());
    }
    stream_ = *prepared;
    assembler_.emplace(stream_.frame_bytes);
    splitter_.emplace(stream_.payload_bytes, kStereoTransferBytes);
    transfer_.resize(kStereoTransferBytes);
    sequence_ = 0;
    failures_ = 0;
    idle_ = false;
    {
      const std::lock_guard lock(mutex_);
      state_ = FrameSourceState::kRunning;
      reason_.clear();
      fresh_ = false;
      counters_ = {};
    }
    stopping_ = false;
    if (own_thread_) thread_ = std::thread([this] { read_loop(); });
    return {};
  }

  void stop() noexcept override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    if (transport_ && state() == FrameSourceState::kRunning) kind_->lights_out(*transport_);
    transport_.reset();
    const std::lock_guard lock(mutex_);
    state_ = FrameSourceState::kStopped;
    fresh_ = false;
    pending_.clear();
  }

  bool poll(Frame& newest) override {
    if (!own_thread_) drain(std::nullopt);
    return take(newest);
  }
  bool wait(Frame& newest, milliseconds timeout) override {
    if (own_thread_) {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, timeout, [this] { return fresh_ || state_ != FrameSourceState::kRunning; });
      lock.unlock();
      return take(newest);
    }
    const auto until = SteadyTime::clock::now() + timeout;
    for (;;) {
      drain(timeout > milliseconds(0) ? std::optional(kLongestDrain) : std::nullopt);
      if (take(newest)) return true;
      const auto left = std::chrono::duration_cast<milliseconds>(until - SteadyTime::clock::now());
      if (left <= milliseconds(0) || state() != FrameSourceState::kRunning) return false;
      read_once(std::min(left, kReadTimeout));
    }
  }
  FrameSourceState state() const override {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  std::string reason() const override {
    const std::lock_guard lock(mutex_);
    return reason_;
  }
  std::optional<lmc1::Calibration> calibration() const override { return kind_->calibration(); }
  int width() const override { return stream_.width; }
  int height() const override { return stream_.height; }
  StreamCounters counters() const override {
    const std::lock_guard lock(mutex_);
    return counters_;
  }
  Result<void> set_exposure(int us) override {
    DUBSAR_TRY(must_run());
    return queue(kind_->exposure(us));
  }
  Result<void> set_dark_frame_interval(int n) override {
    DUBSAR_TRY(must_run());
    return queue(kind_->dark_frame_interval(n));
  }

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// Reads what has come. With `longest`, for so long at most once there is a picture: a device that is slower than its
  /// pace always has something to say.
  void drain(std::optional<milliseconds> longest) {
    if (state() != FrameSourceState::kRunning) return;
    idle_ = false;
    std::optional<SteadyTime> until;
    for (int i = 0; i < kMaxTransfersPerPoll && !idle_ && read_once(milliseconds(0)); ++i) {
      if (!longest || !has_fresh()) continue;
      const SteadyTime now = SteadyTime::clock::now();
      if (!until) until = now + *longest;
      if (now >= *until) return;
    }
  }
  bool has_fresh() const {
    const std::lock_guard lock(mutex_);
    return fresh_;
  }
  bool take(Frame& newest) {
    const std::lock_guard lock(mutex_);
    if (!fresh_) return false;
    std::swap(newest, newest_);
    fresh_ = false;
    return true;
  }

  Result<void> must_run() const {
    if (state() == FrameSourceState::kRunning) return {};
    return fail(ErrorKind::kUsage, "leap: settings can be changed only while the source is running");
  }
  Result<void> queue(Result<uvc::ControlWrite> write) {
    if (!write) return tl::unexpected<Error>(std::move(write).error());
    const std::lock_guard lock(mutex_);
    pending_.push_back(*write);
    return {};
  }

  /// An exception is a mistake of ours: it costs the device, not the session.
  void read_loop() noexcept {
    try {
      while (!stopping_ && read_once(kReadTimeout)) {
      }
    } catch (const std::exception& mistake) {
      lose(fmt::format("leap: reading has stopped by a mistake of this program: {}", mistake.what()));
    }
  }

  /// One transfer. False: the device is lost.
  bool read_once(milliseconds timeout) {
    {
      const std::lock_guard lock(mutex_);
      writes_.swap(pending_);
    }
    for (const auto& write : writes_)
      if (auto sent = uvc::send(*transport_, write); !sent && sent.error().kind == ErrorKind::kUnavailable)
        return lose(sent.error().message);
    writes_.clear();

    const auto length = transport_->read(transfer_, timeout);
    if (!length) {
      if (length.error().kind == ErrorKind::kUnavailable || ++failures_ >= kMaxFailures)
        return lose(length.error().message);
      return true;  // concerns this transfer only: the frame will come out short and be dropped
    }
    failures_ = 0;
    idle_ = *length == 0;
    if (idle_) return true;
    splitter_->add(std::span(transfer_).first(*length), [&](std::span<const std::byte> payload) {
      if (assembler_->add(payload)) deliver(assembler_->frame());
    });
    const std::lock_guard lock(mutex_);
    counters_ = {assembler_->frames(), assembler_->dropped_frames(), assembler_->bad_transfers()};
    return true;
  }

  void deliver(std::span<const std::byte> bytes) {
    working_.time = clock_.now();
    working_.sequence = ++sequence_;
    working_.width = stream_.width;
    working_.height = stream_.height;
    working_.views = 2;
    working_.format = PixelFormat::kGray8;
    working_.pixels.resize(2 * working_.view_bytes());
    kind_->unpack(bytes, working_);
    const std::lock_guard lock(mutex_);
    std::swap(working_, newest_);
    fresh_ = true;
    changed_.notify_all();
  }

  bool lose(const std::string& why) {
    const std::lock_guard lock(mutex_);
    state_ = FrameSourceState::kLost;
    reason_ = why;
    changed_.notify_all();
    return false;
  }

  const OpenTransport open_;
  const std::unique_ptr<StereoCameraKind> kind_;
  const bool own_thread_;
  const Clock& clock_;

  // The reader thread's while it runs.
  std::unique_ptr<Transport> transport_;
  StereoCameraKind::Stream stream_;
  std::optional<UvcAssembler> assembler_;
  std::optional<UvcPayloadSplitter> splitter_;
  std::vector<std::byte> transfer_;
  std::vector<uvc::ControlWrite> writes_;
  Frame working_;
  std::uint64_t sequence_ = 0;
  int failures_ = 0;
  bool idle_ = false;  // the last read found nothing

  std::thread thread_;
  std::atomic<bool> stopping_{false};

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  FrameSourceState state_ = FrameSourceState::kStopped;
  std::string reason_;
  Frame newest_;
  bool fresh_ = false;
  StreamCounters counters_;
  std::vector<uvc::ControlWrite> pending_;
};

}  // namespace

std::unique_ptr<StereoCamera> make_stereo_camera(OpenTransport open, std::unique_ptr<StereoCameraKind> kind,
                                                 bool own_thread, const Clock& clock) {
  return std::make_unique<Camera>(std::move(open), std::move(kind), own_thread, clock);
}

}  // namespace dubsar
