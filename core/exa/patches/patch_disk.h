#pragma once
// A fill patch as a surface with known rims (one: a disk): triangles by a walk from the rims inwards, positions as
// differences from a relaxed membrane (docs/exa.md, "Fill patches").

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/parts/surface_model.h"

namespace dubsar {

inline constexpr double kPatchStep = 1.0 / 64.0;  ///< grid steps

/// How the third corner of the triangle on an edge of the walk's border lies.
enum class DiskStep : std::uint8_t {
  kNew,     ///< a vertex not met before
  kNext,    ///< the one behind the edge on the border
  kBefore,  ///< the one before it
  kOther,   ///< `distance` further along the border from the end of the edge, or -distance before its start; 0: `node`
};
struct DiskChoice {
  DiskStep step = DiskStep::kNew;
  std::int32_t distance = 0;
  std::uint32_t node = 0;
};

/// An edge of the border of what is not yet covered: vertex -> vertex of the next node.
struct DiskNode {
  std::uint32_t vertex = 0, next = 0, before = 0;
  bool alive = true;
};

/// What is known when a choice is coded.
struct DiskEdge {
  std::span<const DiskNode> border;
  std::uint32_t node = 0;
  std::span<const std::uint8_t> triangles_at;  ///< triangles so far at each vertex, at most 7
};

/// Covers a surface with rims of so many vertices each: these are numbered from 0 on, rim by rim, further ones as they
/// are met. A rim of 1 vertex lies inside, one of 0 is a closed piece, of which the first triangle is new; those come
/// first. `choose` is asked for each triangle; nothing: it gave up. False: the choices are none of a surface, or there
/// are more than `most` triangles, or too many steps along the border.
bool walk_disk(std::span<const std::uint32_t> rims, std::uint64_t most,
               const std::function<std::optional<DiskChoice>(const DiskEdge&)>& choose,
               std::vector<Triangle>& triangles);

/// A patch whose triangles stand in the order of the walk.
struct DiskPatch {
  std::vector<std::uint32_t> rims;  ///< vertices of each; 1: one inside, 0: a closed piece
  std::vector<std::uint32_t> rim;   ///< ids of dual vertices, rim by rim; one twice where rims touch
  std::vector<Triangle> triangles;  ///< corner < rim.size(): rim, else the vertices of the patch
};

/// A surface without tension within one rim of positions in kPatchStep / 16: the vertices behind the rim.
std::vector<std::array<std::int64_t, 3>> relaxed_disk(std::span<const std::array<std::int64_t, 3>> rim,
                                                      std::span<const Triangle> triangles, std::size_t vertices);

/// The same for any other rims: each vertex in the middle of the edge on which the walk met it, the first of a closed
/// piece at the first of the rims (0 without any).
std::vector<std::array<std::int64_t, 3>> spread_disk(std::span<const std::array<std::int64_t, 3>> rim,
                                                     std::span<const Triangle> triangles, std::size_t vertices);

/// Neighbours of the vertices behind the rim: the corner after the vertex in each of its triangles.
struct DiskNeighbours {
  std::vector<std::uint32_t> first, ids;
  DiskNeighbours(std::uint32_t rim, std::size_t vertices, std::span<const Triangle> triangles);
  std::span<const std::uint32_t> of(std::size_t inner) const {
    return std::span(ids).subspan(first[inner], first[inner + 1] - first[inner]);
  }
};

/// a / b rounded down, b > 0.
constexpr std::int64_t divided(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace dubsar
