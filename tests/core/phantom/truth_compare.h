#pragma once
// How good is a mesh of a phantom's scan? For acceptance tests.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/phantom/phantom.h"

namespace dubsar::phantom {

/// Distances of a set of vertices to the true surface, in voxels of the processed grid. The truth knows distances up
/// to Phantom::kReach input voxels; larger ones count as that.
struct DistanceScore {
  std::int64_t vertices = 0;
  double rms = 0.0, p95 = 0.0, largest = 0.0;
};

/// Areas, input voxels squared.
struct PartScore {
  double of_part = 0.0, labelled = 0.0, both = 0.0;
  double purity() const { return labelled > 0.0 ? both / labelled : 0.0; }
  double recall() const { return of_part > 0.0 ? both / of_part : 0.0; }
};

struct WedgeScore {
  int wedges = 0;           ///< of the tablet, open and on one side only (see compare())
  int kept = 0;             ///< depth within 20 %
  int missing = 0;          ///< no surface below the wedge's place
  double mean_ratio = 0.0;  ///< measured over true depth, of those found
  double kept_fraction() const { return wedges ? static_cast<double>(kept) / wedges : 0.0; }
};

struct TruthComparison {
  DistanceScore all;       ///< every vertex
  DistanceScore resolved;  ///< without pores, straw, cracks and slits
  DistanceScore pores;
  std::int64_t at_straw = 0, at_cracks = 0, at_slits = 0;
  std::array<PartScore, 2> owner;  ///< [Owner]: tablet, envelope (both its surfaces)
  std::array<PartScore, 3> part;   ///< [Part]: tablet, envelope outside, envelope inside
  WedgeScore wedges;
  std::string text() const;  ///< one line a score
};

/// A mesh in input voxel coordinates; `partition` holds one label per triangle, or is empty (then parts are not
/// judged).
struct JudgedMesh {
  std::span<const glm::vec3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the air
  std::span<const std::uint8_t> partition;
  double grid_step = 2.0;  ///< input voxels per voxel of the processed grid
};

/// Depth of every wedge as the mesh has it, from its place on the undisturbed surface to the first triangle that faces
/// outwards; infinity where there is none.
std::vector<double> wedge_depths(const Phantom& phantom, const JudgedMesh& mesh);

/// Rules:
/// - The true part of a vertex is that of the nearest true surface, that of a triangle the part of its middle. Parts
/// are
///   judged by triangles: a vertex where two parts meet belongs to both, and no label of it is right.
/// - Slits: where the gap is narrower than 1.5 voxels of the processed grid, or closed, no scan resolves both walls;
///   vertices there (within 2 such voxels of tablet or wall) count in `all`, but not in `resolved`, nor triangles for
///   the parts.
/// - Straw: the isovalue lies between straw and clay, not half-way, and cracks are thinner than a voxel: as slits.
/// - Pores count apart: their walls are judged for distance, but belong to no part.
/// - A label stands for the part that most of its judged area has; purity and recall are those of all labels that stand
///   for a part together.
/// - A wedge's depth is measured along its direction, from its place on the undisturbed surface to the first triangle
///   that faces outwards, starting 1.5 voxels (processed grid) above the place. Wedges filled with envelope clay, or
///   below a gap narrower than 1.5 voxels of the processed grid, cannot be measured and are left out.
/// Deterministic; cost about 3 us a vertex, all threads.
TruthComparison compare(const Phantom& phantom, const JudgedMesh& mesh);

}  // namespace dubsar::phantom
