#pragma once
// Faces in a picture: where the eyes are.

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "input/tracking/vision/picture_crop.h"

namespace dubsar {

/// Pixels, x right, y down. Left and right are the person's own: the right eye is on the left side of the
/// picture.
struct FaceSeen {
  double score = 0.0;  ///< 0 to 1
  glm::dvec2 centre_px{0.0};
  double size_px = 0.0;  ///< width of the face's box
  glm::dvec2 right_eye_px{0.0}, left_eye_px{0.0};
  std::optional<glm::dvec2> nose_px;
};

/// One thread at a time.
class FaceDetector {
 public:
  virtual ~FaceDetector() = default;
  virtual std::string_view name() const noexcept = 0;
  /// All faces of a picture, the surest first.
  virtual Result<std::vector<FaceSeen>> find(const PictureView& picture) = 0;
  /// The same face again in a picture, more exactly, looked for only near its place; nothing when it is not
  /// there.
  virtual Result<std::optional<FaceSeen>> refine(const PictureView& picture, const FaceSeen& near) = 0;
};

/// BlazeFace (short range, 128 x 128; Bazarevsky et al. 2019) in two passes: the whole picture, then a square
/// of twice the face's box, which divides the noise of the eyes' distance by two to three. About 2.5 ms a
/// pass on one core. `folder`: with kFaceModel. Errors as Network::read.
Result<std::unique_ptr<FaceDetector>> make_network_face_detector(const std::filesystem::path& folder);

/// Without a network: Viola and Jones' cascade; the eyes' places follow from the box, so that depth is coarse
/// and yaw unknown. `cascade`: OpenCV's haarcascade_frontalface_default.xml.
Result<std::unique_ptr<FaceDetector>> make_cascade_face_detector(const std::filesystem::path& cascade);

}  // namespace dubsar
