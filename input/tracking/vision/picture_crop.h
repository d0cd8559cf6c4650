#pragma once
// Pieces of a picture as networks want them: a turned square, resampled, as planes of floats.

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// Borrowed RGB pixels, rows top down, no gaps.
struct PictureView {
  const std::uint8_t* rgb = nullptr;
  int width = 0, height = 0;
};

/// Picture coordinates: x right, y down, the first pixel covers 0 to 1.
struct SquareCrop {
  glm::dvec2 centre_px{0.0};
  double side_px = 0.0;
  double turn_rad = 0.0;  ///< of the square's axes, clockwise as seen

  /// `unit`: 0 to 1 from the square's top left to its bottom right.
  glm::dvec2 to_picture(const glm::dvec2& unit) const noexcept;
};

/// The whole picture in the middle of a square.
inline SquareCrop whole_picture(const PictureView& picture) noexcept {
  return {{0.5 * picture.width, 0.5 * picture.height},
          static_cast<double>(picture.width > picture.height ? picture.width : picture.height),
          0.0};
}

/// Samples crops bilinearly; where that would skip pixels the picture is first reduced by whole factors (box
/// means). Keeps its memory between calls. One thread.
class PictureSampler {
 public:
  /// `planes`: red, green, blue, each size x size; a level v of 0 to 255 becomes scale * v + offset, black
  /// outside of the picture. Cost: about a nanosecond for each pixel of the square plus 15 for each of the
  /// result.
  void sample(const PictureView& picture, const SquareCrop& crop, int size, float scale, float offset,
              std::span<float> planes);

 private:
  std::vector<std::uint8_t> reduced_;
};

}  // namespace dubsar
