#pragma once
// Rings about the axis of rotation: what uneven detector pixels add to a scan, by distance from the axis and by slice.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/volume/slab_source.h"

namespace dubsar {

/// Where rings change in scans of half a turn, in which a pixel sees one side of the axis: half rings on both sides of
/// a line through it.
struct HalfTurn {
  double angle = 0.0;  ///< of that line from x to y, radians
};

/// Grey values at whole distances from an axis along z, linear in between; nothing beyond the last.
struct RingField {
  glm::dvec2 centre{0.0};        ///< x and y of the axis, voxels
  std::int64_t radii = 0;        ///< of a slice
  std::vector<float> of_slice;   ///< radii values a slice, or as many for the left of the line and then for its right
  std::optional<HalfTurn> half;  ///< nothing: whole rings

  std::int64_t arcs() const noexcept { return half ? 2 : 1; }

  /// Takes the rings off a row of the volume.
  void subtract(std::int64_t y, std::int64_t z, std::span<float> row) const;
};

/// Largest distance of a voxel from the axis, in whole voxels, and one more.
std::int64_t radii_of(const Dims& dims, const glm::dvec2& centre);

/// A source less its rings. Borrows the source.
class RinglessSource final : public SlabSource {
 public:
  RinglessSource(SlabSource& source, RingField field) : source_(&source), field_(std::move(field)) {}
  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  std::int64_t preferred_height() const noexcept override { return source_->preferred_height(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  SlabSource* source_;
  RingField field_;
};

}  // namespace dubsar
