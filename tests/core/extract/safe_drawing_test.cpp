#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <string>

#include "core/extract/labelled/near_pairs.h"
#include "core/extract/labelled/taking_back.h"
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
  for (const int rounds : {0, 10})
    for (unsigned seed = 0; seed < 2; ++seed)
      expect_safe(LabelledScene(in_air(random_labels({16, 14, 18}, seed))).draw(seed + 100), "random", rounds);
  expect_safe(LabelledScene(nested_labels(32, 1.0, 5)).draw(6), "nested", 10);
  expect_safe(LabelledScene(in_air(smooth_labels({30, 30, 30}, 3))).draw(4), "smooth", 10);
}

TEST(SafeDrawing, NoTriangleTouchesAnotherInLabellingsOfACell) {
  expect_safe(LabelledScene(in_air(all_labellings(21, 3, 20))).draw(22), "every 20th labelling");
}

/// With crossings in the middle of their edges, where the last resort puts them, there is a place for all vertices.
TEST(SafeDrawing, LabellingsHaveAPlaceWithCrossingsInTheMiddle) {
  const LabelledScene scene(in_air(all_labellings(31, 7, 20)));
  const LabelledMesh labelled = scene.build();
  std::vector<glm::vec3> middles = crossings_of(labelled, *scene.samples, {});
  for (std::size_t q = 0; q < middles.size(); ++q)
    middles[q][labelled.edges[q].axis] = std::floor(middles[q][labelled.edges[q].axis]) + 0.5f;
  const SafeDrawing drawing = draw_safely(labelled, labelled.mesh.positions, middles, triangulate(labelled.mesh, {}));
  EXPECT_EQ(drawing.crossing_pairs, 0);
  EXPECT_EQ(drawing.last_resorts, 0);
}

TEST(NearPairs, AreThoseOfAllTriangles) {
  const LabelledScene scene = std::move(LabelledScene(in_air(random_labels({20, 20, 20}, 19))).draw(20));
  const LabelledMesh labelled = scene.build();
  const Triangulation cut = triangulate(labelled.mesh, {});
  const std::vector<ExactPlace> places = exact_places(all_positions(labelled.mesh, cut));
  for (const std::size_t every : {1u, 3u, 50u, 4000u}) {
    std::vector<std::uint8_t> wanted(cut.triangles.size());
    for (std::size_t t = 0; t < wanted.size(); t += every) wanted[t] = 1;
    const TrianglePairs all = touching_pairs(places, cut.triangles, wanted);
    EXPECT_TRUE(every > 3 || !all.empty());
    EXPECT_TRUE(touching_pairs_near(places, cut.triangles, wanted) == all) << every;
  }
}

TEST(SafeDrawing, WhatIsSmoothedAsOneLikesIsTakenBackUntilNothingTouches) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Labels volume = seed == 0   ? in_air(random_labels({16, 16, 16}, 9))
                          : seed == 1 ? nested_labels(40, 1.0, 10)
                                      : in_air(smooth_labels({32, 32, 32}, 11, 6.0));
    const LabelledScene scene = std::move(LabelledScene(volume).draw(seed));
    const LabelledMesh labelled = scene.build();
    const SafeDrawing drawing =
        draw_safely(labelled, labelled.mesh.positions, crossings_of(labelled, *scene.samples, scene.contact),
                    triangulate(labelled.mesh, {}));
    std::vector<ExactPlace> places = follow_vertices(drawing, exact_places(relaxed(labelled.mesh, 10)));
    EXPECT_GT(touching_pairs(places, drawing.triangles).size(), 0u) << "free smoothing crosses";
    const std::vector<ExactPlace> wanted = places;
    const TakenBack back = take_back(drawing, places);
    EXPECT_EQ(back.left, 0);
    EXPECT_TRUE(touching_pairs(places, drawing.triangles).empty());
    EXPECT_LE(back.rounds, 12);
    std::size_t moved = 0, free = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      moved += places[i] == wanted[i];
      free += places[i] != wanted[i];
      EXPECT_TRUE(places[i] == wanted[i] || places[i] == drawing.places[i]);
    }
    EXPECT_TRUE(seed == 0 || moved > 4 * free);
    RecordProperty(std::to_string(seed), std::to_string(back.rounds) + " rounds, " + std::to_string(free) + " points");
  }
}

// --- The whole of it: half an hour of pairs of labels and surroundings in a minute (label long).

TEST(SafeDrawingWhole, EveryLabellingOfACellIsManifoldAndTouchesNothing) {
  for (unsigned part = 0; part < 6; ++part)
    expect_safe(LabelledScene(in_air(all_labellings(41, part, 6))).draw(42 + part), "every labelling");
}

TEST(SafeDrawingWhole, DrawnSmoothAndNestedVolumesTouchNothing) {
  for (const int rounds : {0, 10}) {
    const DrawnCounts random =
        expect_safe(LabelledScene(in_air(random_labels({30, 30, 30}, 1))).draw(101), "random", rounds);
    const DrawnCounts airy =
        expect_safe(LabelledScene(in_air(random_labels({46, 46, 46}, 2, {2, 1, 1}))).draw(102), "half air", rounds);
    const DrawnCounts smooth =
        expect_safe(LabelledScene(in_air(smooth_labels({62, 62, 62}, 3))).draw(103), "smooth", rounds);
    const DrawnCounts nested = expect_safe(LabelledScene(nested_labels(96, 0.3, 4)).draw(104), "nested .3", rounds);
    const DrawnCounts rough = expect_safe(LabelledScene(nested_labels(128, 1.0, 5)).draw(105), "nested 1", rounds);
    for (const DrawnCounts& c : {random, airy, smooth, nested, rough})
      printf("%lld triangles, %lld cells moved, %lld last resorts, %lld face and %lld edge points, %lld fans of four\n",
             static_cast<long long>(c.triangles), static_cast<long long>(c.hard), static_cast<long long>(c.last),
             static_cast<long long>(c.faces), static_cast<long long>(c.edges), static_cast<long long>(c.fans));
  }
}

}  // namespace
}  // namespace dubsar
