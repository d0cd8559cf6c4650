#include "core/parts/surface_model.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "core/extract/triangulate.h"
#include "core/mesh/evidence.h"
#include "core/mesh/mesh_check.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

/// Two balls that overlap, labelled by the side of the plane x = 20: part 0 left, part 1 right.
SurfaceModel two_balls() {
  SurfaceModel model = scene::extract_model({41, 24, 24}, [](const glm::vec3& p) {
    return std::max(scene::ball(p, {13.3f, 11.5f, 11.6f}, 9.0f), scene::ball(p, {27.1f, 11.4f, 11.2f}, 9.0f));
  });
  model.partitions = {{.id = 0, .name = "left", .body = ""}, {.id = 1, .name = "right", .body = ""}};
  for (const auto& q : model.mesh.quads) {
    float x = 0.0f;
    for (const std::uint32_t v : q) x += 0.25f * model.mesh.positions[v].x;
    model.quad_partition.push_back(x > 20.0f);
  }
  model.frame.input_voxel = {{0.1, 0.2, 0.3}, "test"};
  model.frame.scale = {2.0, 2.0, 2.0};
  return model;
}

TEST(SurfaceModel, WholeMeshWithoutPartitionsIsClosedAndOne) {
  SurfaceModel model = two_balls();
  model.partitions.clear();
  model.quad_partition.clear();
  const TriMesh mesh = make_tri_mesh(model).value();
  const MeshCheck check = check_mesh(mesh.positions, mesh.triangles);
  EXPECT_TRUE(check.watertight());
  EXPECT_EQ(check.euler, 2);
  EXPECT_EQ(mesh.positions.size(), model.mesh.positions.size());
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_TRUE(mesh.ao.empty());
}

TEST(SurfaceModel, PointsOnFacesBelongToBothPartsAndToPatchesAlongThem) {
  std::mt19937 bits(91);
  SurfaceModel model = scene::extract_model({30, 30, 30}, [&](const glm::vec3& p) {
    const bool border = std::min({p.x, p.y, p.z}) < 0.5f || std::max({p.x, p.y, p.z}) > 28.5f;
    return border ? -1.0f : static_cast<float>(bits() >> 8) * 0x1p-24f - 0.5f;
  });
  model.patches.clear();
  const Triangulation cut = triangulate(model.mesh, model.attributes.normals);
  ASSERT_FALSE(cut.face_points.empty());
  const FacePoint& point = cut.face_points[cut.face_points.size() / 2];
  const float middle = static_cast<float>(point.place.x) / 1024.0f;  // the cut passes it
  model.partitions = {{.id = 0, .name = "left", .body = ""}, {.id = 1, .name = "right", .body = ""}};
  for (const auto& q : model.mesh.quads) model.quad_partition.push_back(model.mesh.positions[q[0]].x > middle);
  std::array<std::int64_t, 2> border{};
  std::size_t triangles = 0;
  for (const PartitionId id : {PartitionId{0}, PartitionId{1}}) {
    const TriMesh part = make_tri_mesh(model, {.partition = id}).value();
    const MeshCheck check = check_mesh(part.positions, part.triangles);
    EXPECT_TRUE(check.manifold());
    border[id] = check.boundary_edges;
    triangles += part.triangles.size();
  }
  EXPECT_GT(border[0], 0);
  EXPECT_EQ(border[0], border[1]);
  EXPECT_EQ(triangles, cut.triangles.size());
  const auto vertices = static_cast<std::uint32_t>(model.mesh.positions.size());
  model.patches.push_back(
      {.partition = 0, .extra_positions = {{1, 2, 3}}, .triangles = {{point.b, point.a, vertices}}});
  EXPECT_EQ(make_tri_mesh(model, {.partition = PartitionId{0}}).value().triangles.size() +
                make_tri_mesh(model, {.partition = PartitionId{1}}).value().triangles.size(),
            triangles + 2);
}

TEST(SurfaceModel, PartsShareNoVertexAndEachKeepsItsBorder) {
  SurfaceModel model = two_balls();
  const TriMesh all = make_tri_mesh(model).value();
  const MeshCheck whole = check_mesh(all.positions, all.triangles);
  EXPECT_TRUE(whole.manifold());
  EXPECT_EQ(whole.components, 2);
  std::vector<PartitionId> owner(all.positions.size(), PartitionTable::kNone);
  for (std::size_t t = 0; t < all.triangles.size(); ++t)
    for (const std::uint32_t v : all.triangles[t]) {
      EXPECT_TRUE(owner[v] == PartitionTable::kNone || owner[v] == all.partition_of(t));
      owner[v] = all.partition_of(t);
    }
  std::int64_t triangles = 0, open = 0;
  for (PartitionId id = 0; id < 2; ++id) {
    MeshOptions options;
    options.partition = id;
    const TriMesh one = make_tri_mesh(model, options).value();
    const MeshCheck check = check_mesh(one.positions, one.triangles);
    EXPECT_TRUE(check.manifold());
    EXPECT_EQ(check.euler, 1);  // a disk
    EXPECT_EQ(check.vertices, static_cast<std::int64_t>(one.positions.size()));
    triangles += check.triangles;
    open += check.boundary_edges;
    EXPECT_EQ(one.triangle_partition, std::vector<PartitionId>(one.triangles.size(), id));
  }
  EXPECT_EQ(triangles, whole.triangles);
  EXPECT_EQ(open, whole.boundary_edges);
}

/// Both partitions bound one body.
void join(SurfaceModel& model) {
  PartitionTable joined;
  for (Partition p : model.partitions) {
    p.body = "both";
    ASSERT_TRUE(joined.insert(p));
  }
  model.partitions = joined;
}

TEST(SurfaceModel, PartitionsOfOneBodyStayJoined) {
  SurfaceModel model = two_balls();
  join(model);
  const TriMesh mesh = make_tri_mesh(model).value();
  EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight());
  EXPECT_EQ(check_mesh(mesh.positions, mesh.triangles).components, 1);
  const MeshMeasure both = measure_mesh(make_tri_mesh(model, {.body = "both"}).value());
  EXPECT_TRUE(both.watertight);
  ASSERT_TRUE(measure_partitions(model).has_value());
  EXPECT_FALSE(model.partitions[0].watertight);
  EXPECT_NEAR(model.partitions[0].area_mm2 + model.partitions[1].area_mm2, both.area_mm2, 1e-6 * both.area_mm2);
}

/// Labels in a checkerboard: parts touch themselves at the corners, where a vertex has four fans.
TEST(SurfaceModel, PartsThatTouchThemselvesAreSplitIntoFans) {
  SurfaceModel model = two_balls();
  for (std::size_t q = 0; q < model.mesh.quads.size(); ++q) {
    glm::vec3 c(0.0f);
    for (const std::uint32_t v : model.mesh.quads[q]) c += 0.25f * model.mesh.positions[v];
    model.quad_partition[q] =
        ((static_cast<int>(c.x) / 2) ^ (static_cast<int>(c.y) / 2) ^ (static_cast<int>(c.z) / 2)) & 1;
  }
  const TriMesh all = make_tri_mesh(model).value();
  const MeshCheck check = check_mesh(all.positions, all.triangles);
  EXPECT_TRUE(check.manifold());
  EXPECT_GT(check.components, 50);
  EXPECT_GT(all.positions.size(), model.mesh.positions.size());
}

TEST(SurfaceModel, MeasuresOfABallAreAnalyticInAnAnisotropicFrame) {
  SurfaceModel model =
      scene::extract_model({48, 48, 48}, [](const glm::vec3& p) { return scene::ball(p, glm::vec3(23.5f), 20.0f); });
  model.frame.input_voxel = {{0.1, 0.2, 0.3}, "test"};
  model.frame.scale = {2.0, 2.0, 2.0};
  model.partitions = PartitionTable{{.id = 0, .name = "ball", .body = ""}};
  ASSERT_TRUE(measure_partitions(model).has_value());
  const double pi = 3.14159265358979, a = 4.0, b = 8.0, c = 12.0;
  EXPECT_TRUE(model.partitions[0].watertight);
  EXPECT_NEAR(model.partitions[0].volume_mm3, 4.0 / 3.0 * pi * a * b * c, 0.01 * 4.0 / 3.0 * pi * a * b * c);
  // Thomsen's formula for the ellipsoid's area, good to 1.1 %.
  const double p = 1.6075, mean = (std::pow(a * b, p) + std::pow(a * c, p) + std::pow(b * c, p)) / 3.0;
  const double area = 4.0 * pi * std::pow(mean, 1.0 / p);
  EXPECT_NEAR(model.partitions[0].area_mm2, area, 0.015 * area);
}

TEST(SurfaceModel, PatchClosesBothSidesWithTheSameTriangles) {
  // A tetrahedron of two x-quads would be degenerate, so the patch is a fan over the real border of two
  // balls.
  SurfaceModel model = two_balls();
  FillPatch patch;
  patch.partition = 0;
  patch.reverse_partition = 1;
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  for (std::uint32_t q = 0; q < model.mesh.quads.size(); ++q) {
    if (model.quad_partition[q] != 0) continue;
    const Polygon polygon = model.mesh.polygon(q);
    for (int i = 0; i < polygon.size; ++i) {
      const std::uint32_t a = polygon.vertex[static_cast<std::size_t>(i)];
      const std::uint32_t b = polygon.vertex[static_cast<std::size_t>((i + 1) % polygon.size)];
      for (const std::uint32_t other : model.mesh.quads_of(a)) {
        if (model.quad_partition[other] != 1) continue;
        const Polygon beyond = model.mesh.polygon(other);
        for (int j = 0; j < beyond.size; ++j)
          if (beyond.vertex[static_cast<std::size_t>(j)] == b &&
              beyond.vertex[static_cast<std::size_t>((j + 1) % beyond.size)] == a)
            patch.triangles.push_back({b, a, dual});
      }
    }
  }
  patch.extra_positions = {{20.2f, 11.4f, 11.4f}};
  model.patches = {patch};
  ASSERT_TRUE(measure_partitions(model).has_value());
  double sum = 0.0;
  for (const Partition& p : model.partitions) {
    EXPECT_TRUE(p.watertight);
    EXPECT_GT(p.volume_mm3, 0.0);
    sum += p.volume_mm3;
  }
  model.patches.clear();
  join(model);
  EXPECT_NEAR(sum, measure_mesh(make_tri_mesh(model).value()).volume_mm3,
              1e-6 * sum);  // the two sides of the patch cancel
}

/// Such a patch can stand in a file of some megabytes; comparing each corner with each would take 10^12 steps.
TEST(SurfaceModel, AMillionTrianglesAtOneVertexAreSplitInLinearTime) {
  constexpr std::uint32_t kTriangles = 1'000'000;
  SurfaceModel model = two_balls();
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  FillPatch patch;
  patch.partition = 0;
  patch.reverse_partition = 1;
  patch.extra_positions.assign(1000, glm::vec3(20.0f));
  for (std::uint32_t t = 0; t < kTriangles; ++t) {
    const std::uint32_t a = dual + t % 1000, b = dual + (t / 1000 + t % 1000 + 1) % 1000;
    patch.triangles.push_back({0, a, b});
  }
  model.patches = {patch};
  const Result<TriMesh> mesh = make_tri_mesh(model);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_GE(mesh->triangles.size(), 2 * std::size_t{kTriangles});
}

/// Fans that meet at one vertex, against the definition: corners are joined where one ends as another starts.
TEST(SurfaceModel, FansAroundAVertexAreThoseOfTheDefinition) {
  std::mt19937 random(20);
  for (int round = 0; round < 50; ++round) {
    SurfaceModel model = two_balls();
    const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
    model.quad_partition.assign(model.mesh.quads.size(), 0);
    FillPatch patch;  // of another partition than the faces, so that at vertex 0 only its own triangles meet
    patch.partition = 1;
    patch.extra_positions.assign(9, glm::vec3(20.0f));
    const std::size_t count = 1 + random() % 12;
    for (std::size_t t = 0; t < count; ++t) {
      const auto a = static_cast<std::uint32_t>(random() % 9);
      const auto b = static_cast<std::uint32_t>((a + 1 + random() % 8) % 9);
      patch.triangles.push_back({0, dual + a, dual + b});
    }
    model.patches = {patch};
    const TriMesh mesh = make_tri_mesh(model).value();
    std::vector<std::size_t> fan(count);
    std::iota(fan.begin(), fan.end(), std::size_t{0});
    for (std::size_t n = 0; n < count; ++n)  // the closure of the relation, by plain repetition
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
          if (patch.triangles[i][2] == patch.triangles[j][1]) fan[i] = fan[j] = std::min(fan[i], fan[j]);
    const std::size_t first = mesh.triangles.size() - count;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        ASSERT_EQ(mesh.triangles[first + i][0] == mesh.triangles[first + j][0], fan[i] == fan[j]) << round;
  }
}

TEST(SurfaceModel, ContradictionsAreRefused) {
  MeshOptions options;
  options.partition = 2;
  EXPECT_EQ(make_tri_mesh(two_balls(), options).error().kind, ErrorKind::kUsage);
  options = {};
  options.body = "tablet";
  EXPECT_EQ(make_tri_mesh(two_balls(), options).error().kind, ErrorKind::kUsage);
  SurfaceModel model = two_balls();
  model.quad_partition[5] = 2;
  EXPECT_EQ(make_tri_mesh(model).error().kind, ErrorKind::kBadData);
  model = two_balls();
  model.quad_partition.pop_back();
  EXPECT_EQ(make_tri_mesh(model).error().kind, ErrorKind::kBadData);
  model = two_balls();
  model.attributes.ao.assign(3, 0);
  EXPECT_EQ(make_tri_mesh(model).error().kind, ErrorKind::kBadData);
  model = two_balls();
  model.patches.push_back({0, 1, {}, {{0, 1, 4000000}}});
  EXPECT_EQ(make_tri_mesh(model).error().kind, ErrorKind::kBadData);
}

TEST(SurfaceModel, AMeshThatNobodyWaitsForAnyMoreIsNotMade) {
  SilentProgress progress;
  EXPECT_TRUE(make_tri_mesh(two_balls(), {.progress = &progress}));
  progress.cancel();
  EXPECT_EQ(make_tri_mesh(two_balls(), {.progress = &progress}).error().kind, ErrorKind::kCancelled);
}

TEST(SurfaceModel, TrianglesOfFilmsAreKnownAndThoseOfOtherPatchesAreNot) {
  SurfaceModel model = two_balls();
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  FillPatch patch{0, 1, {{20, 11, 11}, {20, 13, 11}}, {{0, 1, dual}, {1, 2, dual}, {2, 3, dual + 1}, {0, 1, 2}}};
  model.patches = {patch};
  const auto inferred = [&] {
    const TriMesh mesh = make_tri_mesh(model, {.partition = PartitionId{0}}).value();
    EXPECT_EQ(mesh.evidence.size(), mesh.positions.size());
    return std::vector<std::uint8_t>(mesh.triangle_inferred.end() - 4, mesh.triangle_inferred.end());
  };
  EXPECT_EQ(inferred(), (std::vector<std::uint8_t>{1, 1, 1, 1}));
  model.patches[0].evidence = {evidence_byte(Evidence::kFilm), evidence_byte(Evidence::kInferred)};
  EXPECT_EQ(inferred(), (std::vector<std::uint8_t>{0, 0, 1, 1})) << "between rims alone nothing is known";
  model.patches[0].evidence.pop_back();
  EXPECT_EQ(make_tri_mesh(model).error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
