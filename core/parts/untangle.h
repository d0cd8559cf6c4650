#pragma once
// No place where a patch runs through itself or through the surface that it closes.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/triangulate.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// An edge on which a vertex was put: ids of the model's vertices, then of those that the patch added.
struct PatchSplit {
  std::uint32_t a = 0, b = 0;
};

struct UntangleReport {
  std::int64_t crossings = 0;      ///< pairs of triangles, one of a patch at least, that crossed
  std::vector<glm::vec3> left;     ///< where some still do, one for each pair: the surface crosses itself at the rim
  std::int64_t moved = 0;          ///< vertices that patches added and that were moved
  std::int64_t added = 0;          ///< vertices that had to be added to have something to move
  std::vector<PatchSplit> splits;  ///< of the first patch: where the vertices that came to its own were put, in order
};

struct UntangleHelp {
  const Triangulation* surface =
      nullptr;  ///< triangulate() of the model's mesh, without face points, where somebody has it
  /// Where the vertices that the first patch added have come from: near what still crosses they go back there
  /// (leash.h), and are moved from there once more.
  std::span<const glm::vec3> home{};
  /// One of each vertex that the first patch added, where somebody has untangled one that was almost the same: 1 where
  /// it lies as it did then. What is settled, and not near `aside`, is looked at when all else is untangled.
  std::span<const std::uint8_t> settled{};
  std::span<const glm::vec3> aside{};
};

/// Moves vertices that patches added, as little as it takes, until no triangle of a patch crosses a triangle of a body
/// that it closes (intersections.h). All positions become multiples of `step`, which is what files hold. Every
/// body stays as closed as it was. Deterministic for any thread count. kBadData as make_tri_mesh(); kCancelled. About
/// 3 us a triangle of patches and of the surface beside them.
Result<UntangleReport> untangle_patches(SurfaceModel& model, double step, Progress& progress,
                                        const UntangleHelp& help = {});

}  // namespace dubsar
