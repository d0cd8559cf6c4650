#pragma once
// Do two triangles have more in common than the corners that they share? In integers: the answer is exact for the
// places as they are rounded, and touching counts.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A place in units of 2^-10 grid step.
using ExactPlace = glm::i64vec3;

/// Steps of the lattice of places in a grid step. Floats hold it exactly up to 8,191 grid steps, where their own
/// spacing is half of it.
inline constexpr std::int64_t kExactSteps = 1024;

/// The place nearest to a point in grid coordinates; halves go up. `point` is finite, below 2^40 in magnitude.
inline ExactPlace exact_place(const glm::vec3& point) noexcept {
  ExactPlace place;
  for (int i = 0; i < 3; ++i) {
    const double x = static_cast<double>(point[i]) * static_cast<double>(kExactSteps) + 0.5;
    place[i] = static_cast<std::int64_t>(x);  // std::floor() is a call on processors of old
    place[i] -= x < static_cast<double>(place[i]);
  }
  return place;
}
std::vector<ExactPlace> exact_places(std::span<const glm::vec3> points);

/// The sign (-1, 0, 1) of the volume of a tetrahedron: 1 where d is on the side of abc from which a, b, c run
/// counter-clockwise. Coordinates may differ by 2^40 at most; up to 2^20 (1,024 grid steps) it takes 64 bits.
int orientation(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c, const ExactPlace& d) noexcept;

/// True where the corners lie on one line or in one place.
bool has_zero_area(const ExactPlace& a, const ExactPlace& b, const ExactPlace& c) noexcept;

/// True where a segment and a triangle, both with their ends and sides and both maybe flat, have a point in common.
bool segment_meets_triangle(const ExactPlace& from, const ExactPlace& to,
                            const std::array<ExactPlace, 3>& triangle) noexcept;

/// A triangle of its own: corners with equal ids are the same corner.
struct ExactTriangle {
  std::array<ExactPlace, 3> place;
  std::array<std::uint64_t, 3> id;
};

/// True where two triangles have a point in common that is not one of what their ids share: for
/// triangles without a common id any point; with one id any but that corner; with two ids any that is not on that side
/// (they fold onto each other); with three always. About 50 ns where their boxes meet, 10 where not.
bool triangles_touch(const ExactTriangle& a, const ExactTriangle& b) noexcept;
/// The same for triangles of one list of places.
bool triangles_touch(std::span<const ExactPlace> places, const Triangle& a, const Triangle& b) noexcept;

}  // namespace dubsar
