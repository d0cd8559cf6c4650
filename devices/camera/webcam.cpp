#include "devices/camera/webcam.h"

#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "devices/mailbox.h"

namespace dubsar {
namespace {

constexpr int kMostSilentReads = 3;  // of about a second each

using Open = std::function<Result<std::unique_ptr<Capture>>(const std::string&, const CaptureFormat&)>;

Result<std::string> first_usable_camera() {
  Error error{ErrorKind::kUnavailable, "camera: none is plugged in"};
  for (const DeviceInfo& info : list_cameras()) {
    if (info.state == DeviceState::kUsable) return info.path;
    if (info.state == DeviceState::kIgnored) continue;
    error = {info.state == DeviceState::kNoPermission ? ErrorKind::kPermission : ErrorKind::kUnavailable,
             fmt::format("camera {}: {}; {}", info.path, info.reason, info.remedy)};
  }
  return tl::unexpected<Error>(std::move(error));
}

class Camera final : public FrameSource {
 public:
  Camera(const WebcamOptions& options, Open open, const Clock& clock)
      : options_(options), open_(std::move(open)), clock_(clock) {}
  ~Camera() override { Camera::stop(); }

  Result<void> start() override {
    stop();
    std::string path = options_.path;
    if (path.empty()) {
      DUBSAR_ASSIGN(path, first_usable_camera());
    }
    DUBSAR_ASSIGN(capture_, open_(path, options_.format));
    box_.tell(FrameSourceState::kRunning);
    stopping_ = false;
    thread_ = std::thread([this] {
      try {
        read_loop();
      } catch (const std::exception& mistake) {  // costs the camera, not the session
        box_.tell(FrameSourceState::kLost,
                  fmt::format("camera: reading has stopped by a mistake of this program: {}", mistake.what()));
      }
    });
    return {};
  }

  void stop() noexcept override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    capture_.reset();
    box_.tell(FrameSourceState::kStopped, {}, false);
  }

  bool poll(Frame& newest) override { return box_.take(newest); }
  bool wait(Frame& newest, std::chrono::milliseconds timeout) override {
    return box_.wait(newest, timeout, FrameSourceState::kRunning);
  }
  FrameSourceState state() const override { return box_.state(); }
  std::string reason() const override { return box_.reason(); }

 private:
  void read_loop() {
    Frame frame;
    int silent = 0;
    while (!stopping_) {
      const auto got = capture_->read(frame.pixels, frame.width, frame.height);
      if (!got) return lose(got.error().message);
      if (!*got) {
        if (++silent >= kMostSilentReads) return lose("camera: no pictures for three seconds");
        continue;
      }
      silent = 0;
      frame.time = clock_.now();
      frame.sequence = ++sequence_;
      frame.views = 1;
      frame.format = PixelFormat::kRgb8;
      frame.exposure_us = 0;
      frame.dark = false;
      box_.put(frame);
    }
  }
  void lose(std::string why) { box_.tell(FrameSourceState::kLost, std::move(why)); }

  const WebcamOptions options_;
  const Open open_;
  const Clock& clock_;

  // The reader thread's while it runs.
  std::unique_ptr<Capture> capture_;
  std::uint64_t sequence_ = 0;
  std::thread thread_;
  std::atomic<bool> stopping_{false};

  Mailbox<Frame, FrameSourceState> box_{FrameSourceState::kStopped};
};

}  // namespace

std::unique_ptr<FrameSource> make_camera(const WebcamOptions& options, Open open, const Clock& clock) {
  return std::make_unique<Camera>(options, std::move(open), clock);
}

}  // namespace dubsar
