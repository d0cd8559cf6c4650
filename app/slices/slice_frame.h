#pragma once
// Which part of the scan a slice's picture shows, and where places of the scan stand in it. Plain arithmetic.

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "app/document/document.h"
#include "core/volume/plane_sampler.h"

namespace dubsar::app {

inline constexpr std::size_t kSlices = 4;
inline constexpr std::array<std::string_view, kSlices> kSliceNames{"x", "y", "z", "free"};

/// Places in pictures count pixels from the upper left corner: the middle of the first pixel is (0.5, 0.5).
struct SliceFrame {
  glm::dvec3 middle_mm{0.0};                      ///< of the picture
  glm::dvec3 right{1.0, 0, 0}, down{0, -1.0, 0};  ///< unit
  double mm_per_px = 1.0;
  int width = 0, height = 0;

  /// Towards whoever looks at it: pictures are no mirror images.
  glm::dvec3 to_viewer() const { return glm::cross(down, right); }
  glm::dvec3 mm_at(const glm::dvec2& px) const {
    return middle_mm + mm_per_px * ((px.x - 0.5 * width) * right + (px.y - 0.5 * height) * down);
  }
  glm::dvec2 px_at(const glm::dvec3& mm) const {
    const glm::dvec3 off = (mm - middle_mm) / mm_per_px;
    return {0.5 * width + glm::dot(off, right), 0.5 * height + glm::dot(off, down)};
  }
  /// Its pixels among the voxels of a scan.
  PlaneGrid grid(const glm::dvec3& voxel_mm) const {
    return {mm_at({0.5, 0.5}) / voxel_mm, mm_per_px * right / voxel_mm, mm_per_px * down / voxel_mm, width, height};
  }
  friend bool operator==(const SliceFrame&, const SliceFrame&) = default;
};

/// Slice `which` of kSliceNames for a picture of this size; at zoom 1 its shorter side shows `whole_mm`. Slices across
/// x and y have z upwards, those across z have y upwards.
SliceFrame slice_frame(const ScanView& view, std::size_t which, int width, int height, double whole_mm);

}  // namespace dubsar::app
