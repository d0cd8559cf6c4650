#include <gmock/gmock.h>

#include "core/base/files/input_file.h"
#include "core/base/numbers/bytes.h"
#include "core/mesh_io/mesh_formats.h"
#include "mesh_samples.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Stl : public FileTest {};

Result<TriMesh> parsed_stl(const std::string& bytes) {
  SilentProgress progress;
  return parse_stl(bytes, progress);
}

TEST_F(Stl, FacetsHaveMillimetresUnitNormalsAndTheRightCount) {
  const TriMesh mesh = sample_mesh();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.STL", mesh, {}, progress));
  const std::string bytes = *read_file_bytes(folder_ / "a.STL");
  ASSERT_EQ(bytes.size(), 84u + 50u * mesh.triangles.size());
  EXPECT_THAT(bytes, StartsWith("dubsar STL, units mm; all parts"));
  ByteReader reader(std::string_view(bytes).substr(80));
  EXPECT_EQ(reader.little<std::uint32_t>(), mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    glm::vec3 row[4];
    for (glm::vec3& v : row)
      for (int axis = 0; axis < 3; ++axis) v[axis] = reader.little<float>();
    EXPECT_EQ(reader.little<std::uint16_t>(), 0);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(row[c + 1],
                glm::vec3(mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[t[static_cast<std::size_t>(c)]]))));
    EXPECT_NEAR(glm::length(row[0]), 1.0f, 1e-6f);
    const glm::vec3 mean = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    EXPECT_GT(glm::dot(row[0], mean), 2.5f) << "the facet looks away from the analytic normal";
  }
  EXPECT_TRUE(reader.ok());
}

TEST_F(Stl, CornersAreWeldedToTheOriginalVertices) {
  const TriMesh tablet = select_partitions(sample_mesh(), 1);
  EXPECT_EQ(tablet.positions.size(), 288u);
  EXPECT_EQ(tablet.triangles.size(), 576u);
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.stl", tablet, {}, progress));
  EXPECT_THAT(*read_file_bytes(folder_ / "a.stl"), StartsWith("dubsar STL, units mm; tablet  "));
  const auto read = read_mesh(folder_ / "a.stl", progress);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->positions.size(), tablet.positions.size());
  EXPECT_EQ(read->triangles.size(), tablet.triangles.size());
  EXPECT_TRUE(read->frame.input_voxel.known());
  for (std::size_t t = 0; t < tablet.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(read->positions[read->triangles[t][c]],
                glm::vec3(tablet.frame.mm_from_grid(glm::dvec3(tablet.positions[tablet.triangles[t][c]]))));
}

TEST_F(Stl, UnknownVoxelSizeIsSaidInTheHeader) {
  TriMesh mesh = sample_mesh();
  mesh.frame.input_voxel = {};
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.stl", mesh, {}, progress));
  EXPECT_THAT(read_file_bytes(folder_ / "a.stl")->substr(0, 80), HasSubstr("voxel size unknown, 1 voxel = 1 mm"));
  EXPECT_FALSE(read_mesh(folder_ / "a.stl", progress)->frame.input_voxel.known());
}

TEST_F(Stl, AsciiWithSeveralSolidsIsRead) {
  const std::string facet =
      " facet normal nan 0 0\n outer loop\n vertex 0 0 0\n vertex +1.5 0 0\n vertex 0 1e0 -0\n endloop\n endfacet\n";
  const auto mesh = parsed_stl("\n solid a b c\n" + facet + "endsolid a b c\nsolid\n" + facet + "endsolid\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions.size(), 3u) << "+0 and -0 are one coordinate";
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
  EXPECT_FALSE(mesh->frame.input_voxel.known());
}

TEST_F(Stl, BinaryThatStartsWithSolidIsRead) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  append_little(bytes, 1u);
  for (int i = 0; i < 12; ++i) append_little(bytes, static_cast<float>(i * i));
  append_little(bytes, std::uint16_t{0});
  const auto mesh = parsed_stl(bytes);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 1u);
  EXPECT_EQ(mesh->positions[0], glm::vec3(9.0f, 16.0f, 25.0f));
}

TEST_F(Stl, LiesAreRefusedWithASentence) {
  std::string bytes(80, 'x');
  append_little(bytes, 0xFFFFFFFFu);
  EXPECT_THAT(parsed_stl(bytes).error().message, HasSubstr("4294967295 triangles announced"));
  EXPECT_THAT(parsed_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2").error().message,
              HasSubstr("\"end of file\" found in triangle 0, expected a number"));
  EXPECT_THAT(parsed_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex inf 2 3").error().message,
              HasSubstr("finite"));
  EXPECT_THAT(parsed_stl("solid a\nbox").error().message, HasSubstr("expected \"facet\""));
  EXPECT_THAT(parsed_stl("solid a\n").error().message, HasSubstr("end of file"));
}

}  // namespace
}  // namespace dubsar
