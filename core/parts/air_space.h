#pragma once
// The air around and inside a scanned object: which of it is outside, which is enclosed once cracks are
// closed, and how deep any point lies below the outside (docs/method.md, 8).

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// A copy with clear bits around it: `margin` grid points along y and z, 64 along x (a whole word).
BitVolume pad(const BitVolume& bits, int margin);
/// The inverse of pad().
BitVolume crop(const BitVolume& bits, int margin);

/// `inside` dilated by a cube of edge 2 r + 1. Bit-parallel, all threads.
BitVolume dilate(const BitVolume& inside, int r);

/// Set bits: points of `free` connected to the border of the grid through `free` (6-neighbourhood; beyond the
/// grid all is free). `free` is given by its complement `blocked`. Cost: linear in the number of runs along
/// x.
BitVolume flood_from_border(const BitVolume& blocked);

struct Exterior {
  int crack_radius = 0;             ///< passages narrower than 2 r + 1 grid steps count as closed
  BitVolume air;                    ///< exterior air
  std::int64_t enclosed_faces = 0;  ///< grid faces between the object and air that is not exterior
};

/// Tries crack radii from 0 to `largest_radius` and takes the smallest that encloses nearly as much surface
/// as any: that is 0 for a sound envelope, and the width of the cracks for a broken one. Two closings for a sound
/// envelope, log2(largest_radius) more for a broken one. kCancelled.
Result<Exterior> find_exterior(const BitVolume& inside, int largest_radius, Progress& progress);

/// Connected components (6-neighbourhood) of the air that is neither inside nor exterior.
class EnclosedAir {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  EnclosedAir(const BitVolume& inside, const BitVolume& exterior);
  std::uint32_t count() const noexcept { return count_; }
  /// Component at a grid point, kNone elsewhere. O(log runs in the row).
  std::uint32_t at(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept;

 private:
  struct Run {
    std::uint32_t begin, end;  ///< x
    std::uint32_t component;
  };
  Dims dims_;
  std::vector<std::int64_t> first_run_;  ///< of each row
  std::vector<Run> runs_;
  std::uint32_t count_ = 0;
};

/// Distance to the exterior, smoothed, on a coarser grid: its gradient points from the outside inwards.
class DepthField {
 public:
  /// `seal_radius`: the exterior is taken without hollows narrower than 2 r + 1, so that relief does not bend
  /// the field.
  static Result<DepthField> make(const BitVolume& inside, int seal_radius, Progress& progress);
  /// Unit gradient at a point in grid coordinates; zero where the field is flat.
  glm::vec3 inwards(const glm::vec3& p) const noexcept;
  /// Depth in grid steps.
  float depth(const glm::vec3& p) const noexcept;

 private:
  Dims dims_;          ///< of the coarse grid
  float step_ = 1.0f;  ///< grid steps per coarse step; coarse point i lies at step * (i - 1)
  std::vector<float> depth_;
};

}  // namespace dubsar
