// An envelope is one body of two partitions that share the vertices on their border. Whoever asks for the partition of
// a triangle there must get the same answer: the mesh, its files, its coarser form, the renderer, the light.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>

#include "core/exa/exa_file.h"
#include "core/exa/offsets/settle.h"
#include "core/mesh/simplify.h"
#include "core/mesh_io/mesh_io.h"
#include "core/parts/fill/holes.h"
#include "core/parts/segment.h"
#include "core/pipeline/model_occlusion.h"
#include "display/render/mesh/gpu_mesh.h"
#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

/// A tablet in an envelope with a crack through its wall, where the outside meets the inside.
const SurfaceModel& cracked_envelope() {
  static const SurfaceModel model = [] {
    scene::Nested scene;
    scene.change = [scene](float v, const glm::vec3& p) {
      const bool above = p.y > scene.centre.y && std::abs(p.z - 47.8f) < 25.0f;
      return above && scene.tablet(p) < -1.5f ? std::min(v, std::abs(p.x - 47.3f) - 1.0f) : v;
    };
    SurfaceModel made = scene::extract_model(scene.dims, scene);
    made.frame.input_voxel = {{1.0, 1.0, 1.0}, "test"};
    SilentProgress progress;
    EXPECT_TRUE(segment(made, {}, progress));
    EXPECT_TRUE(fill_holes(made, {}, progress));
    return made;
  }();
  return model;
}

using Corners = std::array<std::array<float, 3>, 3>;

Corners corners_of(const std::vector<glm::vec3>& positions, const Triangle& t) {
  Corners corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = {positions[t[c]].x + 0.0f, positions[t[c]].y + 0.0f, positions[t[c]].z + 0.0f};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::map<Corners, PartitionId> labels_of(const TriMesh& mesh) {
  std::map<Corners, PartitionId> labels;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    labels[corners_of(mesh.positions, mesh.triangles[t])] = mesh.partition_of(t);
  return labels;
}

/// Triangles whose vertices are also used by another partition: those that vertex labels cannot tell.
std::size_t at_the_border(const TriMesh& mesh) {
  std::vector<unsigned> seen(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) seen[v] |= 1u << mesh.partition_of(t);
  std::size_t count = 0;
  for (const Triangle& t : mesh.triangles)
    count += std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return (seen[v] & (seen[v] - 1)) != 0; });
  return count;
}

TEST(PartitionBorder, TheMeshHasTheLabelsOfTheModelsFaces) {
  const SurfaceModel& model = cracked_envelope();
  ASSERT_NE(model.partitions.find(PartitionKind::kEnvelopeInside), nullptr);
  const TriMesh mesh = make_tri_mesh(model, {.fill_holes = false}).value();
  ASSERT_GT(at_the_border(mesh), 100u) << "the crack joins the outside and the inside";
  std::array<std::size_t, PartitionTable::kMost> of_faces{}, of_triangles{};
  for (std::uint32_t q = 0; q < model.mesh.quads.size(); ++q) {
    const auto size = static_cast<std::size_t>(model.mesh.polygon(q).size);
    of_faces[model.quad_partition[q]] += size == 4 ? 2 : 0;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) ++of_triangles[mesh.partition_of(t)];
  ASSERT_TRUE(model.mesh.doubled.empty()) << "so that every face is two triangles";
  EXPECT_EQ(of_triangles, of_faces);
}

TEST(PartitionBorder, FilesKeepTheLabelOfEveryTriangle) {
  const TriMesh mesh = make_tri_mesh(cracked_envelope()).value();
  const auto labels = labels_of(mesh);
  const auto folder = std::filesystem::temp_directory_path();
  SilentProgress progress;
  for (const char* suffix : {".ply", ".obj", ".glb"}) {
    const auto path = folder / fmt::format("dubsar_border_{}{}", ::getpid(), suffix);
    ASSERT_TRUE(write_mesh(path, mesh, {MeshUnits::kMm}, progress));
    const auto read = read_mesh(path, progress);
    std::filesystem::remove(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(labels_of(*read) == labels) << suffix;
  }
  std::size_t selected = 0;
  for (const Partition& p : mesh.partitions) {
    const TriMesh part = select_partitions(mesh, static_cast<std::uint8_t>(1u << p.id));
    selected += part.triangles.size();
    for (const auto& [corners, label] : labels_of(part)) ASSERT_EQ(labels.at(corners), label);
  }
  EXPECT_EQ(selected, mesh.triangles.size());
}

TEST(PartitionBorder, AnExaFileKeepsTheLabelOfEveryTriangle) {
  SurfaceModel model = cracked_envelope();
  SilentProgress progress;
  ASSERT_TRUE(settle_for_exa(model, {}, progress));
  const auto path = std::filesystem::temp_directory_path() / fmt::format("dubsar_border_{}.exa", ::getpid());
  ASSERT_TRUE(write_exa(path, model, progress));
  const auto read = read_exa(path, progress);
  std::filesystem::remove(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(labels_of(make_tri_mesh(*read).value()) == labels_of(make_tri_mesh(model).value()));
}

TEST(PartitionBorder, ASimplifiedMeshKeepsTheBorderAndTheLabels) {
  const TriMesh mesh = make_tri_mesh(cracked_envelope()).value();
  SilentProgress progress;
  const TriMesh small = simplify(mesh, {}, progress).value();
  ASSERT_LT(small.triangles.size(), mesh.triangles.size());
  const auto border_vertices = [](const TriMesh& of) {
    std::map<std::array<float, 3>, unsigned> seen;
    for (std::size_t t = 0; t < of.triangles.size(); ++t)
      for (const std::uint32_t v : of.triangles[t])
        seen[{of.positions[v].x, of.positions[v].y, of.positions[v].z}] |= 1u << of.partition_of(t);
    std::erase_if(seen, [](const auto& item) { return (item.second & (item.second - 1)) == 0; });
    return seen;
  };
  EXPECT_TRUE(border_vertices(small) == border_vertices(mesh));
}

TEST(PartitionBorder, EveryVertexThatIsDrawnTellsThePartitionOfItsTriangles) {
  const TriMesh mesh = make_tri_mesh(cracked_envelope()).value();
  const PackedMesh packed = pack_mesh(mesh).value();
  ASSERT_EQ(packed.triangles.size(), mesh.triangles.size());
  EXPECT_GT(packed.vertices.size(), mesh.positions.size());
  std::vector<std::uint32_t> source;  // of each place among the drawn triangles
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.partition_of(t) == id) source.push_back(static_cast<std::uint32_t>(t));
  for (int id = 0; id < kMaxPartitions; ++id)
    for (auto t = packed.first_triangle[id]; t < packed.first_triangle[id + 1]; ++t) {
      const std::uint32_t from = source[static_cast<std::size_t>(t)];
      ASSERT_EQ(mesh.partition_of(from), id);
      for (std::size_t c = 0; c < 3; ++c) {
        const PackedVertex& drawn = packed.vertices[packed.triangles[static_cast<std::size_t>(t)][c]];
        ASSERT_EQ(drawn.attributes >> 13, id);
        ASSERT_EQ(drawn.position, packed.vertices[mesh.triangles[from][c]].position) << "a copy stays in its place";
      }
    }
}

TEST(PartitionBorder, LightFallsOnEachBodyAsIfItLayAlone) {
  SurfaceModel model = cracked_envelope();
  SilentProgress progress;
  const OcclusionOptions options{.rays = 24, .radius_vox = 16.0f};
  ASSERT_TRUE(occlusion_of_model(model, options, progress));
  std::vector<std::uint8_t> expected(model.mesh.positions.size(), 0);
  for (const std::string& body : model.partitions.body_names()) {
    std::vector<std::uint32_t> source;
    const TriMesh mesh = make_tri_mesh(cracked_envelope(), {.body = body}, &source).value();
    const auto light = ambient_occlusion({mesh.positions, mesh.normals, mesh.triangles}, options, progress).value();
    for (std::size_t v = 0; v < source.size(); ++v)
      if (source[v] != kNoSource) expected[source[v]] = std::max(expected[source[v]], light[v]);
  }
  EXPECT_TRUE(model.attributes.ao == expected);
}

}  // namespace
}  // namespace dubsar
