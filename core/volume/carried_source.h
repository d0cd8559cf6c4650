#pragma once
// A volume of which the surface has moved: values near places are carried along with them.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/volume/slab_source.h"

namespace dubsar {

/// The source at x less its slopes there times the mean move of the places within kReach of x: a crossing that stays in
/// its edge moves as far as the places beside it, since of two slopes the steeper counts. Values farther from all
/// places are those of the source, to the bit; exchanged axes change nothing but roundings of doubles.
class CarriedSource final : public SlabSource {
 public:
  static constexpr double kReach = 2.0;  ///< grid steps; a place counts (1 - (r / kReach)^2)^3

  /// `moves`: one for each of `places`, both in grid steps and times `share`. Borrows all of them. 4 bytes a place and
  /// row of the grid.
  CarriedSource(SlabSource& source, std::span<const glm::vec3> places, std::span<const glm::vec3> moves, float share);
  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  /// Adds the moves around row (y, z) and their weights: four numbers for each x. False: there are none.
  bool gather(std::int64_t y, std::int64_t z, std::vector<double>& sums) const;

  SlabSource* source_;
  std::span<const glm::vec3> places_, moves_;
  float share_;
  std::vector<std::uint32_t> first_, order_;  ///< places by the row of their cell
  std::vector<float> slices_;                 ///< of the source, one more at either end
};

}  // namespace dubsar
