#include <gmock/gmock.h>

#include "core/base/files/input_file.h"
#include "core/base/numbers/bytes.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/relief/curvature/shape_colors.h"
#include "mesh_samples.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

class Ply : public FileTest {};

Result<TriMesh> parsed_ply(const std::string& bytes) {
  SilentProgress progress;
  return parse_ply(bytes, progress);
}

TEST_F(Ply, MeshReadBackInVoxelsEqualsTheMeshWritten) {
  const TriMesh mesh = sample_mesh();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", mesh, {MeshUnits::kVox}, progress));
  const auto read = read_mesh(folder_ / "a.ply", progress);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->triangles, mesh.triangles);
  EXPECT_EQ(read->normals, mesh.normals);
  EXPECT_EQ(read->colors, mesh.colors);
  EXPECT_EQ(read->triangle_partition, mesh.triangle_partition);
  EXPECT_EQ(read->shape, mesh.shape);
  EXPECT_EQ(read->ao, mesh.ao);
  EXPECT_EQ(read->evidence, mesh.evidence);
  ASSERT_EQ(read->positions.size(), mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(read->positions[v], glm::vec3(mesh.frame.input_vox_from_grid(glm::dvec3(mesh.positions[v]))));
    EXPECT_EQ(read->k_min[v], mesh.k_min[v] * 0.5f) << "curvature per input voxel: the grid step is two of them";
    EXPECT_EQ(read->k_max[v], mesh.k_max[v] * 0.5f);
  }
  EXPECT_EQ(read->frame.input_voxel.mm, mesh.frame.input_voxel.mm);
  EXPECT_EQ(read->frame.input_voxel.provenance, mesh.frame.input_voxel.provenance);
  ASSERT_EQ(read->partitions.size(), 2u);
  EXPECT_EQ(read->partitions[1].id, 3);
  EXPECT_EQ(read->partitions[1].name, "envelope inside");
  EXPECT_EQ(read->partitions[1].body, "envelope");
  EXPECT_EQ(read->partitions[0].area_mm2, 1234.5);
  EXPECT_EQ(read->partitions[0].volume_mm3, 678.25);
  EXPECT_TRUE(read->partitions[0].watertight);
  EXPECT_EQ(read->provenance, mesh.provenance);
}

TEST_F(Ply, WritingWhatWasReadGivesTheSameBytes) {
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", sample_mesh(), {MeshUnits::kVox}, progress));
  const auto read = read_mesh(folder_ / "a.ply", progress);
  ASSERT_TRUE(read);
  ASSERT_TRUE(write_mesh(folder_ / "b.ply", *read, {MeshUnits::kVox}, progress));
  EXPECT_EQ(*read_file_bytes(folder_ / "a.ply"), *read_file_bytes(folder_ / "b.ply"));
}

TEST_F(Ply, MillimetresAreVoxelsTimesVoxelSize) {
  const TriMesh mesh = sample_mesh();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", mesh, {MeshUnits::kMm}, progress));
  const auto read = read_mesh(folder_ / "a.ply", progress);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->frame.input_voxel.known());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(read->positions[v],
              glm::vec3((glm::dvec3(mesh.positions[v]) * 2.0 + glm::dvec3(0.5, -3.0, 11.25)) * 0.038));
    EXPECT_NEAR(read->k_max[v], mesh.k_max[v] / 0.076f, 1e-5f);
  }
}

TEST_F(Ply, UnknownVoxelSizeIsSaidInTheHeader) {
  TriMesh mesh = sample_mesh();
  mesh.frame.input_voxel = {};
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", mesh, {}, progress));
  EXPECT_THAT(*read_file_bytes(folder_ / "a.ply"), HasSubstr("comment voxel_size unknown"));
  EXPECT_FALSE(read_mesh(folder_ / "a.ply", progress)->frame.input_voxel.known());
}

TEST_F(Ply, HeaderListsThePropertiesInTheOrderOfTheContract) {
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", sample_mesh(), {}, progress));
  const std::string bytes = *read_file_bytes(folder_ / "a.ply");
  const std::string expected =
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar partition\n"
      "property float k_min\nproperty float k_max\nproperty uchar shape\nproperty uchar ao\nproperty uchar "
      "evidence\nproperty float quality\n"
      "element face 1152\nproperty list uchar int vertex_indices\nproperty uchar partition\nend_header\n";
  ASSERT_THAT(bytes, HasSubstr(expected));
  const std::size_t body = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.size() - body, 576u * 43u + 1152u * 14u);
  ByteReader first(std::string_view(bytes).substr(body));
  first.take(28);
  const auto k_min = first.little<float>(), k_max = first.little<float>();
  first.take(3);
  EXPECT_EQ(first.little<float>(), 0.5f * (k_min + k_max)) << "quality is the mean curvature";
}

TEST_F(Ply, ColoursAreThoseOfTheShapeTableAndAreNotReadBackAsForeign) {
  TriMesh mesh = sample_mesh();
  mesh.colors.clear();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", mesh, {}, progress));
  const std::string bytes = *read_file_bytes(folder_ / "a.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto expected = shade(shape_color_table(ShapeColors::kTable)[mesh.shape[v]], mesh.ao[v]);
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(static_cast<std::uint8_t>(bytes[body + 43 * v + 24 + c]), expected[c]);
  }
  EXPECT_TRUE(read_mesh(folder_ / "a.ply", progress)->colors.empty());
}

TEST_F(Ply, AllEncodingsOfOneTriangleReadTheSame) {
  const std::string head =
      "format {} 1.0\nobj_info x\nelement camera 1\nproperty double f\nproperty list int short q\n"
      "element face 1\nproperty uchar flag\nproperty list ushort uint vertex_index\n"
      "element vertex 3\nproperty double z\nproperty short x\nproperty list uchar uchar junk\n"
      "property float y\nproperty ushort red\nproperty ushort green\nproperty ushort blue\n"
      "end_header\n";
  std::string ascii = "ply\r\n" + fmt::format(fmt::runtime(head), "ascii") +
                      "3.5 2 -1 7\n9 3\n2 1\n0\n1.5 -2 0 2.25 65535 257 0\n+4 5 2 1 2 6 0 0 0\n7 8 1 3 1e1 0 0 0";
  std::string little = "ply\n" + fmt::format(fmt::runtime(head), "binary_little_endian");
  std::string big = "ply\n" + fmt::format(fmt::runtime(head), "binary_big_endian");
  const auto put = [&](auto value) {
    append_little(little, value);
    append_little(big, byte_swapped(value));
  };
  put(3.5), put(std::int32_t{2}), put(std::int16_t{-1}), put(std::int16_t{7});
  put(std::uint8_t{9}), put(std::uint16_t{3}), put(2u), put(1u), put(0u);
  const auto vertex = [&](double z, std::int16_t x, int junk, float y, std::uint16_t r, std::uint16_t g) {
    put(z), put(x), put(static_cast<std::uint8_t>(junk));
    for (int i = 0; i < junk; ++i) put(std::uint8_t{1});
    put(y), put(r), put(g), put(std::uint16_t{0});
  };
  vertex(1.5, -2, 0, 2.25f, 65535, 257);
  vertex(4.0, 5, 2, 6.0f, 0, 0);
  vertex(7.0, 8, 1, 10.0f, 0, 0);
  for (const std::string& bytes : {ascii, little, big}) {
    const auto mesh = parsed_ply(bytes);
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->positions.size(), 3u);
    EXPECT_EQ(mesh->positions[0], glm::vec3(-2.0f, 2.25f, 1.5f));
    EXPECT_EQ(mesh->positions[2], glm::vec3(8.0f, 10.0f, 7.0f));
    EXPECT_EQ(mesh->colors[0], (std::array<std::uint8_t, 3>{255, 1, 0}));
    ASSERT_EQ(mesh->triangles.size(), 1u);
    EXPECT_EQ(mesh->triangles[0], (Triangle{2, 1, 0}));
    EXPECT_FALSE(mesh->frame.input_voxel.known());
  }
}

TEST_F(Ply, LiesAreRefusedWithASentence) {
  const auto says = [](const std::string& bytes) {
    const auto mesh = parsed_ply(bytes);
    if (mesh) return std::string("accepted");
    EXPECT_EQ(mesh.error().kind, ErrorKind::kBadData);
    return mesh.error().message;
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "property list uchar int vertex_indices\nend_header\n";
  const std::string three =
      "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + "element face 1\n" + face + "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(says(three + "3 0 1 2\n"), "accepted");
  EXPECT_THAT(says(three + "3 0 1 3\n"), HasSubstr("names vertex 3"));
  EXPECT_THAT(says(three + "3 0 1 -1\n"), HasSubstr("names vertex -1"));
  EXPECT_THAT(says(three + "3 0 1 0.5\n"), HasSubstr("names vertex 0.5"));
  EXPECT_THAT(says(three + "300000 0 1 2\n"), HasSubstr("items"));
  EXPECT_THAT(says(three + "3 0 1\n"), HasSubstr("the file ends"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement vertex 4294967294\n" + xyz + "element face 0\n" + face),
              HasSubstr("announced"));
  EXPECT_THAT(says("ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz + "element face 4294967295\n" +
                   face + std::string(12, '\0')),
              HasSubstr("announced"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "element face 0\n" + face + "0 nan 0\n"),
              HasSubstr("not finite"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "element face 0\n" + face + "0 1e39 0\n"),
              HasSubstr("not finite"));
  for (const char* element : {"face", "edge"})
    for (const char* format : {"ascii", "binary_big_endian"})
      says(fmt::format("ply\nformat {} 1.0\nelement vertex 0\n{}element {} 18446744073709551615\nend_header\n", format,
                       xyz, element));  // comes back: 2^64 - 1 items of no bytes take no time
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement vertex 0\n" + xyz + "element face 7\nend_header\n"),
              HasSubstr("7 items \"face\" found without properties"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement tristrips 1\n" + face), HasSubstr("no vertex element"));
  EXPECT_THAT(says("ply\nformat ascii 2.0\n"), HasSubstr("format"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz), HasSubstr("does not end"));
  EXPECT_THAT(says("ply\nformat ascii 1.0\nproperty float x\nend_header\n"), HasSubstr("before any element"));
}

TEST_F(Ply, ColoursThatAreNoNumbersAreDark) {
  const auto mesh = parsed_ply(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float red\nproperty float green\nproperty float blue\nend_header\n"
      "0 0 0 nan -1 0.5\n0 0 0 inf -inf 1\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->colors[0], (std::array<std::uint8_t, 3>{0, 0, 128}));
  EXPECT_EQ(mesh->colors[1], (std::array<std::uint8_t, 3>{255, 0, 255}));
}

TEST_F(Ply, FilesThatLabelVerticesOnlyAreReadAsTheirWriterMeantThem) {
  const auto mesh = parsed_ply(
      "ply\nformat ascii 1.0\ncomment made by dubsar\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar partition\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 1\n1 0 0 1\n1 1 0 2\n0 1 0 1\n3 0 1 3\n3 1 2 3\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangle_partition, (std::vector<PartitionId>{1, 2})) << "a vertex between two had the lower label";
}

TEST_F(Ply, PolygonsBecomeTrianglesThatCoverThem) {
  // An L of area 3 whose fan from the first corner would lie outside, and a planar square.
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n6 0 1 2 3 4 5\n4 5 0 1 2\n";
  const auto mesh = parsed_ply(head);
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->triangles.size(), 6u);
  double area = 0.0;
  for (std::size_t t = 0; t < 4; ++t) {
    const auto& [a, b, c] = mesh->triangles[t];
    const glm::vec3 n = glm::cross(mesh->positions[b] - mesh->positions[a], mesh->positions[c] - mesh->positions[a]);
    EXPECT_GE(n.z, 0.0f) << "a triangle is turned over";
    area += 0.5 * static_cast<double>(n.z);
  }
  EXPECT_EQ(area, 3.0);
}

}  // namespace
}  // namespace dubsar
