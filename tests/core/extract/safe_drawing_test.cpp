#include "core/extract/safe_drawing.h"

#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <string>

#include "core/extract/quad_envelope.h"
#include "core/mesh/exact_crossings.h"
#include "tests/core/extract/labelled_help.h"

namespace dubsar {
namespace {

std::vector<glm::vec3> grid_positions(const SafeDrawing& drawing) {
  std::vector<glm::vec3> positions(drawing.places.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = glm::vec3(drawing.places[i]) / static_cast<float>(kExactSteps);
  return positions;
}

/// Vertices moved to the mean of their neighbours along polygon sides, so many times: out of their cells, too.
std::vector<glm::vec3> relaxed(const QuadMesh& mesh, int rounds) {
  std::vector<glm::vec3> now = mesh.positions;
  for (int k = 0; k < rounds; ++k) {
    std::vector<glm::vec4> sum(now.size(), glm::vec4(0.0f));
    for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
      const Polygon polygon = mesh.polygon(q);
      const auto n = static_cast<std::size_t>(polygon.size);
      for (std::size_t i = 0; i < n; ++i) {
        sum[polygon.vertex[i]] += glm::vec4(now[polygon.vertex[(i + 1) % n]], 1.0f);
        sum[polygon.vertex[(i + 1) % n]] += glm::vec4(now[polygon.vertex[i]], 1.0f);
      }
    }
    for (std::size_t v = 0; v < now.size(); ++v) now[v] = glm::vec3(sum[v]) / sum[v].w;
  }
  return now;
}

struct DrawnCounts {
  std::int64_t triangles = 0, hard = 0, last = 0, faces = 0, edges = 0, fans = 0;
};

DrawnCounts expect_safe(const LabelledScene& scene, const std::string& what, int rounds = 0) {
  const LabelledMesh labelled = scene.build();
  const SafeDrawing drawing =
      draw_safely(labelled, relaxed(labelled.mesh, rounds), crossings_of(labelled, *scene.samples, scene.contact),
                  triangulate(labelled.mesh, {}));
  const std::vector<glm::vec3> positions = grid_positions(drawing);
  expect_closed_manifolds(labelled, positions, drawing.triangles, drawing.first_triangle);
  EXPECT_EQ(touching_pairs(drawing.places, drawing.triangles).size(), 0u) << what;
  std::int64_t flat = 0;
  for (const Triangle& t : drawing.triangles)
    flat += has_zero_area(drawing.places[t[0]], drawing.places[t[1]], drawing.places[t[2]]);
  EXPECT_EQ(flat, 0) << what;
  EXPECT_EQ(drawing.crossing_pairs, 0) << what;
  return {static_cast<std::int64_t>(drawing.triangles.size()),
          drawing.hard_cells,
          drawing.last_resorts,
          drawing.face_points,
          drawing.edge_points,
          drawing.fans_of_four};
}

TEST(SafeDrawing, NoTriangleTouchesAnotherWhateverTheLabels) {
  for (const int rounds : {0, 10}) {
    for (unsigned seed = 0; seed < 3; ++seed) {
      const DrawnCounts c =
          expect_safe(LabelledScene(in_air(random_labels({30, 30, 30}, seed))).draw(seed + 100), "random", rounds);
      printf("random %u rounds %d: %ld triangles hard %ld last %ld f %ld x %ld fans4 %ld\n", seed, rounds, c.triangles,
             c.hard, c.last, c.faces, c.edges, c.fans);
    }
    expect_safe(LabelledScene(nested_labels(40, 1.0, 5)).draw(6), "nested", rounds);
    const DrawnCounts c = expect_safe(LabelledScene(in_air(smooth_labels({48, 48, 48}, 3))).draw(4), "smooth", rounds);
    printf("smooth: %ld triangles hard %ld last %ld f %ld x %ld fans4 %ld\n", c.triangles, c.hard, c.last, c.faces,
           c.edges, c.fans);
  }
}

TEST(SafeDrawing, NoTriangleTouchesAnotherInAnyLabellingOfACell) {
  const DrawnCounts c = expect_safe(LabelledScene(in_air(all_labellings(21))).draw(22), "all labellings");
  printf("all: %ld triangles hard %ld last %ld f %ld x %ld fans4 %ld\n", c.triangles, c.hard, c.last, c.faces, c.edges,
         c.fans);
}

}  // namespace
}  // namespace dubsar
