#pragma once
// Does a mesh cross or touch itself, and has it triangles without area? By the exact predicates of exact_triangles.h.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/exact_triangles.h"
#include "core/mesh/triangle_tree.h"

namespace dubsar {

/// Pairs of triangles that touch (triangles_touch()), the lower first, rising. `wanted`: one a triangle, or empty for
/// all; only pairs of which one at least is not 0. All threads, deterministic; about 1 us a wanted triangle and thread.
TrianglePairs touching_pairs(std::span<const ExactPlace> places, std::span<const Triangle> triangles,
                             std::span<const std::uint8_t> wanted = {});

struct ExactCheck {
  std::int64_t crossing_pairs = 0;
  std::int64_t zero_area_triangles = 0;
  friend bool operator==(const ExactCheck&, const ExactCheck&) = default;
};

/// Both for positions in grid coordinates, rounded to places.
ExactCheck check_exactly(std::span<const glm::vec3> positions, std::span<const Triangle> triangles);

}  // namespace dubsar
