#include "devices/leap/lmc1_driver.h"

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "devices/leap/uvc_payload.h"

namespace dubsar {
namespace {

constexpr milliseconds kControlTimeout{1000};
constexpr milliseconds kReadTimeout{50};  // how long stop() may have to wait
constexpr int kMaxFailures = 100;         // transfers in a row
constexpr int kMaxTransfersPerPoll = 4096;  // without a thread; about 200 frames

Result<void> send(Transport& transport, const lmc1::ControlWrite& write) {
  auto data = write.data;
  DUBSAR_TRY(transport.control(write.request, data, kControlTimeout));
  return {};
}

/// Probe, read back, compare, commit.
Result<void> commit_mode(Transport& transport, const lmc1::Mode& mode) {
  auto block = lmc1::encode(lmc1::request_mode(mode));
  DUBSAR_TRY(transport.control(lmc1::set_stream(lmc1::kProbeControl), block, kControlTimeout));
  DUBSAR_ASSIGN(const std::size_t length,
                transport.control(lmc1::get_stream(lmc1::kProbeControl), block, kControlTimeout));
  DUBSAR_ASSIGN(const lmc1::StreamBlock agreed, lmc1::decode_stream_block(std::span(block).first(length)));
  if (agreed.frame_index != mode.frame_index)
    return fail(ErrorKind::kBadData, "leap: the device offers video mode {}, expected {} ({}x{})", agreed.frame_index,
                mode.frame_index, mode.width, mode.height);
  DUBSAR_TRY(transport.control(lmc1::set_stream(lmc1::kCommitControl), block, kControlTimeout));
  return {};
}

class Driver final : public Lmc1Driver {
 public:
  Driver(OpenTransport open, const Lmc1Options& options, const Clock& clock)
      : open_(std::move(open)), options_(options), clock_(clock) {}
  ~Driver() override { Driver::stop(); }

  Result<void> start() override {
    stop();
    const lmc1::Mode* mode = lmc1::find_mode(options_.width, options_.height);
    if (mode == nullptr)
      return fail(ErrorKind::kUsage, "leap: no video mode of {}x{}, expected 640 or 752 x 480, 240 or 120", options_.width,
                  options_.height);
    DUBSAR_ASSIGN(transport_, open_());
    if (auto ready = prepare(*mode); !ready) {
      transport_.reset();
      return ready;
    }
    {
      const std::lock_guard lock(mutex_);
      state_ = FrameSourceState::kRunning;
      reason_.clear();
      fresh_ = false;
      counters_ = {};
    }
    stopping_ = false;
    mode_ = mode;
    assembler_.emplace(mode->frame_bytes());
    transfer_.resize(lmc1::kMaxTransferBytes);
    sequence_ = 0;
    failures_ = 0;
    if (!options_.own_thread) return {};
    thread_ = std::thread([this] {
      while (!stopping_ && read_once(kReadTimeout)) {
      }
    });
    return {};
  }

  void stop() noexcept override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    if (transport_ && state() == FrameSourceState::kRunning)
      for (const lmc1::Switch led : kLeds) (void)send(*transport_, lmc1::switch_on(led, false));
    transport_.reset();
    const std::lock_guard lock(mutex_);
    state_ = FrameSourceState::kStopped;
    fresh_ = false;
    pending_.clear();
  }

  bool poll(Frame& newest) override {
    if (!options_.own_thread && state() == FrameSourceState::kRunning) {
      idle_ = false;
      for (int i = 0; i < kMaxTransfersPerPoll && !idle_ && read_once(milliseconds(0)); ++i) {
      }
    }
    const std::lock_guard lock(mutex_);
    if (!fresh_) return false;
    std::swap(newest, newest_);
    fresh_ = false;
    return true;
  }
  FrameSourceState state() const override {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  std::string reason() const override {
    const std::lock_guard lock(mutex_);
    return reason_;
  }
  std::optional<lmc1::Calibration> calibration() const override { return calibration_; }
  Lmc1Counters counters() const override {
    const std::lock_guard lock(mutex_);
    return counters_;
  }
  Result<void> set_exposure(int us) override { return queue(lmc1::exposure_us(us)); }
  Result<void> set_dark_frame_interval(int n) override { return queue(lmc1::dark_frame_interval(n)); }

 private:
  static constexpr std::array<lmc1::Switch, 3> kLeds{lmc1::Switch::kLedLeft, lmc1::Switch::kLedCentre,
                                                     lmc1::Switch::kLedRight};

  Result<void> prepare(const lmc1::Mode& mode) {
    DUBSAR_ASSIGN(calibration_, read_lmc1_calibration(*transport_, options_.calibration_settle));
    DUBSAR_TRY(commit_mode(*transport_, mode));
    DUBSAR_ASSIGN(const auto exposure, lmc1::exposure_us(options_.exposure_us));
    DUBSAR_ASSIGN(const auto gain, lmc1::analog_gain(options_.analog_gain_sixteenths));
    DUBSAR_ASSIGN(const auto dark, lmc1::dark_frame_interval(options_.dark_frame_interval));
    for (const auto& write : {lmc1::switch_on(lmc1::Switch::kHdr, false), lmc1::gamma(false), exposure, gain, dark})
      DUBSAR_TRY(send(*transport_, write));
    for (const lmc1::Switch led : kLeds) DUBSAR_TRY(send(*transport_, lmc1::switch_on(led, options_.leds)));
    return {};
  }

  Result<void> queue(Result<lmc1::ControlWrite> write) {
    if (!write) return tl::unexpected<Error>(std::move(write).error());
    const std::lock_guard lock(mutex_);
    if (state_ != FrameSourceState::kRunning)
      return fail(ErrorKind::kUsage, "leap: settings can be changed only while the source is running");
    pending_.push_back(*write);
    return {};
  }

  /// One transfer. False: the device is lost.
  bool read_once(milliseconds timeout) {
    {
      const std::lock_guard lock(mutex_);
      writes_.swap(pending_);
    }
    for (const auto& write : writes_)
      if (auto sent = send(*transport_, write); !sent && sent.error().kind == ErrorKind::kUnavailable)
        return lose(sent.error().message);
    writes_.clear();

    const auto length = transport_->read(transfer_, timeout);
    if (!length) {
      if (length.error().kind == ErrorKind::kUnavailable) return lose(length.error().message);
      if (++failures_ >= kMaxFailures) return lose(length.error().message);
      return true;  // concerns this transfer only: the frame will come out short and be dropped
    }
    failures_ = 0;
    idle_ = *length == 0;
    if (idle_) return true;
    const bool complete = assembler_->add(std::span(transfer_).first(*length));
    if (complete) unpack(assembler_->frame(), *mode_, ++sequence_, working_);
    const std::lock_guard lock(mutex_);
    counters_ = {assembler_->frames(), assembler_->dropped_frames(), assembler_->bad_transfers()};
    if (!complete) return true;
    std::swap(working_, newest_);
    fresh_ = true;
    return true;
  }

  void unpack(std::span<const std::byte> bytes, const lmc1::Mode& mode, std::uint64_t sequence, Frame& frame) const {
    frame.time = clock_.now();
    frame.sequence = sequence;
    frame.width = mode.width;
    frame.height = mode.height;
    frame.views = 2;
    frame.format = PixelFormat::kGray8;
    frame.pixels.resize(bytes.size());
    const auto metadata = lmc1::decode_metadata(bytes.last<lmc1::kMetadataBytes>());
    frame.exposure_us = metadata.exposure_us;
    frame.dark = metadata.label == 1;  // not checked on a device
    const std::span<std::uint8_t> pixels(frame.pixels);
    lmc1::deinterleave(bytes, pixels.first(bytes.size() / 2), pixels.last(bytes.size() / 2));
  }

  bool lose(const std::string& why) {
    const std::lock_guard lock(mutex_);
    state_ = FrameSourceState::kLost;
    reason_ = why;
    return false;
  }

  const OpenTransport open_;
  const Lmc1Options options_;
  const Clock& clock_;

  // The reader thread's while it runs.
  std::unique_ptr<Transport> transport_;
  std::optional<lmc1::Calibration> calibration_;
  const lmc1::Mode* mode_ = nullptr;
  std::optional<UvcAssembler> assembler_;
  std::vector<std::byte> transfer_;
  std::vector<lmc1::ControlWrite> writes_;
  Frame working_;
  std::uint64_t sequence_ = 0;
  int failures_ = 0;
  bool idle_ = false;  ///< the last read found nothing
  std::thread thread_;
  std::atomic<bool> stopping_{false};

  mutable std::mutex mutex_;
  FrameSourceState state_ = FrameSourceState::kStopped;
  std::string reason_;
  Frame newest_;
  bool fresh_ = false;
  Lmc1Counters counters_;
  std::vector<lmc1::ControlWrite> pending_;
};

}  // namespace

Result<lmc1::Calibration> read_lmc1_calibration(Transport& transport, milliseconds settle) {
  const auto sharpness = static_cast<std::uint8_t>(lmc1::Selector::kSharpness);
  const auto saturation = static_cast<std::uint8_t>(lmc1::Selector::kSaturation);
  std::array<std::byte, lmc1::kCalibrationBytes> blob{};
  for (std::size_t i = 0; i < blob.size(); ++i) {
    std::array<std::byte, 2> data{std::byte(static_cast<std::size_t>(lmc1::kCalibrationAddress) + i), std::byte{0}};
    DUBSAR_TRY(transport.control(lmc1::set_current(lmc1::kProcessingUnit, sharpness), data, kControlTimeout));
    if (settle > milliseconds{0}) std::this_thread::sleep_for(settle);
    DUBSAR_ASSIGN(const std::size_t length,
                  transport.control(lmc1::get_current(lmc1::kProcessingUnit, saturation), data, kControlTimeout));
    if (length != 2) return fail(ErrorKind::kBadData, "leap: calibration answer of {} bytes, expected 2", length);
    blob[i] = data[0];
  }
  return lmc1::decode_calibration(blob);
}

std::unique_ptr<Lmc1Driver> make_lmc1_driver(OpenTransport open, const Lmc1Options& options, const Clock& clock) {
  return std::make_unique<Driver>(std::move(open), options, clock);
}

}  // namespace dubsar
