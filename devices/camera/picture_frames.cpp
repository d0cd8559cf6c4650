#include "devices/camera/picture_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "core/image_io/jpeg_file.h"
#include "core/image_io/png_file.h"

namespace dubsar {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kTimeDigits = 12;

Result<Image> read_picture(const fs::path& path) {
  return path.extension() == ".png" ? read_png(path) : read_jpeg(path);
}

struct Picture {
  fs::path path;
  TimestampNs time = 0;  ///< since the first one
};

class Pictures final : public PictureFrames {
 public:
  Pictures(fs::path folder, double fps, const Clock& clock) : folder_(std::move(folder)), fps_(fps), clock_(clock) {}

  Result<void> start() override {
    pictures_.clear();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
      const std::string kind = entry.path().extension();
      if (kind == ".png" || kind == ".jpg" || kind == ".jpeg") pictures_.push_back({entry.path(), 0});
    }
    if (error) return fail(ErrorKind::kNoInput, "pictures: {}: {}", folder_.string(), error.message());
    if (pictures_.empty()) return fail(ErrorKind::kNoInput, "pictures: no PNG or JPEG file in {}", folder_.string());
    std::sort(pictures_.begin(), pictures_.end(), [](const Picture& a, const Picture& b) { return a.path < b.path; });
    const bool timed = std::all_of(pictures_.begin(), pictures_.end(), [](const Picture& picture) {
      const std::string name = picture.path.stem();
      return name.size() == kTimeDigits &&
             std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    });
    for (std::size_t i = 0; i < pictures_.size(); ++i)
      pictures_[i].time = timed ? 1000 * std::strtoll(pictures_[i].path.stem().c_str(), nullptr, 10)
                                : static_cast<TimestampNs>(1e9 * static_cast<double>(i) / fps_);
    start_ = clock_.now();
    next_ = 0;
    state_ = FrameSourceState::kRunning;
    reason_.clear();
    return {};
  }
  void stop() noexcept override { state_ = FrameSourceState::kStopped; }

  bool poll(Frame& newest) override {
    if (state_ != FrameSourceState::kRunning) return false;
    const TimestampNs age = clock_.now() - start_;
    std::size_t due = next_;
    while (due < pictures_.size() && pictures_[due].time <= age) ++due;
    if (due == next_) return false;
    const Picture& picture = pictures_[due - 1];
    auto image = read_picture(picture.path);
    if (!image || image->channels != 3) {
      state_ = FrameSourceState::kLost;
      reason_ = image ? picture.path.string() + " has transparent parts, expected a photograph" : image.error().message;
      return false;
    }
    newest.time = start_ + picture.time;
    newest.sequence = due;
    newest.width = image->width;
    newest.height = image->height;
    newest.views = 1;
    newest.format = PixelFormat::kRgb8;
    newest.pixels = std::move(image->pixels);
    next_ = due;
    if (finished()) {
      state_ = FrameSourceState::kStopped;
      reason_ = "the last picture has been shown";
    }
    return true;
  }
  bool wait(Frame& newest, std::chrono::milliseconds timeout) override {
    const auto until = std::chrono::steady_clock::now() + timeout;
    while (!poll(newest)) {
      if (state_ != FrameSourceState::kRunning || std::chrono::steady_clock::now() >= until) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  FrameSourceState state() const override { return state_; }
  std::string reason() const override { return reason_; }
  bool finished() const noexcept override { return !pictures_.empty() && next_ == pictures_.size(); }

 private:
  const fs::path folder_;
  const double fps_;
  const Clock& clock_;
  std::vector<Picture> pictures_;
  TimestampNs start_ = 0;
  std::size_t next_ = 0;
  FrameSourceState state_ = FrameSourceState::kStopped;
  std::string reason_;
};

}  // namespace

std::unique_ptr<PictureFrames> make_picture_frames(const fs::path& folder, double fps, const Clock& clock) {
  return std::make_unique<Pictures>(folder, fps, clock);
}

Result<void> FrameRecorder::write(const Frame& frame) {
  if (frame.format != PixelFormat::kRgb8 || frame.views != 1)
    return fail(ErrorKind::kUsage, "pictures: only colour frames of one view can be kept");
  if (written_ == 0) first_ = frame.time;
  Image image(frame.width, frame.height, 3);
  image.pixels = frame.pixels;
  PngOptions options;
  options.compression = 1;  // keeps up with a camera
  DUBSAR_TRY(write_png(folder_ / fmt::format("{:012}.png", (frame.time - first_) / 1000), image, options));
  ++written_;
  return {};
}

}  // namespace dubsar
