// The only file that includes OpenCV's capture code. It is a module of its own, see capture.h.

#include "devices/camera/opencv_capture.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "devices/camera/capture.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPatienceNs = 1'000'000'000;
constexpr int kLargestSize = 8192;

class OpenCvCapture final : public Capture {
 public:
  OpenCvCapture(std::string path, cv::VideoCapture capture) : path_(std::move(path)), captures_{std::move(capture)} {}

  Result<bool> read(std::vector<std::uint8_t>& rgb, int& width, int& height) override {
    try {
      // OpenCV itself would wait 10 s for a camera that has stopped; the first grab starts the stream
      std::vector<int> ready;
      if (streaming_ && !cv::VideoCapture::waitAny(captures_, ready, kPatienceNs))
        return still_there() ? Result<bool>(false) : gone();
      if (!captures_[0].grab() || !captures_[0].retrieve(picture_)) return gone();
    } catch (const cv::Exception&) {  // its words for an unplugged camera: an assertion failed
      return gone();
    }
    streaming_ = true;
    if (picture_.type() != CV_8UC3 || picture_.cols < 1 || picture_.rows < 1 || picture_.cols > kLargestSize ||
        picture_.rows > kLargestSize)
      return fail(ErrorKind::kUnavailable, "camera {}: a picture of {} x {} and type {}, expected 8-bit colour", path_,
                  picture_.cols, picture_.rows, picture_.type());
    width = picture_.cols;
    height = picture_.rows;
    rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    std::uint8_t* to = rgb.data();
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* from = picture_.ptr<std::uint8_t>(y);  // blue, green, red
      for (int x = 0; x < width; ++x, from += 3, to += 3) {
        to[0] = from[2];
        to[1] = from[1];
        to[2] = from[0];
      }
    }
    return true;
  }

 private:
  bool still_there() const { return ::access(path_.c_str(), F_OK) == 0; }
  tl::unexpected<Error> gone() const {
    return fail(ErrorKind::kUnavailable, "camera {}: no more pictures: it was unplugged or has stopped", path_);
  }
  std::string path_;
  std::vector<cv::VideoCapture> captures_;  // one; waitAny() wants it so
  cv::Mat picture_;
  bool streaming_ = false;
};

/// OpenCV does not say why it cannot open a device; the kernel does.
Result<void> check_node(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const int error = descriptor < 0 ? errno : 0;
  if (descriptor >= 0) ::close(descriptor);
  if (error == EACCES || error == EPERM)
    return fail(ErrorKind::kPermission,
                "camera {}: this user may not open it; usermod -aG video $USER and log in again", path);
  if (error == EBUSY)
    return fail(ErrorKind::kUnavailable, "camera {}: another program holds it; end that program (lsof {})", path, path);
  if (error != 0) return fail(ErrorKind::kUnavailable, "camera {}: {}", path, std::strerror(error));
  return {};
}

}  // namespace

Result<std::unique_ptr<Capture>> open_opencv_capture(const std::string& path, const CaptureFormat& format) {
  DUBSAR_TRY(check_node(path));
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    // MJPG first: uncompressed pictures take so much of a shared USB bus that other cameras, a Leap say, get
    // nothing
    cv::VideoCapture capture(path, cv::CAP_V4L2);
    if (!capture.isOpened())
      return fail(ErrorKind::kUnavailable,
                  "camera {}: not a camera that delivers pictures, or another program holds it (lsof {})", path, path);
    capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
    capture.set(cv::CAP_PROP_FRAME_WIDTH, format.width);
    capture.set(cv::CAP_PROP_FRAME_HEIGHT, format.height);
    capture.set(cv::CAP_PROP_FPS, format.fps);
    capture.set(cv::CAP_PROP_BUFFERSIZE, 2);  // old pictures are worth nothing
    return std::make_unique<OpenCvCapture>(path, std::move(capture));
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kUnavailable, "camera {}: {}", path, exception.what());
  }
}

}  // namespace dubsar

extern "C" __attribute__((visibility("default")))
const dubsar::CaptureModule dubsar_capture{dubsar::CaptureModule::kVersion, dubsar::open_opencv_capture};
