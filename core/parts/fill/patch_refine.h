#pragma once
// A triangulated loop while it is refined and faired (Liepa 2003, section 4).

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_set>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/fill/loop_fill.h"

namespace dubsar {

class Patch {
 public:
  /// `triangles` fill the loop; ids from its number of vertices on are `added`. The loop must outlive the patch.
  Patch(const Loop& loop, std::vector<Triangle> triangles, std::vector<glm::vec3> added);

  /// Puts vertices into triangles that are large compared with the spacing of their corners, and flips edges
  /// that are not Delaunay, until nothing changes. Edges between loop vertices that exist elsewhere are never
  /// made.
  Result<void> refine(float growth, Progress& progress);

  /// Moves added vertices to the mean of their neighbours until they rest (a membrane spanned by the loop).
  Result<void> relax(int steps, Progress& progress);

  /// Bends the membrane so that it continues the surface beyond the rim: normals are interpolated from the rim by a
  /// harmonic map to the unit sphere, as those of a ball are, then vertices move along them until edges lie across
  /// them. Where it bends far, refine() and once more comes nearer. Without rim normals nothing happens.
  Result<void> continue_surface(int steps, Progress& progress);

  void release(std::vector<Triangle>& triangles, std::vector<glm::vec3>& added) &&;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
  }
  void find_spacing();
  std::vector<std::vector<std::uint32_t>> inner_neighbours() const;
  bool split(std::uint32_t triangle, float growth);
  bool flip_if_better(std::uint32_t triangle, std::size_t side);
  bool may_join(std::uint32_t a, std::uint32_t b) const;
  glm::vec3 area_vector(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  void replace_neighbour(std::uint32_t triangle, std::uint32_t old_one, std::uint32_t new_one);

  const Loop& loop_;
  std::uint32_t rim_;  ///< vertices of the loop
  std::vector<glm::vec3> positions_;
  std::vector<float> spacing_;  ///< wanted distance to neighbours
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 3>> across_;  ///< triangle beyond side corner i -> i + 1
  std::unordered_set<std::uint64_t> edges_;
};

}  // namespace dubsar
