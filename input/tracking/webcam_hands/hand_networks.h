#pragma once
// Hands in a picture by two networks (MediaPipe hands; Zhang et al. 2020): one finds palms, one places 21
// landmarks.

#include <array>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "input/tracking/vision/picture_crop.h"

namespace dubsar {

/// Wrist, then thumb, index, middle, ring and little finger from the palm to the tip, four each.
inline constexpr std::size_t kLandmarks = 21;

struct HandSeen {
  double presence = 0.0;  ///< 0 to 1: that this is a hand at all
  double right = 0.0;     ///< 0 to 1: that it is a right one, in a picture that is not mirrored
  SquareCrop crop;        ///< where it was looked for
  std::array<glm::dvec2, kLandmarks> points_px{};  ///< in the picture
  /// Metres about the hand's middle for a hand of usual size; x right and y down in the picture, z away from
  /// the camera.
  std::array<glm::dvec3, kLandmarks> shape_m{};

  /// Where to look for this hand in the next picture.
  SquareCrop next_crop() const noexcept;
};

/// One thread at a time.
class HandNetworks {
 public:
  virtual ~HandNetworks() = default;
  /// Squares about the hands of a picture, the surest first. About 30 ms on one core.
  virtual Result<std::vector<SquareCrop>> find_palms(const PictureView& picture) = 0;
  /// The hand in a square, whatever its presence. About 10 ms.
  virtual Result<HandSeen> place_landmarks(const PictureView& picture, const SquareCrop& crop) = 0;
};

/// `folder` with kPalmModel and kHandModel. Errors as Network::read.
Result<std::unique_ptr<HandNetworks>> make_hand_networks(const std::filesystem::path& folder);

}  // namespace dubsar
