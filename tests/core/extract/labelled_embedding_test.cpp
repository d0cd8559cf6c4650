// The mesh of labels is cut as any other (quad_cuts.h): while its vertices lie in their cells no triangle of any part
// touches another.

#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <string>

#include "core/extract/cell_box.h"
#include "core/extract/piece_moves.h"
#include "core/mesh/exact_crossings.h"
#include "tests/core/extract/labelled_help.h"

namespace dubsar {
namespace {

/// Vertices moved to the mean of their neighbours along polygon sides, so many times, inside their cells.
void relax_in_cells(QuadMesh& mesh, int rounds) {
  const std::vector<glm::vec3> start = mesh.positions;
  for (int k = 0; k < rounds; ++k) {
    std::vector<glm::vec4> sum(start.size(), glm::vec4(0.0f));
    for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
      const Polygon polygon = mesh.polygon(q);
      const auto n = static_cast<std::size_t>(polygon.size);
      for (std::size_t i = 0; i < n; ++i) {
        sum[polygon.vertex[i]] += glm::vec4(mesh.positions[polygon.vertex[(i + 1) % n]], 1.0f);
        sum[polygon.vertex[(i + 1) % n]] += glm::vec4(mesh.positions[polygon.vertex[i]], 1.0f);
      }
    }
    for (std::size_t v = 0; v < start.size(); ++v)
      mesh.positions[v] = kept_in_cell(start[v], glm::vec3(sum[v]) / sum[v].w);
  }
}

struct Embedded {
  std::int64_t triangles = 0, touching = 0, moved = 0, left = 0, pairs = 0, added = 0;
};

Embedded expect_embedded(const LabelledScene& scene, const std::string& what, int rounds = 0) {
  BuiltMesh labelled = scene.build();
  EXPECT_TRUE(labelled.mesh.embedded);
  const std::vector<glm::vec3> safe = labelled.mesh.positions;
  relax_in_cells(labelled.mesh, rounds);
  const PieceMoves moves =
      part_pieces(labelled.mesh, safe, [](std::uint32_t, const glm::vec3& wanted) { return wanted; });
  EXPECT_EQ(moves.left, 0) << what;
  const Triangulation cut = triangulate(labelled.mesh, {});
  const std::vector<glm::vec3> positions = all_positions(labelled.mesh, cut);
  expect_closed_manifolds(labelled, positions, cut.triangles, cut.first_triangle);
  const std::vector<ExactPlace> places = exact_places(positions);
  const auto pairs = static_cast<std::int64_t>(touching_pairs(places, cut.triangles).size());
  EXPECT_EQ(pairs, 0) << what << ", of " << cut.triangles.size();
  std::int64_t flat = 0;
  for (const Triangle& t : cut.triangles) flat += has_zero_area(places[t[0]], places[t[1]], places[t[2]]);
  EXPECT_EQ(flat, 0) << what;
  return {static_cast<std::int64_t>(cut.triangles.size()), moves.touching, moves.moved, moves.left, pairs,
          static_cast<std::int64_t>(cut.steiner.size())};
}

TEST(LabelledEmbedding, NoTriangleTouchesAnotherWhateverTheLabels) {
  for (const int rounds : {0, 10})
    for (unsigned seed = 0; seed < 2; ++seed)
      expect_embedded(LabelledScene(in_air(random_labels({16, 14, 18}, seed))).draw(seed + 100), "random", rounds);
  expect_embedded(LabelledScene(nested_labels(32, 1.0, 5)).draw(6), "nested", 10);
  expect_embedded(LabelledScene(in_air(smooth_labels({30, 30, 30}, 3))).draw(4), "smooth", 10);
}

TEST(LabelledEmbedding, NoTriangleTouchesAnotherInLabellingsOfACell) {
  expect_embedded(LabelledScene(in_air(all_labellings(21, 3, 20))).draw(22), "every 20th labelling");
}

// --- The whole of it (label long).

TEST(LabelledEmbeddingWhole, EveryLabellingOfACellTouchesNothing) {
  for (unsigned part = 0; part < 6; ++part)
    expect_embedded(LabelledScene(in_air(all_labellings(41, static_cast<int>(part), 6))).draw(42 + part),
                    "every labelling");
}

TEST(LabelledEmbeddingWhole, DrawnSmoothAndNestedVolumesTouchNothing) {
  for (const int rounds : {0, 10})
    for (const Embedded& e :
         {expect_embedded(LabelledScene(in_air(random_labels({30, 30, 30}, 1))).draw(101), "random", rounds),
          expect_embedded(LabelledScene(in_air(random_labels({46, 46, 46}, 2, {2, 1, 1}))).draw(102), "half air",
                          rounds),
          expect_embedded(LabelledScene(in_air(smooth_labels({62, 62, 62}, 3))).draw(103), "smooth", rounds),
          expect_embedded(LabelledScene(nested_labels(96, 0.3, 4)).draw(104), "nested .3", rounds),
          expect_embedded(LabelledScene(nested_labels(128, 1.0, 5)).draw(105), "nested 1", rounds)})
      printf("%lld triangles, %lld cells touched, %lld vertices moved, %lld points added\n",
             static_cast<long long>(e.triangles), static_cast<long long>(e.touching), static_cast<long long>(e.moved),
             static_cast<long long>(e.added));
}

}  // namespace
}  // namespace dubsar
