#pragma once
// Picture operations that hand tracking needs: blur, threshold, regions, distance to the outline, correlation.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace dubsar {

/// A picture inside borrowed memory, rows without gaps.
struct GrayView {
  const std::uint8_t* pixels = nullptr;
  int width = 0, height = 0;
  std::uint8_t at(int x, int y) const noexcept { return pixels[y * width + x]; }
};

/// 1 2 1 in both directions; the border stays as it is. `out` as large as `in`, not the same memory.
void blur_121(GrayView in, std::span<std::uint8_t> out);

/// Grey level between background and hands lit from the camera: `fraction` of the way from the commonest level to that
/// of bright skin, at least `margin` above it. Nothing: no pixel is that bright.
struct SkinThreshold {
  int grey = 0, background = 0;
};
std::optional<SkinThreshold> skin_threshold(GrayView picture, double fraction, int margin);

struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< columns [x0, x1), rows [y0, y1)
  int area_px = 0;
  std::uint8_t label = 0;
};

inline constexpr std::uint8_t kDroppedRegion = 255;

/// 4-connected regions of pixels >= threshold with at least `min_area_px`, the largest first, at most `most` (<= 8).
/// `labels`, as large as the picture, gets the label of kept regions, kDroppedRegion, else 0. Regions of less than 8
/// pixels in a row of their first line are found as well. `stack` is scratch.
std::vector<Region> find_regions(GrayView picture, int threshold, int min_area_px, int most,
                                 std::span<std::uint8_t> labels, std::vector<std::uint32_t>& stack);

/// Exact Euclidean distance in pixels to the nearest pixel with another label, for the region's box with a border of
/// one pixel (Felzenszwalb, Huttenlocher 2012). Row by row, (x1 - x0 + 2) x (y1 - y0 + 2). O(pixels).
void distance_inside(std::span<const std::uint8_t> labels, int width, int height, const Region& region,
                     std::vector<float>& distance);

/// Disparity d in [d_min, d_max] (pixel x of the left picture is x - d in the right one) with the highest zero-mean
/// normalised correlation over a disk, refined by a parabola. Nothing below `min_score` or at the end of the range.
struct Match {
  double disparity_px = 0.0, score = 0.0;
};
std::optional<Match> match_disk(GrayView left, GrayView right, const glm::dvec2& centre, double radius_px, int step,
                                int d_min, int d_max, double min_score);

}  // namespace dubsar
