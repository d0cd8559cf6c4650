#include "core/parts/segment.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <set>

#include "core/base/system/parallel.h"
#include "core/mesh/mesh_check.h"
#include "core/parts/face_roles.h"
#include "core/parts/fill/holes.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

using scene::Nested;

SegmentReport run_segment(SurfaceModel& model, SegmentMethod method = SegmentMethod::kNested) {
  SilentProgress progress;
  SegmentOptions options;
  options.method = method;
  auto report = segment(model, options, progress);
  EXPECT_TRUE(report.has_value()) << report.error().message;
  return *report;
}

struct Quality {
  double tablet_purity, tablet_recall, envelope_purity, envelope_recall;
  double worst() const { return std::min({tablet_purity, tablet_recall, envelope_purity, envelope_recall}); }
};

/// Counts x-quads on one of the three true surfaces: rims of contacts and walls of pores and cracks belong to
/// none.
Quality judge(const SurfaceModel& model, const Nested& scene) {
  double table[2][2] = {};
  for (std::uint32_t q = 0; q < model.mesh.quads.size(); ++q) {
    glm::vec3 c(0.0f);
    for (const std::uint32_t v : model.mesh.quads[q]) c += 0.25f * model.mesh.positions[v];
    const std::string& part = model.partitions[model.quad_partition[q]].body;
    if (part != "tablet" && part != "envelope") continue;
    if (std::min({std::abs(scene.tablet(c)), std::abs(scene.shell(c)), std::abs(scene.hollow(c))}) > 0.6f) continue;
    ++table[scene.truth(c) == 0][part == "tablet"];
  }
  return {table[1][1] / (table[1][1] + table[0][1]), table[1][1] / (table[1][1] + table[1][0]),
          table[0][0] / (table[0][0] + table[1][0]), table[0][0] / (table[0][0] + table[0][1])};
}

std::vector<std::string> names(const SurfaceModel& model) {
  std::vector<std::string> result;
  for (const Partition& p : model.partitions) result.push_back(p.name);
  return result;
}

HoleReport run_fill(SurfaceModel& model) {
  SilentProgress progress;
  auto report = fill_holes(model, {}, progress);
  EXPECT_TRUE(report.has_value()) << report.error().message;
  return *report;
}

void expect_bodies_closed(const SurfaceModel& model) {
  for (const std::string& body : model.partitions.body_names()) {
    const TriMesh mesh = make_tri_mesh(model, {.body = body}).value();
    const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
    EXPECT_TRUE(check.watertight()) << body << ": " << check.boundary_edges << " open, " << check.nonmanifold_edges
                                    << " non-manifold edges";
  }
  const TriMesh all = make_tri_mesh(model).value();
  EXPECT_TRUE(check_mesh(all.positions, all.triangles).watertight());
}

void expect_all_closed(const SurfaceModel& model) {
  for (const Partition& partition : model.partitions) EXPECT_TRUE(partition.watertight) << partition.name;
  expect_bodies_closed(model);
}

double true_tablet_volume(const Nested& scene) {
  double volume = 0.0;
  for (int z = 0; z < scene.dims.z; ++z)
    for (int y = 0; y < scene.dims.y; ++y)
      for (int x = 0; x < scene.dims.x; ++x) volume += scene.tablet(glm::vec3(x, y, z)) > 0.0f;
  return volume;
}

double true_outer_volume(const Nested& scene) {
  double volume = 0.0;
  for (int z = 0; z < scene.dims.z; ++z)
    for (int y = 0; y < scene.dims.y; ++y)
      for (int x = 0; x < scene.dims.x; ++x)
        volume += scene.shell({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}) > 0.0f ? 1.0 : 0.0;
  return volume;
}

/// Three bridges of clay across the gap, two of them large.
bool three_bridges(const glm::vec3& p) {
  return scene::ball(p, {30.0f, 51.0f, 40.0f}, 12.0f) > 0.0f || scene::ball(p, {66.0f, 10.0f, 60.0f}, 9.0f) > 0.0f ||
         scene::ball(p, {78.0f, 30.0f, 30.0f}, 8.0f) > 0.0f;
}

TEST(Segment, GluedTabletIsSeparatedAndEveryPartitionIsClosed) {
  Nested scene;
  scene.glue = three_bridges;
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  const SegmentReport report = run_segment(model);
  EXPECT_TRUE(report.nested);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.crack_radius, 0);
  EXPECT_EQ(names(model), (std::vector<std::string>{"tablet", "envelope outside", "envelope inside"}));
  EXPECT_GE(judge(model, scene).worst(), 0.99);

  const HoleReport holes = run_fill(model);
  EXPECT_EQ(holes.loops, 3);
  EXPECT_EQ(holes.unshared, 0);
  expect_all_closed(model);
  // The tablet's volume is that of the rounded box without bridges, to a few per cent.
  const double truth = true_tablet_volume(scene);
  EXPECT_NEAR(model.partitions[0].volume_mm3, truth, 0.02 * truth);
  EXPECT_LT(model.partitions[2].volume_mm3, 0.0);
}

TEST(Segment, AGapThatContactSurroundsHasTabletAndEnvelopeToo) {
  struct Ring {
    float inner, outer;
    glm::vec2 middle;  // x and z; in the second the ring runs over the rounded edge
  };
  for (const Ring& ring : {Ring{13.0f, 19.0f, {47.0f, 49.0f}}, Ring{12.0f, 17.0f, {68.0f, 51.0f}}}) {
    Nested scene;
    scene.glue = [&](const glm::vec3& p) {
      const float r = glm::distance(glm::vec2(p.x, p.z), ring.middle);
      return p.y > scene.centre.y - 8.0f && r > ring.inner && r < ring.outer;
    };
    SurfaceModel model = scene::extract_model(scene.dims, scene);
    EXPECT_TRUE(run_segment(model).nested);
    EXPECT_GE(judge(model, scene).worst(), 0.98);
    const HoleReport holes = run_fill(model);
    EXPECT_EQ(holes.loops, 1) << "one patch closes the ring";
    expect_all_closed(model);
    const MeshOptions tablet{.partition = model.partitions.find(PartitionKind::kTablet)->id};
    const TriMesh mesh = make_tri_mesh(model, tablet).value();
    const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
    EXPECT_EQ(check.components, 1);
    EXPECT_EQ(check.euler, 2);
    const double truth = true_tablet_volume(scene);
    EXPECT_NEAR(model.partitions[0].volume_mm3, truth, 0.02 * truth);
    std::int64_t far = 0, all = 0;
    for (const FillPatch& patch : model.patches)
      for (const glm::vec3& p : patch.extra_positions) {
        ++all;
        far += scene.tablet(p) > 2.0f || scene.hollow(p) < -2.0f;  // the gap is 3 steps wide
      }
    EXPECT_GT(all, 500);
    EXPECT_EQ(far, 0) << "of " << all;
  }
}

TEST(Segment, ALargePoreBesideTheGapIsNoGap) {
  for (const float height : {56.1f, 80.1f}) {  // of its middle: below and above the gap from 66.6 to 69.6
    Nested scene;
    scene.dims = {120, 96, 120};
    scene.centre = {59.3f, 47.6f, 59.8f};
    scene.outer = {55.0f, 45.0f, 55.0f};
    scene.wall = 23.0f;
    scene.glue = [](const glm::vec3& p) { return scene::ball(p, {40.0f, 68.0f, 40.0f}, 9.0f) > 0.0f; };
    const glm::vec3 middle(66.3f, height, 63.4f);
    scene.change = [&](float v, const glm::vec3& p) { return std::min(v, -scene::ball(p, middle, 9.0f)); };
    SurfaceModel model = scene::extract_model(scene.dims, scene);
    EXPECT_TRUE(run_segment(model).nested);
    std::int64_t of_pore = 0, misplaced = 0;
    for (std::uint32_t q = 0; q < model.mesh.quads.size(); ++q) {
      const glm::vec3 p = model.mesh.positions[model.mesh.quads[q][0]];
      if (glm::distance(p, middle) > 10.0f) continue;
      ++of_pore;
      misplaced += model.partitions[model.quad_partition[q]].kind != PartitionKind::kPores;
    }
    EXPECT_GT(of_pore, 800);
    EXPECT_EQ(misplaced, 0);
  }
}

TEST(Segment, TabletThatTouchesNothingIsSeparatedWithoutHoles) {
  Nested scene;
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  EXPECT_TRUE(run_segment(model).nested);
  EXPECT_EQ(judge(model, scene).worst(), 1.0);
  EXPECT_EQ(run_fill(model).loops, 0);
  expect_all_closed(model);
}

TEST(Segment, CrackThroughTheEnvelopeIsBridged) {
  for (const float width : {2.0f, 5.0f}) {
    Nested scene;
    scene.glue = three_bridges;
    scene.change = [&](float v, const glm::vec3& p) {
      const bool above = p.y > scene.centre.y && std::abs(p.z - 47.8f) < 25.0f;
      const float slit = std::abs(p.x - 47.3f) - 0.5f * width;
      return above && scene.tablet(p) < -1.5f ? std::min(v, slit) : v;
    };
    SurfaceModel model = scene::extract_model(scene.dims, scene);
    const SegmentReport report = run_segment(model);
    EXPECT_TRUE(report.nested);
    EXPECT_EQ(report.components, 1);
    EXPECT_GE(report.crack_radius, 1);
    EXPECT_EQ(names(model), (std::vector<std::string>{"tablet", "envelope outside", "envelope inside"}));
    EXPECT_GE(judge(model, scene).worst(), 0.99);
    run_fill(model);
    expect_bodies_closed(model);
    const TriMesh shell = make_tri_mesh(model, {.body = "envelope"}).value();
    EXPECT_EQ(check_mesh(shell.positions, shell.triangles).components, 1);  // nothing lies across the crack
    // Closed by cones over the crack, whose air may count as outside: it is 50 long and as deep as the wall.
    const double truth = true_outer_volume(scene), air = static_cast<double>(width) * 50.0 * double{scene.wall};
    EXPECT_GE(model.partitions[1].volume_mm3, truth - air - 0.002 * truth);
    EXPECT_LE(model.partitions[1].volume_mm3, 1.002 * truth);
    EXPECT_FALSE(model.partitions[1].watertight);
  }
}

/// A piece with the wrong role that joins the inner wall to the outermost faces, through the crack.
TEST(Segment, AWallThatReachesBeyondTheShellIsNoWallOfACavity) {
  Nested scene;
  scene.change = [&](float v, const glm::vec3& p) {
    const bool above = p.y > scene.centre.y && std::abs(p.z - 47.8f) < 25.0f;
    return above && scene.tablet(p) < -1.5f ? std::min(v, std::abs(p.x - 47.3f) - 2.5f) : v;
  };
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  SilentProgress progress;
  const FaceGraph graph = FaceGraph::build(model.mesh, progress).value();
  const FaceScene seen = observe_faces(model, graph, {}, progress).value();
  const auto roles = [&](bool with_piece) {
    std::vector<FaceRole> result;
    for (std::uint32_t q = 0; q < model.mesh.quads.size(); ++q) {
      glm::vec3 c(0.0f);
      for (const std::uint32_t v : model.mesh.quads[q]) c += 0.25f * model.mesh.positions[v];
      const int truth = scene.truth(c);
      result.push_back(truth == 0 ? FaceRole::kCore : truth == 1 ? FaceRole::kOutside : FaceRole::kInside);
      // From the crack in the middle over the top to the whole end of the outer wall.
      if (with_piece && truth == 1 && (c.x > 84.0f || (c.x > 46.0f && c.y > 20.0f && std::abs(c.z - 47.8f) < 6.0f)))
        result.back() = FaceRole::kCore;
    }
    return result;
  };
  SegmentReport report;
  EXPECT_TRUE(partition_by_roles(model, seen, {}, roles(false), role_components(model, seen, roles(false)), report));
  EXPECT_EQ(names(model).front(), "tablet");
  EXPECT_FALSE(partition_by_roles(model, seen, {}, roles(true), role_components(model, seen, roles(true)), report));
  EXPECT_EQ(names(model).front(), "object");
}

TEST(Segment, PoresAndFragmentsAreNotTheTablet) {
  Nested scene;
  scene.gap = 4.5f;
  scene.wall = 9.0f;
  scene.glue = [](const glm::vec3& p) { return scene::ball(p, {30.0f, 46.0f, 40.0f}, 12.0f) > 0.0f; };
  scene.change = [](float v, const glm::vec3& p) {
    for (const glm::vec3& pore : {glm::vec3(47, 31, 47), glm::vec3(40, 35, 60), glm::vec3(60, 30, 35)})
      v = std::min(v, -scene::ball(p, pore, 5.5f));
    return std::max(v, scene::ball(p, {16.5f, 31.0f, 47.0f}, 1.4f));
  };
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  const SegmentReport report = run_segment(model);
  EXPECT_TRUE(report.nested);
  EXPECT_EQ(report.small_pieces, 4);
  EXPECT_EQ(names(model),
            (std::vector<std::string>{"tablet", "envelope outside", "envelope inside", "pores and crumbs"}));
  EXPECT_GE(judge(model, scene).worst(), 0.99);
  run_fill(model);
  expect_all_closed(model);
}

TEST(Segment, SolidWithPoresIsOneObject) {
  const auto solid = [](const glm::vec3& p) {
    float v = scene::box(p, {31.2f, 31.7f, 31.4f}, glm::vec3(25.0f), 6.0f);
    for (int i = 0; i < 8; ++i)
      v = std::min(v, -scene::ball(p, {i & 1 ? 21.0f : 41.0f, i & 2 ? 22.0f : 42.0f, i & 4 ? 23.0f : 40.0f}, 7.0f));
    return v;
  };
  SurfaceModel model = scene::extract_model({64, 64, 64}, solid);
  const SegmentReport report = run_segment(model);
  EXPECT_FALSE(report.nested);
  EXPECT_EQ(report.components, 9);
  EXPECT_EQ(report.small_pieces, 8);
  EXPECT_EQ(names(model), (std::vector<std::string>{"object", "pores and crumbs"}));
  run_fill(model);
  expect_all_closed(model);
}

TEST(Segment, HollowBallHasNoTablet) {
  const auto hollow = [](const glm::vec3& p) {
    return std::min(scene::ball(p, glm::vec3(23.4f), 20.0f), -scene::ball(p, glm::vec3(22.0f), 12.0f));
  };
  SurfaceModel model = scene::extract_model({48, 48, 48}, hollow);
  EXPECT_FALSE(run_segment(model).nested);
  EXPECT_EQ(names(model), (std::vector<std::string>{"object", "pores and crumbs"}));
}

TEST(Segment, SeparatePiecesAreNamedByFallingVolumeAndAtMostEight) {
  const auto pieces = [](const glm::vec3& p) {
    float v = -1.0f;
    for (int i = 0; i < 10; ++i) {
      const int column = i % 4, row = i / 4;
      v = std::max(
          v,
          scene::ball(p, {12.0f + 20.0f * static_cast<float>(column), 12.0f + 20.0f * static_cast<float>(row), 12.3f},
                      9.0f - 0.6f * static_cast<float>((i * 7) % 10)));
    }
    return v;
  };
  SurfaceModel model = scene::extract_model({88, 64, 25}, pieces);
  EXPECT_EQ(run_segment(model).small_pieces, 3);
  EXPECT_EQ(model.partitions.size(), 8u);
  EXPECT_EQ(model.partitions[0].name, "object");
  EXPECT_EQ(model.partitions[6].name, "fragment 6");
  ASSERT_TRUE(measure_partitions(model).has_value());
  for (std::size_t i = 1; i < 7; ++i) EXPECT_LT(model.partitions[i].volume_mm3, model.partitions[i - 1].volume_mm3);
}

TEST(Segment, NothingAndEverythingAreNoProblem) {
  SurfaceModel empty = scene::extract_model({16, 16, 16}, [](const glm::vec3&) { return -1.0f; });
  EXPECT_FALSE(run_segment(empty).nested);
  EXPECT_TRUE(empty.quad_partition.empty());
  SurfaceModel full = scene::extract_model({16, 16, 16}, [](const glm::vec3&) { return 1.0f; });
  run_segment(full);
  EXPECT_EQ(names(full), (std::vector<std::string>{"object"}));
  run_fill(full);
  EXPECT_TRUE(full.partitions[0].watertight);
}

TEST(Segment, ConcavityMethodSeparatesTheGluedTabletToo) {
  Nested scene;
  scene.glue = three_bridges;
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  EXPECT_TRUE(run_segment(model, SegmentMethod::kConcavity).nested);
  EXPECT_GE(judge(model, scene).worst(), 0.97);
  run_fill(model);
  expect_all_closed(model);
}

TEST(Segment, ResultDoesNotDependOnThreads) {
  Nested scene;
  scene.glue = three_bridges;
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  std::vector<std::vector<std::uint8_t>> labels;
  std::vector<std::vector<Triangle>> patches;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    run_segment(model);
    run_fill(model);
    labels.push_back(model.quad_partition);
    patches.push_back(make_tri_mesh(model).value().triangles);
  }
  set_thread_count(0);
  EXPECT_EQ(labels[0], labels[1]);
  EXPECT_EQ(labels[0], labels[2]);
  EXPECT_EQ(patches[0], patches[1]);
  EXPECT_EQ(patches[0], patches[2]);
}

/// The decision is taken by segment() itself, before any hole is filled.
TEST(Segment, ABodyThatRattlesInItsCavityIsNotBelieved) {
  Nested scene;
  scene.gap = 6.5f;  // fills 0.39 of the cavity
  SurfaceModel model = scene::extract_model(scene.dims, scene);
  const SegmentReport report = run_segment(model);
  EXPECT_FALSE(report.nested);
  EXPECT_TRUE(report.enclosure_refused);
  EXPECT_EQ(report.cut_length, 0.0);
  SurfaceModel as_bodies = scene::extract_model(scene.dims, scene);
  run_segment(as_bodies, SegmentMethod::kBodies);
  EXPECT_EQ(model.quad_partition, as_bodies.quad_partition);
  EXPECT_EQ(model.partitions.size(), as_bodies.partitions.size());
  EXPECT_EQ(model.partitions.find(PartitionKind::kTablet), nullptr);
}

TEST(Segment, CancelStopsIt) {
  SurfaceModel model = scene::extract_model({96, 64, 96}, Nested{});
  SilentProgress progress;
  progress.cancel();
  EXPECT_EQ(segment(model, {}, progress).error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
