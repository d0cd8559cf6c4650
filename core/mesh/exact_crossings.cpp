#include "core/mesh/exact_crossings.h"

#include "core/base/system/parallel.h"

namespace dubsar {

TrianglePairs touching_pairs(std::span<const ExactPlace> places, std::span<const Triangle> triangles,
                             std::span<const std::uint8_t> wanted) {
  return pairs_that_cross(places, triangles, wanted, [&](std::uint32_t a, std::uint32_t b) {
    return triangles_touch(places, triangles[a], triangles[b]);
  });
}

ExactCheck check_exactly(std::span<const glm::vec3> positions, std::span<const Triangle> triangles) {
  const std::vector<ExactPlace> places = exact_places(positions);
  ExactCheck check;
  check.crossing_pairs = static_cast<std::int64_t>(touching_pairs(places, triangles).size());
  check.zero_area_triangles = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), 1 << 14, std::int64_t{0},
      [&](std::int64_t begin, std::int64_t end) {
        std::int64_t flat = 0;
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t)
          flat += has_zero_area(places[triangles[t][0]], places[triangles[t][1]], places[triangles[t][2]]);
        return flat;
      },
      [](std::int64_t a, std::int64_t b) { return a + b; });
  return check;
}

}  // namespace dubsar
