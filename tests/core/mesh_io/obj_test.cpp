#include <gmock/gmock.h>

#include "core/base/files/input_file.h"
#include "core/mesh_io/mesh_formats.h"
#include "mesh_samples.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

class Obj : public FileTest {};

Result<TriMesh> parsed_obj(const std::string& bytes) {
  SilentProgress progress;
  return parse_obj(bytes, progress);
}

TEST_F(Obj, MeshReadBackEqualsTheMeshWritten) {
  const TriMesh mesh = sample_mesh();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.obj", mesh, {MeshUnits::kVox}, progress));
  const auto read = read_mesh(folder_ / "a.obj", progress);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->triangles, mesh.triangles);
  EXPECT_EQ(read->normals, mesh.normals) << "shortest decimal numbers must give the same floats";
  EXPECT_EQ(read->triangle_partition, mesh.triangle_partition);
  EXPECT_EQ(read->provenance, mesh.provenance);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_EQ(read->positions[v], glm::vec3(mesh.frame.input_vox_from_grid(glm::dvec3(mesh.positions[v]))));
  EXPECT_EQ(read->frame.input_voxel.mm, mesh.frame.input_voxel.mm);
  EXPECT_THAT(*read_file_bytes(folder_ / "a.obj"), HasSubstr("\ng part3_envelope_inside\nf 289//289 "));
}

TEST_F(Obj, NegativeIndicesPolygonsColoursAndContinuationsAreRead) {
  const auto mesh = parsed_obj(
      "mtllib x.mtl\nv 0 0 0 1 0 0.5\r\nv 1 0 0 0 1 2\nv 1 \\\n1 0 0 0 0\nv 0 1 0 0 0 0\nvt 0 0\n"
      "vn 0 0 2\nvn 0 0 1\nusemtl m\nf -4/1/-1 -3/1/2 3/1/2 \\\n 4/1/2\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh->colors[0], (std::array<std::uint8_t, 3>{255, 0, 128}));
  EXPECT_EQ(mesh->colors[1], (std::array<std::uint8_t, 3>{0, 255, 255}));
  EXPECT_EQ(mesh->normals[2], glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST_F(Obj, VertexWithSeveralNormalsGetsTheirMeanDirection) {
  const auto mesh =
      parsed_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 2//2 4//2\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(glm::distance(mesh->normals[0], glm::normalize(glm::vec3(0, 1, 1))), 0.0f, 1e-6f);
  EXPECT_EQ(mesh->normals[2], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh->normals[3], glm::vec3(0, 1, 0));
}

TEST_F(Obj, LiesAreRefusedWithTheLineNumber) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(parsed_obj(three + "f 1 2 4\n").error().message, HasSubstr("names vertex 4, but there are 3"));
  EXPECT_THAT(parsed_obj(three + "f 1 2 0\n").error().message, HasSubstr("line 4"));
  EXPECT_THAT(parsed_obj(three + "f 1 2 -4\n").error().message, HasSubstr("vertex numbers that exist"));
  EXPECT_THAT(parsed_obj(three + "f 1 2\n").error().message, HasSubstr("at least 3 corners"));
  EXPECT_THAT(parsed_obj(three + "f 1//9 2//9 3//9\n").error().message, HasSubstr("normal 9"));
  EXPECT_THAT(parsed_obj("v 0 nan 0\n").error().message, HasSubstr("finite"));
  EXPECT_THAT(parsed_obj("v 0 0\n").error().message, HasSubstr("3 coordinates"));
  EXPECT_THAT(parsed_obj("# " + std::string(2 << 20, 'x')).error().message, HasSubstr("1 MiB"));
}

}  // namespace
}  // namespace dubsar
