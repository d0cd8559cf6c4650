#include "devices/leap/stereo_camera.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "devices/leap/uvc_payload.h"

namespace dubsar {
namespace {

constexpr milliseconds kReadTimeout{50};    // of one read
constexpr milliseconds kLongestDrain{4};    // after a picture, for newer ones
constexpr int kMaxFailures = 100;           // transfers in a row
constexpr int kMaxTransfersPerPoll = 4096;  // about 200 frames

class Camera final : public StereoCamera {
 public:
  Camera(OpenTransport open, FindCameraKind find, const Clock& clock)
      : open_(std::move(open)), find_(std::move(find)), clock_(clock), transfer_(kStereoTransferBytes) {}
  ~Camera() override { Camera::stop(); }

  Result<void> start() override {
    stop();
    DUBSAR_ASSIGN(std::unique_ptr<Transport> transport, open_());
    DUBSAR_ASSIGN(kind_, find_(*transport));
    DUBSAR_ASSIGN(const StereoCameraKind::Stream stream, kind_->prepare(*transport));
    stream_.emplace(std::move(transport), stream);
    size_ = stream;
    state_ = FrameSourceState::kRunning;
    reason_.clear();
    return {};
  }

  void stop() noexcept override {
    if (stream_ && state_ == FrameSourceState::kRunning) kind_->lights_out(*stream_->transport);
    stream_.reset();
    state_ = FrameSourceState::kStopped;
    fresh_ = false;
  }

  bool poll(Frame& newest) override {
    drain(std::nullopt);
    return take(newest);
  }
  bool wait(Frame& newest, milliseconds timeout) override {
    const auto until = SteadyTime::clock::now() + timeout;
    for (;;) {
      drain(timeout > milliseconds(0) ? std::optional(kLongestDrain) : std::nullopt);
      if (take(newest)) return true;
      const auto left = std::chrono::duration_cast<milliseconds>(until - SteadyTime::clock::now());
      if (left <= milliseconds(0) || state_ != FrameSourceState::kRunning) return false;
      read_once(std::min(left, kReadTimeout));
    }
  }
  FrameSourceState state() const override { return state_; }
  std::string reason() const override { return reason_; }
  std::optional<lmc1::Calibration> calibration() const override { return kind_ ? kind_->calibration() : std::nullopt; }
  int width() const override { return size_.width; }
  int height() const override { return size_.height; }
  StreamCounters counters() const override {
    if (!stream_) return {};
    return {stream_->assembler.frames(), stream_->assembler.dropped_frames(), stream_->assembler.bad_transfers()};
  }

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// The device while it is open.
  struct Stream {
    Stream(std::unique_ptr<Transport> t, const StereoCameraKind::Stream& s)
        : transport(std::move(t)), assembler(s.frame_bytes), splitter(s.payload_bytes, kStereoTransferBytes) {}
    std::unique_ptr<Transport> transport;
    UvcAssembler assembler;
    UvcPayloadSplitter splitter;
    std::uint64_t sequence = 0;
    int failures = 0;
  };

  /// Reads what has come. With `longest`, for so long at most once there is a picture: a device that is slower than its
  /// pace always has something to say.
  void drain(std::optional<milliseconds> longest) {
    std::optional<SteadyTime> until;
    for (int i = 0; i < kMaxTransfersPerPoll && read_once(milliseconds(0)); ++i) {
      if (!longest || !fresh_) continue;
      const SteadyTime now = SteadyTime::clock::now();
      if (!until) until = now + *longest;
      if (now >= *until) return;
    }
  }

  bool take(Frame& newest) {
    if (!fresh_) return false;
    std::swap(newest, newest_);
    fresh_ = false;
    return true;
  }

  /// One transfer. False: none has come, or the device is lost.
  bool read_once(milliseconds timeout) {
    if (!stream_ || state_ != FrameSourceState::kRunning) return false;
    const auto length = stream_->transport->read(transfer_, timeout);
    if (!length) {
      if (length.error().kind == ErrorKind::kUnavailable || ++stream_->failures >= kMaxFailures) {
        state_ = FrameSourceState::kLost;
        reason_ = length.error().message;
        return false;
      }
      return true;  // concerns this transfer only: the frame will come out short and be dropped
    }
    stream_->failures = 0;
    if (*length == 0) return false;
    stream_->splitter.add(std::span(transfer_).first(*length), [&](std::span<const std::byte> payload) {
      if (stream_->assembler.add(payload)) deliver(stream_->assembler.frame());
    });
    return true;
  }

  void deliver(std::span<const std::byte> bytes) {
    newest_.time = clock_.now();
    newest_.sequence = ++stream_->sequence;
    newest_.width = size_.width;
    newest_.height = size_.height;
    newest_.views = 2;
    newest_.format = PixelFormat::kGray8;
    newest_.pixels.resize(2 * newest_.view_bytes());
    kind_->unpack(bytes, newest_);
    fresh_ = true;
  }

  const OpenTransport open_;
  const FindCameraKind find_;
  const Clock& clock_;
  std::unique_ptr<StereoCameraKind> kind_;
  StereoCameraKind::Stream size_;  // as of the last start
  std::optional<Stream> stream_;
  std::vector<std::byte> transfer_;
  Frame newest_;
  bool fresh_ = false;
  FrameSourceState state_ = FrameSourceState::kStopped;
  std::string reason_;
};

}  // namespace

std::unique_ptr<StereoCamera> make_stereo_camera(OpenTransport open, FindCameraKind find, const Clock& clock) {
  return std::make_unique<Camera>(std::move(open), std::move(find), clock);
}

}  // namespace dubsar
