#pragma once
// Triangles for one hole (Barequet and Sharir 1995; Liepa 2003): an optimal triangulation of the loop around it, then
// refinement to the density of the rim and fairing.

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
  int bends = 4;            ///< so often along the rim's normals: where it has bent, it is refined anew
};

struct Loop {
  std::vector<glm::vec3> positions;  ///< each vertex of the loop once
  /// The vertices in the order in which triangles will run along them; empty: as they are. Where several rims bound the
  /// hole, it goes from one to the next over a bridge and comes back the same way.
  std::vector<std::uint32_t> walk;
  std::vector<glm::vec3> rim_normals;  ///< unit normal of the surface beyond each step of the walk, which the fill
                                       ///< should continue, 0 on bridges; empty: not known
  /// True when an edge between two loop vertices that are not neighbours in the loop exists elsewhere in the
  /// mesh and must not be made again. Empty: none does.
  std::function<bool(std::uint32_t, std::uint32_t)> forbidden;

  std::size_t steps() const noexcept { return walk.empty() ? positions.size() : walk.size(); }
  /// From which vertex step i of the walk starts.
  std::uint32_t vertex(std::size_t i) const { return walk.empty() ? static_cast<std::uint32_t>(i) : walk[i]; }
  bool may_join(std::uint32_t a, std::uint32_t b) const { return a != b && !(forbidden && forbidden(a, b)); }
};

struct LoopFill {
  std::vector<Triangle> triangles;  ///< id < n: loop vertex; else added[id - n]
  std::vector<glm::vec3> added;
  double area = 0.0;
  bool star = false;     ///< somewhere every triangulation needs a forbidden edge: a fan around a new vertex there
  bool doubled = false;  ///< only with bridges: it uses an edge more often than twice, and is no surface
};

/// Always succeeds for a loop of at least 3 distinct vertices: a disk with the loop as its border, every
/// inner edge used twice, or a disk with one hole for each bridge. O(m^3) time and O(m^2) memory, m = min(n,
/// exact_limit), plus O(n) for the rest. Only error: cancelled.
Result<LoopFill> fill_loop(const Loop& loop, const LoopFillOptions& options, Progress& progress);

}  // namespace dubsar
