#pragma once
// R and its transpose by tiles of the image: within a tile neighbouring directions are so alike that they are taken
// together, in a sinogram of its own. Of N x N pixels it takes some N^2 / 230 groups of directions instead of N.

#include <cstdint>
#include <span>
#include <vector>

#include "core/rays/lane_image.h"

namespace dubsar {

class TiledRays {
 public:
  /// Of an image of that size, a detector of `bins` whose middle is (bins - 1) / 2 and the directions pi k /
  /// `directions`, as ParallelRays has them.
  TiledRays(std::int64_t width, std::int64_t height, std::int64_t bins, std::int64_t directions);

  /// Directions taken together: no place of a tile is displaced on the detector by more than a quarter of a bin.
  static std::int64_t directions_together(std::int64_t directions) noexcept;

  void project(const LaneImage& image, LaneSinogram& out) const;
  /// Sums over directions, not divided by their number.
  void backproject(const LaneSinogram& filtered, LaneImage& out) const;

 private:
  struct Tile {
    std::int64_t x = 0, y = 0, width = 0, height = 0;
  };
  /// Some directions, those whose rays follow y rather than x or the other way round.
  struct Task {
    std::int64_t first = 0, last = 0;
    bool along_y = true;
  };
  void project_bands(const LaneImage& image, const Task& task, LaneSinogram& out) const;
  std::int64_t tiles() const noexcept;
  Tile tile(std::int64_t k) const noexcept;
  /// Place on the detector of a tile's middle, in bins.
  double place_of(const Tile& tile, std::int64_t direction) const noexcept;

  std::int64_t width_, height_, bins_, directions_;
  std::int64_t together_, of_band_ = 1;        ///< directions, in tiles and in bands
  std::vector<double> cos_, sin_;              ///< of directions
  std::vector<double> group_cos_, group_sin_;  ///< of the middles of groups of them
};

}  // namespace dubsar
