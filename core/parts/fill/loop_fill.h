#pragma once
// Triangles for one closed loop (Barequet and Sharir 1995; Liepa 2003): an optimal triangulation of the loop,
// then refinement to the density of the rim and fairing.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct LoopFillOptions {
  int exact_limit = 256;    ///< loops with more vertices are first cut down to a coarse loop of this many
  bool refine = true;       ///< add vertices inside (Liepa section 4) ...
  float growth = 1.15f;     ///< ... whose spacing grows by this factor with every generation
  int fairing_steps = 200;  ///< at most, of each relaxation: to a membrane, then along the rim's normals; 0: none
};

struct Loop {
  std::vector<glm::vec3> positions;    ///< triangles will run along positions[i] -> positions[i + 1]
  std::vector<glm::vec3> rim_normals;  ///< unit normal of the surface beyond edge i -> i + 1, which the fill
                                       ///< should continue; empty: not known
  /// True when an edge between two loop vertices that are not neighbours in the loop exists elsewhere in the
  /// mesh and must not be made again. Empty: none does.
  std::function<bool(std::uint32_t, std::uint32_t)> forbidden;
};

struct LoopFill {
  std::vector<Triangle> triangles;  ///< id < n: loop vertex; else added[id - n]
  std::vector<glm::vec3> added;
  double area = 0.0;
  bool star = false;  ///< somewhere every triangulation needs a forbidden edge: a fan around a new vertex there
};

/// Always succeeds for a loop of at least 3 distinct vertices: a disk with the loop as its border, every
/// inner edge used twice. O(m^3) time and O(m^2) memory, m = min(n, exact_limit), plus O(n) for the rest.
/// Only error: cancelled.
Result<LoopFill> fill_loop(const Loop& loop, const LoopFillOptions& options, Progress& progress);

}  // namespace dubsar
