// The only file that includes OpenCV's objdetect.

#include "input/tracking/vision/face_cascade.h"

#include <opencv2/core/utility.hpp>
#include <opencv2/objdetect.hpp>

#include "core/base/files/input_file.h"

namespace dubsar {

struct FaceCascade::Impl {
  cv::CascadeClassifier cascade;
};

FaceCascade::FaceCascade(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
FaceCascade::FaceCascade(FaceCascade&&) noexcept = default;
FaceCascade& FaceCascade::operator=(FaceCascade&&) noexcept = default;
FaceCascade::~FaceCascade() = default;

Result<FaceCascade> FaceCascade::read(const std::filesystem::path& path) {
  if (auto there = InputFile::open(path); !there) return tl::unexpected<Error>(std::move(there).error());
  auto impl = std::make_unique<Impl>();
  try {
    cv::setNumThreads(1);
    if (!impl->cascade.load(path.string()))
      return fail(ErrorKind::kBadData, "{}: not an OpenCV cascade", path.string());
  } catch (const cv::Exception& exception) {
    return fail(ErrorKind::kBadData, "{}: not an OpenCV cascade: {}", path.string(), exception.what());
  }
  return FaceCascade(std::move(impl));
}

std::vector<FaceBox> FaceCascade::find(const std::uint8_t* gray, int width, int height, int least_px) {
  const cv::Mat picture(height, width, CV_8UC1, const_cast<std::uint8_t*>(gray));
  std::vector<cv::Rect> faces;
  impl_->cascade.detectMultiScale(picture, faces, 1.1, 4, 0, cv::Size(least_px, least_px));
  std::vector<FaceBox> boxes;
  for (const cv::Rect& face : faces) boxes.push_back({face.x, face.y, face.width, face.height});
  return boxes;
}

}  // namespace dubsar
