#include "input/sources/webcam_source.h"

#include <array>

#include "core/base/numbers/angle.h"
#include "core/base/text/option_reader.h"
#include "core/base/text/parse_number.h"
#include "devices/camera/capture.h"
#include "devices/camera/picture_frames.h"
#include "devices/camera/webcam.h"
#include "devices/transport/retry_pause.h"
#include "input/sources/threaded_source.h"
#include "input/tracking/face/face_tracker.h"
#include "input/tracking/vision/model_files.h"
#include "input/tracking/webcam_hands/webcam_hand_tracker.h"

namespace dubsar {
namespace {

constexpr const char* kCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_default.xml";
constexpr double kAbovePanelM = 0.01;
constexpr TimestampNs kCameraSilentNs = 2'000'000'000;

class WebcamReader final : public SourceReader {
 public:
  WebcamReader(WebcamFrames frames, FaceTracker faces, std::optional<WebcamHandTracker> hands)
      : frames_(std::move(frames)), faces_(std::move(faces)), hands_(std::move(hands)) {}

  bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) override {
    if (!open_ && !open(now)) return false;
    if (!frames_.source->wait(picture_, timeout)) {
      if (frames_.source->state() == FrameSourceState::kLost) lose(frames_.source->reason(), now);
      return false;
    }
    Result<void> tracked = faces_.track(picture_, frame.heads);
    if (tracked && hands_) tracked = hands_->track(picture_, frame.hands);
    if (!tracked) {
      lose(tracked.error().message, now);
      return false;
    }
    frame.time = picture_.time;
    return true;
  }
  bool connected() const override { return open_; }
  std::string reason() const override { return reason_; }
  void wake() override { retry_.wake(); }
  bool finished() const override { return frames_.ended && frames_.ended(); }

 private:
  bool open(TimestampNs now) {
    if (!retry_.due(now) || finished()) return false;
    if (auto started = frames_.source->start(); !started) {
      reason_ = std::move(started).error().message;
      retry_.failed(now);
      return false;
    }
    retry_.succeeded();
    reason_.clear();
    return open_ = true;
  }
  void lose(std::string why, TimestampNs now) {
    reason_ = std::move(why);
    frames_.source->stop();
    open_ = false;
    retry_.lost(now);
  }

  WebcamFrames frames_;
  FaceTracker faces_;
  std::optional<WebcamHandTracker> hands_;
  RetryPause retry_;
  std::string reason_;
  bool open_ = false;
  Frame picture_;
};

Result<std::unique_ptr<FaceDetector>> make_detector(const std::filesystem::path& models) {
  auto network = make_network_face_detector(models);
  if (network || network.error().kind != ErrorKind::kNoInput) return network;
  auto cascade = make_cascade_face_detector(kCascade);
  if (cascade) return cascade;
  return fail(ErrorKind::kUnavailable, "input webcam: no face network in {} ({} fetches it) and no cascade: {}",
              models.string(), kModelCommand, cascade.error().message);
}

struct WebcamSourceOptions {
  WebcamOptions camera;
  std::string replay;
  FaceTrackerOptions tracking;
  bool hands = false;
  double hand_size = 1.0;
  std::filesystem::path models;
};

Result<WebcamSourceOptions> read_options(const InputConfig& config, bool with_camera) {
  OptionReader options(config.options, "input webcam");
  WebcamSourceOptions read;
  std::string size = "640x480";
  if (with_camera) {
    read.camera.path = options.text("device");
    read.camera.format.fps = options.number("fps", 1.0, 240.0, 30.0);
    size = options.text("size", size);
    read.replay = options.text("replay");
  }
  const glm::dvec3 top_mm(0.0, 1e3 * (0.5 * config.panel_m.y + kAbovePanelM), 0.0);
  read.tracking.camera.horizontal_field_rad = kRadPerDeg * options.number("hfov", 20.0, 150.0, 60.0);
  read.tracking.camera.at_m = 1e-3 * options.triple("at", 10'000.0, top_mm);
  read.tracking.camera.tilt_rad = kRadPerDeg * options.number("tilt", -90.0, 90.0, 0.0);
  read.tracking.ipd_m = 1e-3 * options.number("ipd", 40.0, 90.0, 63.0);
  read.hands = options.flag("hands");
  read.hand_size = options.number("hand", 0.5, 1.5, 1.0);
  read.models = options.text("models", config.model_folder.string());
  DUBSAR_TRY(options.finish());
  CaptureFormat& format = read.camera.format;
  const auto pixels = parse_size(size).value_or(std::array{0, 0});
  format.width = pixels[0];
  format.height = pixels[1];
  if (format.width < 160 || format.width > 4096 || format.height < 120 || format.height > 4096)
    return fail(ErrorKind::kUsage, "input webcam: size is \"{}\", expected WIDTHxHEIGHT such as 640x480", size);
  return read;
}

Result<std::unique_ptr<InputSource>> make_source(WebcamFrames frames, const WebcamSourceOptions& options,
                                                 const InputConfig& config) {
  DUBSAR_ASSIGN(auto detector, make_detector(options.models));
  std::optional<WebcamHandTracker> hands;
  if (options.hands) {
    auto networks = make_hand_networks(options.models);
    if (!networks && networks.error().kind == ErrorKind::kNoInput)
      return fail(ErrorKind::kUnavailable,
                  "input webcam: hands need their networks, which are not in {}; {} fetches them",
                  options.models.string(), kModelCommand);
    if (!networks) return tl::unexpected<Error>(std::move(networks).error());
    WebcamHandOptions tracking;
    tracking.camera = options.tracking.camera;
    tracking.hand_size = options.hand_size;
    hands.emplace(*std::move(networks), tracking);
  }
  ThreadedSourceTraits traits;
  traits.name = "webcam";
  traits.has_end = frames.ended != nullptr;
  traits.silent_ns = traits.has_end ? 0 : kCameraSilentNs;
  if (detector->name() != "network")
    traits.note = fmt::format("webcam: faces without their network: depth is coarse; {} fetches it", kModelCommand);
  auto reader = std::make_unique<WebcamReader>(std::move(frames), FaceTracker(std::move(detector), options.tracking),
                                               std::move(hands));
  return make_threaded_source(std::move(traits), std::move(reader), config);
}

/// Pictures that two hold: the reader, and whoever asks whether they are over.
class SharedPictures final : public FrameSource {
 public:
  explicit SharedPictures(std::shared_ptr<PictureFrames> pictures) : pictures_(std::move(pictures)) {}
  Result<void> start() override { return pictures_->start(); }
  void stop() noexcept override { pictures_->stop(); }
  bool poll(Frame& newest) override { return pictures_->poll(newest); }
  bool wait(Frame& newest, milliseconds timeout) override { return pictures_->wait(newest, timeout); }
  FrameSourceState state() const override { return pictures_->state(); }
  std::string reason() const override { return pictures_->reason(); }

 private:
  std::shared_ptr<PictureFrames> pictures_;
};

}  // namespace

Result<std::unique_ptr<InputSource>> make_webcam_source_over(WebcamFrames frames, const InputConfig& config) {
  DUBSAR_ASSIGN(const WebcamSourceOptions options, read_options(config, false));
  return make_source(std::move(frames), options, config);
}

Result<std::unique_ptr<InputSource>> make_webcam_source(const InputConfig& config) {
  DUBSAR_ASSIGN(const WebcamSourceOptions options, read_options(config, true));
  WebcamFrames frames;
  if (!options.replay.empty()) {
    std::shared_ptr<PictureFrames> pictures =
        make_picture_frames(options.replay, options.camera.format.fps, session_clock(config));
    DUBSAR_TRY(pictures->start());  // says now what is wrong with the folder
    frames.ended = [pictures] { return pictures->finished(); };
    frames.source = std::make_unique<SharedPictures>(std::move(pictures));
  } else {
    if (config.simulated_time)
      return fail(ErrorKind::kUsage,
                  "input webcam: a camera cannot run in simulated time, expected replay=FOLDER with pictures");
    DUBSAR_ASSIGN(const OpenCapture open, load_capture());
    frames.source = make_camera(options.camera, open, session_clock(config));
  }
  return make_source(std::move(frames), options, config);
}

}  // namespace dubsar
