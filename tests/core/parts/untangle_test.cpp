#include "core/parts/untangle.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"
#include "core/mesh/intersections.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/fill/holes.h"
#include "core/parts/leash.h"
#include "core/parts/segment.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

constexpr double kStep = 1.0 / 64.0;

/// A tablet that is glued to its envelope at two places, with patches there.
SurfaceModel glued() {
  scene::Nested nested;
  nested.glue = [](const glm::vec3& p) {
    return (p.y < 22.0f && std::hypot(p.x - 40.0f, p.z - 47.0f) < 9.0f) ||
           (p.y > 42.0f && std::hypot(p.x - 55.0f, p.z - 40.0f) < 7.0f);
  };
  nested.change = [nested](float v, const glm::vec3& p) { return std::min(v, nested.shell(p)); };
  SurfaceModel model = scene::extract_model(nested.dims, nested);
  SilentProgress progress;
  const FaceGraph graph = FaceGraph::build(model.mesh, progress).value();
  segment(model, graph, {}, progress).value();
  fill_holes(model, graph, {}, progress).value();
  return model;
}

/// Crossings of patches in the bodies as they are exported: shares no code with what moves vertices.
std::int64_t crossings(const SurfaceModel& model) {
  std::int64_t count = 0;
  for (const char* body : {"tablet", "envelope"}) {
    const TriMesh mesh = make_tri_mesh(model, {.body = body}).value();
    const auto of_patch = [&](std::uint32_t t) { return !mesh.triangle_inferred.empty() && mesh.triangle_inferred[t]; };
    for (const auto& [a, b] : self_intersections(mesh.positions, mesh.triangles)) count += of_patch(a) || of_patch(b);
  }
  return count;
}

/// Patch vertices thrown about: through the surface and through each other.
void throw_about(SurfaceModel& model, unsigned seed, float reach) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> any(-reach, reach);
  for (FillPatch& patch : model.patches)
    for (glm::vec3& p : patch.extra_positions)
      if (random() % 6 == 0) p += glm::vec3(any(random), any(random), any(random));
}

/// One place of the first patch, so far that moving alone does not mend it.
void throw_far(SurfaceModel& model) {
  std::mt19937 random(21);
  std::uniform_real_distribution<float> any(-18.0f, 18.0f);
  const glm::vec3 place = model.patches[0].extra_positions.front();
  for (glm::vec3& p : model.patches[0].extra_positions)
    if (glm::distance(p, place) < 11.0f) p += glm::vec3(any(random), any(random), any(random));
}

TEST(Untangle, PatchesThatRunThroughTheSurfaceAreTakenOut) {
  SurfaceModel model = glued();
  ASSERT_GE(model.patches.size(), 2u);
  for (const unsigned seed : {5u, 6u}) {
    throw_about(model, seed, 4.0f);
    ASSERT_GT(crossings(model), 20) << "nothing to do";
    SilentProgress progress;
    const UntangleReport report = untangle_patches(model, kStep, progress).value();
    EXPECT_GT(report.crossings, 0);
    EXPECT_TRUE(report.left.empty());
    EXPECT_GT(report.moved, 0);
    EXPECT_EQ(crossings(model), 0);
    for (const char* body : {"tablet", "envelope"}) {
      const TriMesh mesh = make_tri_mesh(model, {.body = body}).value();
      EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight()) << body;
    }
  }
}

TEST(Untangle, VerticesNearACrossingAreTied) {
  const std::vector<glm::vec3> points{{10, 10, 10}, {11.4f, 10, 10}, {12.75f, 10, 10}, {14.1f, 10, 10}, {-40, 3, 9}};
  const std::vector<float> free = leashes(points, std::vector<glm::vec3>{{10, 10, 10}, {90, 90, 90}});
  const std::vector<float> expected{0.0f, 0.0f, 0.5f, 1.0f, 1.0f};
  EXPECT_EQ(free, expected);
  EXPECT_EQ(leashes(points, {}), std::vector<float>(points.size(), 1.0f));
}

TEST(Untangle, WhatCannotBeTakenOutGoesBackToWhereItCameFrom) {
  SurfaceModel thrown = glued();
  const std::vector<glm::vec3> home = thrown.patches[0].extra_positions;
  throw_far(thrown);
  SurfaceModel lost = thrown;
  SilentProgress progress;
  ASSERT_GT(untangle_patches(lost, kStep, progress).value().left.size(), 10u) << "nothing to do";
  EXPECT_TRUE(untangle_patches(thrown, kStep, progress, {.home = home}).value().left.empty());
  EXPECT_EQ(crossings(thrown), 0);
  for (const char* body : {"tablet", "envelope"}) {
    const TriMesh mesh = make_tri_mesh(thrown, {.body = body}).value();
    EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight()) << body;
  }
}

TEST(Untangle, OnlyWhatIsNotSettledIsLookedAtFirstAndAllOfItInTheEnd) {
  SurfaceModel model = glued();
  SilentProgress progress;
  untangle_patches(model, kStep, progress).value();
  const std::vector<glm::vec3> before = model.patches[0].extra_positions;
  std::vector<std::uint8_t> settled(before.size(), 1);
  const UntangleReport nothing = untangle_patches(model, kStep, progress, {.settled = settled}).value();
  EXPECT_EQ(nothing.crossings, 0);
  EXPECT_EQ(model.patches[0].extra_positions, before);
  for (const bool told : {true, false}) {
    SurfaceModel thrown = model;
    std::mt19937 random(4);
    std::uniform_real_distribution<float> any(-4.0f, 4.0f);
    for (std::size_t i = 0; i < before.size(); ++i) {
      settled[i] = 1;
      if (glm::distance(before[i], before[7]) > 6.0f) continue;
      thrown.patches[0].extra_positions[i] += glm::vec3(any(random), any(random), any(random));
      settled[i] = told ? 0 : 1;
    }
    ASSERT_GT(crossings(thrown), 5);
    const UntangleReport report = untangle_patches(thrown, kStep, progress, {.settled = settled}).value();
    EXPECT_GT(report.moved, 0) << told;
    EXPECT_EQ(report.crossings > 0, told) << "a wrong word is found out in the end";
    EXPECT_EQ(static_cast<std::int64_t>(report.left.size()), crossings(thrown)) << told;
    if (told) {
      EXPECT_TRUE(report.left.empty());
    }
  }
}

TEST(Untangle, SplitsSayWhichEdgesTheAddedVerticesLieOn) {
  SurfaceModel model = glued();
  throw_far(model);
  const FillPatch before = model.patches[0];
  SilentProgress progress;
  const UntangleReport report = untangle_patches(model, kStep, progress).value();
  const FillPatch& after = model.patches[0];
  ASSERT_GT(report.splits.size(), 0u);
  ASSERT_EQ(after.extra_positions.size(), before.extra_positions.size() + report.splits.size());
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  std::vector<Triangle> triangles = before.triangles;  // split in the same way once more
  for (std::size_t k = 0; k < report.splits.size(); ++k) {
    const auto [a, b] = report.splits[k];
    const auto middle = dual + static_cast<std::uint32_t>(before.extra_positions.size() + k);
    int sides = 0;
    for (std::size_t t = 0, count = triangles.size(); t < count; ++t) {
      if (std::count(triangles[t].begin(), triangles[t].end(), a) +
              std::count(triangles[t].begin(), triangles[t].end(), b) <
          2)
        continue;
      ++sides;
      Triangle other = triangles[t];
      std::replace(triangles[t].begin(), triangles[t].end(), a, middle);
      std::replace(other.begin(), other.end(), b, middle);
      triangles.push_back(other);
    }
    ASSERT_EQ(sides, 2) << k;
  }
  const auto sorted = [](std::vector<Triangle> list) {
    for (Triangle& t : list) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(list.begin(), list.end());
    return list;
  };
  EXPECT_EQ(sorted(triangles), sorted(after.triangles));
}

TEST(Untangle, WhatCrossesNothingStaysWhereItIs) {
  SurfaceModel model = glued();
  SilentProgress progress;
  untangle_patches(model, kStep, progress).value();
  const std::vector<glm::vec3> before = model.patches[0].extra_positions;
  const UntangleReport report = untangle_patches(model, kStep, progress).value();
  EXPECT_EQ(report.crossings, 0);
  EXPECT_EQ(report.moved, 0);
  EXPECT_EQ(model.patches[0].extra_positions, before);
}

TEST(Untangle, ThreadsDoNotChangeTheResult) {
  std::vector<std::vector<FillPatch>> found;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    SurfaceModel model = glued();
    throw_about(model, 11, 3.0f);
    SilentProgress progress;
    const UntangleReport report = untangle_patches(model, kStep, progress).value();
    EXPECT_GT(report.moved, 0);
    found.push_back(model.patches);
  }
  set_thread_count(0);
  ASSERT_GT(found[0].size(), 1U) << "places far apart";
  for (std::size_t run = 1; run < found.size(); ++run)
    for (std::size_t p = 0; p < found[0].size(); ++p) {
      EXPECT_EQ(found[0][p].extra_positions, found[run][p].extra_positions);
      EXPECT_EQ(found[0][p].triangles, found[run][p].triangles);
    }
}

}  // namespace
}  // namespace dubsar
