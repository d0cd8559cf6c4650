#pragma once
// The 127 shape classes of a surface point (paper section 3.4.2): flat, or 14 steps of curvedness times 9 shapes from
// cup to cap.

#include <cstdint>
#include <span>
#include <vector>

namespace dubsar {

constexpr int kShapes = 9;  ///< 0 cup, 1 trough, 2 rut, 3 saddle rut, 4 saddle, 5 saddle ridge, 6 ridge, 7 dome, 8 cap
constexpr int kCurvednessSteps = 14;  ///< half octaves
constexpr int kShapeClasses = 1 + kShapes * kCurvednessSteps;
constexpr float kSmallestCurvedness = 1.0f / 64.0f;  ///< per grid step, centre of step 0: a radius of 64 voxels

/// 0: flat, or 1 + 9 i + s. With phi = atan2(k_min, k_max) in [-135, 45] degrees, s = round((phi + 135) / 22.5), so
/// that cup, rut, saddle, ridge and cap (-135, -90, -45, 0, 45) are the centres of classes 0, 2, 4, 6, 8. With
/// c = hypot(k_min, k_max), i = round(2 log2(c / kSmallestCurvedness)): below 0 flat, above 13 held at 13.
/// Curvatures per grid step, convex > 0, in either order; not finite: flat.
std::uint8_t shape_class(float k_min, float k_max) noexcept;

/// s of a class, 0..8; -1 for flat.
constexpr int shape_of(std::uint8_t shape_class) noexcept {
  return shape_class == 0 ? -1 : (shape_class - 1) % kShapes;
}
/// i of a class, 0..13; -1 for flat.
constexpr int curvedness_step_of(std::uint8_t shape_class) noexcept {
  return shape_class == 0 ? -1 : (shape_class - 1) / kShapes;
}

/// One class per vertex. Threads.
std::vector<std::uint8_t> shape_classes(std::span<const float> k_min, std::span<const float> k_max);

}  // namespace dubsar
