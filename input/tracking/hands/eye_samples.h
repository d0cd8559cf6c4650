#pragma once
// The pixels of one eye as rays, in small tiles, so that a model can be compared with the picture as the
// sensor took it: without resampling.

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "input/tracking/hands/hand_fit_kernels.h"

namespace dubsar {

/// Part of the plane of rays (x/z, y/z).
struct RayBox {
  glm::vec2 low{}, high{};
  bool meets(const RayBox& other) const noexcept {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y;
  }
};

/// Unit rays of the pixels of a picture, `kLanes` to a tile, every `step`-th column.
class EyeRays {
 public:
  static constexpr std::size_t kLanes = kernels::kHandLanes;  ///< 8 columns of 2 rows

  /// `ray_from_pixel`: where a pixel of the device's picture looks, in the frame of the eye (x/z, y/z).
  EyeRays(const std::function<glm::dvec2(const glm::dvec2&)>& ray_from_pixel, int width, int height, int step);

  struct Tile {
    alignas(64) std::array<float, kLanes> x, y, z;
    std::array<std::uint32_t, kLanes> pixel;
  };
  const std::vector<Tile>& tiles() const noexcept { return tiles_; }
  const std::vector<RayBox>& boxes() const noexcept { return boxes_; }  ///< of the tiles

 private:
  std::vector<Tile> tiles_;
  std::vector<RayBox> boxes_;
};

/// How much of each pixel of the tiles around a hand is skin, by its brightness: 0 background, 1 skin.
struct EyeSamples {
  struct Tile {
    const EyeRays::Tile* rays = nullptr;
    alignas(64) std::array<float, EyeRays::kLanes> skin{}, weight{};
  };
  std::vector<Tile> tiles;
  std::vector<RayBox> boxes;  ///< of the tiles
  int samples = 0;            ///< with a weight
  double noise = 0.0;         ///< standard deviation of the skin shares where there is only background
  double eye_x_m = 0.0;
  double light_x_m = 0.0;   ///< from the eye
  double half_skin = 0.25;  ///< brightness of a half skin share, 1: skin that faces the light
};

}  // namespace dubsar
