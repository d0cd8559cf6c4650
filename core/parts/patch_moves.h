#pragma once
// Vertices that patches added are moved until their triangles cross nothing; places far apart by several threads.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "core/parts/crossing_pairs.h"
#include "core/parts/triangle_grid.h"

namespace dubsar {

/// Which bodies a triangle closes or belongs to.
struct TangleOwner {
  static constexpr std::uint32_t kNoPatch = 0xffffffffu;
  std::uint32_t patch = kNoPatch;  ///< none: of the surface
  PartitionId front = PartitionTable::kNone, back = PartitionTable::kNone;

  /// Whether it matters that triangles of the two cross: one is of a patch, and a body has both.
  bool matters_to(const TangleOwner& other) const;
};

/// Patches and the surface beside them as one list of triangles.
struct TangleMesh {
  std::vector<glm::vec3> positions;
  std::uint32_t first_extra = 0;  ///< from here on positions are of vertices that patches added
  std::vector<Triangle> triangles;
  std::vector<TangleOwner> owner;  ///< of each triangle

  void add_extras(std::uint32_t triangle, std::vector<std::uint32_t>& vertices) const {
    for (const std::uint32_t v : triangles[triangle])
      if (v >= first_extra) vertices.push_back(v);
  }
};

/// The nearest place whose coordinates are multiples of `step`.
glm::vec3 in_steps(const glm::vec3& place, double step);

class PatchMoves {
 public:
  /// `beside`: the triangles that moves may come to cross; all others are out of reach. Moved places are multiples of
  /// `step`. Borrows the mesh.
  PatchMoves(TangleMesh& mesh, double step, std::span<const std::uint32_t> beside);

  /// Moves vertices of the pairs and of those that they come to cross, as little as it takes. `moved`: one a position
  /// from first_extra on, and `changed`: one a triangle; set for those that are elsewhere now. The same for any thread
  /// count.
  void run(const CrossingPairs& pairs, std::span<std::uint8_t> moved, std::span<std::uint8_t> changed);

 private:
  using Group =
      std::vector<std::uint32_t>;  ///< vertices whose triangles are nowhere near those of other groups, rising
  using Homes = std::unordered_map<std::int64_t, std::uint32_t>;  ///< the group of a cube

  /// What lies around the star of a vertex, for one thread.
  struct Around {
    std::vector<std::uint32_t> near,
        star;                        ///< triangles beside the star, and those of the star among all that are near
    std::vector<TriangleBox> boxes;  ///< of near
    TriangleGrid added;              ///< where triangles have come to lie in this round
    CrossingPairs met;               ///< of the star and what lies around it, at one of the places tried or another
  };
  struct Outcome {
    std::vector<std::uint32_t> next, moved, stuck;
    std::vector<TriangleBox> boxes;  ///< of the stars that moved, before and after
  };

  std::span<const std::uint32_t> star_of(std::uint32_t v) const {
    const std::uint32_t* const first = first_.data() + (v - mesh_.first_extra);
    return std::span(star_).subspan(first[0], first[1] - first[0]);
  }
  TriangleBox star_box(std::uint32_t v) const;
  std::vector<Group> far_apart(const std::vector<std::uint32_t>& work, Homes& homes) const;
  Outcome move_group(const Group& group, std::uint32_t number, const Homes& homes);
  void look_around(std::uint32_t v, Around& around) const;
  int crossings_at(std::uint32_t v, const glm::vec3& place, int most, Around& around);
  int crossings_met(std::uint32_t v, const glm::vec3& place, int most, const Around& around);
  bool relieve(std::uint32_t v, Around& around);
  void note_stuck(const std::vector<Outcome>& outcomes);

  TangleMesh& mesh_;
  double step_;
  TriangleGrid grid_;
  std::vector<std::uint32_t> first_, star_;  ///< triangles of each vertex from first_extra on: star_[first_[v]] and on
  std::unordered_map<std::uint32_t, TriangleBox> reach_;  ///< of triangles that moved: all places where they have been
  std::vector<std::uint8_t>
      stuck_;  ///< of vertices from first_extra on: among what is near now there is no better place
};

}  // namespace dubsar
