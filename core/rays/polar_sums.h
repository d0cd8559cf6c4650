#pragma once
// Slices about an axis: sums of what is clay and what is air for sure, by distance and by sector.

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/rays/sure_materials.h"
#include "core/volume/volume.h"

namespace dubsar {

/// Distance and sector of each voxel of a slice.
class PolarSlice {
 public:
  static constexpr std::int64_t kSectors = 16;

  PolarSlice(const Dims& dims, const glm::dvec2& centre);
  const Dims& dims() const noexcept { return dims_; }
  std::int64_t radii() const noexcept { return radii_; }

  /// Adds values of a slice, shared linearly by the two whole distances beside them. `sure`: of the slice at half the
  /// resolution, dims x / 2, y / 2, which stands for two voxels each way.
  void add(std::span<const float> slice, std::span<const Material> sure, struct PolarSums& sums) const;

 private:
  Dims dims_;
  std::int64_t radii_;
  std::vector<float> radius_;
  std::vector<std::uint8_t> sector_;
};

struct PolarSums {
  explicit PolarSums(std::int64_t distances)
      : radii(distances),
        sum(static_cast<std::size_t>(2 * PolarSlice::kSectors * distances)),
        weight(static_cast<std::size_t>(2 * PolarSlice::kSectors * distances)) {}
  std::int64_t radii;
  std::vector<double> sum, weight;  ///< [clay][sector][radius]

  std::size_t at(bool clay, std::int64_t sector, std::int64_t radius) const noexcept {
    return static_cast<std::size_t>(((clay ? PolarSlice::kSectors : 0) + sector) * radii + radius);
  }
  void add(const PolarSums& other);
  /// Of half a turn, from a sector on; counts on over the last.
  PolarSums half_from(std::int64_t first_sector) const;
};

/// What is the same over all angles, for each whole distance: 0 with an infinite error where too little is seen.
struct AngularConstants {
  std::vector<double> value, error;  ///< the latter one standard deviation
  std::vector<double> uneven;        ///< largest difference of one half of the turn
};

/// Of each sector the difference from the running median of its own material along the radius, then the median over
/// the sectors. [0] of air, [1] of clay, [2] of both. The noise is that of the differences between sectors.
std::array<AngularConstants, 3> constants_over_angles(const PolarSums& sums);

}  // namespace dubsar
