// glTF as other programs write it: how nodes, numbers and primitives are meant.

#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include "core/mesh_io/mesh_formats.h"
#include "tests/core/mesh_io/foreign_body.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {

using foreign::GlbMaker;
using foreign::Json;
using ::testing::HasSubstr;

void expect_body(const TriMesh& mesh, double volume = 4000.0, double tolerance = 0.1) {
  ASSERT_FALSE(mesh.triangles.empty());
  EXPECT_NEAR(foreign::volume_of(mesh), volume, tolerance);
  EXPECT_TRUE(check_mesh(mesh.positions, mesh.triangles).watertight());
}

TEST(ForeignGlb, NodesThatMirrorKeepTheOutsideOutside) {
  const std::vector<std::pair<Json, double>> cases{
      {{{"scale", {-1, 1, 1}}}, 4000},
      {{{"scale", {1, 1, -1}}}, 4000},
      {{{"scale", {-1, -1, 1}}}, 4000},
      {{{"scale", {-1, -1, -1}}}, 4000},
      {{{"scale", {2, -3, 1}}}, 24000},
      {{{"rotation", {0.5, 0.5, -0.5, 0.5}}, {"scale", {1, -1, 2}}}, 8000},
      {{{"matrix", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}, 4000}};
  for (const auto& [placed, volume] : cases) {
    GlbMaker maker = foreign::plain_glb();
    std::vector<glm::dvec3> normals;
    for (const glm::dvec3& p : foreign::kCorners) normals.push_back(glm::normalize(p));
    maker.primitive()["attributes"]["NORMAL"] = maker.floats(normals);
    for (const auto& [key, value] : placed.items()) maker.json["nodes"][0][key] = value;
    const TriMesh mesh = read(maker);
    expect_body(mesh, volume, 1e-4 * volume);
    const auto centre = 0.5 * (foreign::extent_of(mesh).low + foreign::extent_of(mesh).high);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      EXPECT_GT(glm::dot(glm::dvec3(mesh.normals[v]), mesh.frame.mm_from_grid(mesh.positions[v]) - centre), 0.0);
  }
  // A mirroring parent of a mirroring child.
  GlbMaker maker = foreign::plain_glb();
  maker.json["nodes"] = Json::array({{{"scale", {-1, 1, 1}}, {"children", {1}}}, {{"mesh", 0}, {"scale", {1, 1, -1}}}});
  expect_body(read(maker));
}

TEST(ForeignGlb, QuantisedNumbersStandForWhatTheySay) {
  for (const auto& [component, normalized] : std::vector<std::pair<int, bool>>{{5120, false},
                                                                               {5120, true},
                                                                               {5121, false},
                                                                               {5121, true},
                                                                               {5122, false},
                                                                               {5122, true},
                                                                               {5123, false},
                                                                               {5123, true}}) {
    const bool is_signed = component == 5120 || component == 5122;
    const int bytes = component < 5122 ? 1 : 2, high = is_signed    ? (bytes == 1 ? 127 : 32767)
                                                       : bytes == 1 ? 255
                                                                    : 65535;
    // Steps of a quarter of a mm around the middle of the range.
    const int middle = is_signed ? 0 : high / 2 + 1;
    GlbMaker maker;
    std::string data;
    for (const glm::dvec3& p : foreign::kCorners) {
      for (int a = 0; a < 3; ++a)
        data += foreign::little(static_cast<std::uint64_t>(middle + std::lround(4 * p[a])), bytes);
      data += std::string(static_cast<std::size_t>(bytes == 1 ? 1 : 2), '\0');  // rows of four
    }
    const std::size_t positions = maker.accessor(data, 6, component, "VEC3");
    maker.json["bufferViews"].back()["byteStride"] = 4 * bytes;
    if (normalized) maker.json["accessors"][positions]["normalized"] = true;
    maker.primitive()["attributes"]["POSITION"] = positions;
    maker.primitive()["indices"] = maker.indices(foreign::face_indices());
    const double step = 0.25e-3 * (normalized ? high : 1);
    maker.json["nodes"][0]["scale"] = {step, step, step};
    maker.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const TriMesh mesh = read(maker);
    expect_body(mesh, 4000.0, 1.0);
    EXPECT_NEAR(foreign::extent_of(mesh).size().x, 40.0, 0.01) << component << normalized;
  }
}

TEST(ForeignGlb, QuantisedNormalsPointOutwards) {
  for (const int bytes : {1, 2}) {
    GlbMaker maker = foreign::plain_glb();
    std::string data;
    const double high = bytes == 1 ? 127.0 : 32767.0;
    for (const glm::dvec3& p : foreign::kCorners) {
      const glm::dvec3 n = glm::normalize(p);
      for (int a = 0; a < 3; ++a) data += foreign::little(static_cast<std::uint64_t>(std::lround(high * n[a])), bytes);
      data += std::string(static_cast<std::size_t>(bytes), '\0');
    }
    const std::size_t normals = maker.accessor(data, 6, bytes == 1 ? 5120 : 5122, "VEC3");
    maker.json["bufferViews"].back()["byteStride"] = 4 * bytes;
    maker.json["accessors"][normals]["normalized"] = true;
    maker.primitive()["attributes"]["NORMAL"] = normals;
    const TriMesh mesh = read(maker);
    ASSERT_EQ(mesh.normals.size(), 6u);
    for (std::size_t v = 0; v < 6; ++v) EXPECT_GT(glm::dot(mesh.normals[v], glm::normalize(mesh.positions[v])), 0.999f);
  }
}

TEST(ForeignGlb, StripsAndFansAreTrianglesOnTheSameSide) {
  // The upper and the lower half as fans around their tips, and a strip that is the belt of a prism.
  GlbMaker fan;
  const std::size_t positions = fan.floats(foreign::corners_m());
  fan.json["meshes"][0]["primitives"] = Json::array();
  for (const auto& ring : {std::vector<std::uint32_t>{4, 0, 2, 1, 3, 0}, {5, 0, 3, 1, 2, 0}})
    fan.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", positions}}}, {"indices", fan.indices(ring)}, {"mode", 6}});
  expect_body(read(fan));
  for (const bool indexed : {true, false}) {
    GlbMaker strip;
    const std::vector<std::uint32_t> row{4, 0, 2, 5, 1, 3, 3, 4, 4, 0, 3, 5};  // runs on over places named twice
    std::vector<glm::dvec3> places;
    for (const std::uint32_t v : row) places.push_back(foreign::corners_m()[v]);
    strip.primitive()["mode"] = 5;
    strip.primitive()["attributes"]["POSITION"] = strip.floats(indexed ? foreign::corners_m() : places);
    if (indexed) strip.primitive()["indices"] = strip.indices(row);
    const TriMesh mesh = read(strip);
    // By the rule of the format: triangle i is (i, i + 1, i + 2), every other one turned.
    std::vector<std::array<std::uint32_t, 3>> expected;
    for (std::uint32_t i = 0; i + 2 < row.size(); ++i) {
      const std::array<std::uint32_t, 3> t{row[i], row[i + 1 + i % 2], row[i + 2 - i % 2]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) expected.push_back(t);
    }
    ASSERT_EQ(mesh.triangles.size(), expected.size());
    for (std::size_t t = 0; t < expected.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LT(glm::distance(glm::dvec3(mesh.positions[mesh.triangles[t][c]]), foreign::kCorners[expected[t][c]]),
                  1e-4)
            << indexed << t;
  }
}

TEST(ForeignGlb, SparseNumbersReplaceThoseOfTheirBase) {
  for (const bool with_base : {true, false})
    for (const int component : {5121, 5123, 5125}) {
      GlbMaker maker;
      std::vector<glm::dvec3> base = foreign::corners_m();
      if (!with_base) base.assign(6, glm::dvec3(0.0));
      std::vector<std::uint32_t> which;
      std::string places, values;
      const int bytes = component == 5121 ? 1 : component == 5123 ? 2 : 4;
      for (std::uint32_t v = 0; v < 6; ++v) {
        if (with_base && v % 2 == 0) continue;
        base[v] = {9, 9, 9};
        which.push_back(v);
        places += foreign::little(v, bytes);
        for (int a = 0; a < 3; ++a) values += foreign::little(static_cast<float>(foreign::corners_m()[v][a]));
      }
      std::size_t positions = 0;
      if (with_base) {
        positions = maker.floats(base);
      } else {
        maker.json["accessors"].push_back({{"componentType", 5126}, {"count", 6}, {"type", "VEC3"}});
      }
      const std::size_t place_view = maker.view(places), value_view = maker.view(values);
      maker.json["accessors"][positions]["sparse"] = {
          {"count", which.size()},
          {"indices", {{"bufferView", place_view}, {"componentType", component}}},
          {"values", {{"bufferView", value_view}}}};
      maker.primitive()["attributes"]["POSITION"] = positions;
      maker.primitive()["indices"] = maker.indices(foreign::face_indices());
      expect_body(read(maker));
    }
}

/// Positions and indices packed by the library as its own tool writes them.
GlbMaker packed_glb(bool filtered, bool sequence) {
  GlbMaker maker;
  std::vector<float> places;
  for (const glm::dvec3& p : foreign::corners_m())
    for (int a = 0; a < 3; ++a) places.push_back(static_cast<float>(p[a]));
  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  std::vector<float> stored = places;
  if (filtered) meshopt_encodeFilterExp(stored.data(), 6, 12, 23, places.data());
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(6, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), stored.data(), 6, 12));
  const auto add = [&](const std::vector<unsigned char>& bytes, std::size_t count, std::size_t stride, const char* mode,
                       int component, const char* type) -> Json& {
    maker.bin.resize((maker.bin.size() + 3) / 4 * 4);
    const Json extension{{"buffer", 0},
                         {"byteOffset", maker.bin.size()},
                         {"byteLength", bytes.size()},
                         {"byteStride", stride},
                         {"count", count},
                         {"mode", mode}};
    maker.bin.append(bytes.begin(), bytes.end());
    maker.json["bufferViews"].push_back({{"buffer", 1},
                                         {"byteOffset", 0},
                                         {"byteLength", count * stride},
                                         {"extensions", {{"EXT_meshopt_compression", extension}}}});
    maker.json["accessors"].push_back({{"bufferView", maker.json["bufferViews"].size() - 1},
                                       {"componentType", component},
                                       {"count", count},
                                       {"type", type}});
    return maker.json["bufferViews"].back()["extensions"]["EXT_meshopt_compression"];
  };
  Json& extension = add(packed, 6, 12, "ATTRIBUTES", 5126, "VEC3");
  if (filtered) extension["filter"] = "EXPONENTIAL";
  const std::vector<std::uint32_t> faces = foreign::face_indices();
  std::vector<unsigned char> index(sequence ? meshopt_encodeIndexSequenceBound(faces.size(), 6)
                                            : meshopt_encodeIndexBufferBound(faces.size(), 6));
  index.resize(sequence ? meshopt_encodeIndexSequence(index.data(), index.size(), faces.data(), faces.size())
                        : meshopt_encodeIndexBuffer(index.data(), index.size(), faces.data(), faces.size()));
  add(index, faces.size(), 4, sequence ? "INDICES" : "TRIANGLES", 5125, "SCALAR");
  maker.primitive() = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  maker.json["extra_buffer"] = {{"byteLength", 600}};
  maker.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return maker;
}

TEST(ForeignGlb, PackedDataAreUnpacked) {
  for (const bool filtered : {false, true})
    for (const bool sequence : {false, true}) expect_body(read(packed_glb(filtered, sequence)), 4000.0, 4.0);
}

TEST(ForeignGlb, PackedDataThatLieAreRefused) {
  SilentProgress progress;
  const auto says = [&](const char* key, const Json& value) {
    GlbMaker maker = packed_glb(false, false);
    maker.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    const auto mesh = parse_glb(maker.file(), progress);
    return mesh ? std::string("accepted") : mesh.error().message;
  };
  EXPECT_THAT(says("count", 1 << 20), HasSubstr("more than its bytes can hold"));
  EXPECT_THAT(says("byteLength", 1 << 20), HasSubstr("outside the data"));
  EXPECT_THAT(says("byteStride", 5), HasSubstr("damaged"));
  EXPECT_THAT(says("mode", "LATER"), HasSubstr("damaged"));
  EXPECT_THAT(says("filter", "LATER"), HasSubstr("filter"));
  const std::string whole = packed_glb(true, false).file();
  for (std::size_t i = 12; i < whole.size(); ++i)
    for (const int bit : {0, 3, 7}) {
      std::string file = whole;
      file[i] = static_cast<char>(file[i] ^ (1 << bit));
      static_cast<void>(parse_glb(file, progress));  // refused or read, nothing else
    }
}

TEST_F(FileTest, OurOwnCompressedFilesAreReadWhereTheyLay) {
  SilentProgress progress;
  const TriMesh mesh = sample_mesh();
  ASSERT_TRUE(write_mesh(folder_ / "a.glb", mesh, {.compress = true}, progress));
  const auto back = read_mesh(folder_ / "a.glb", progress);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->triangles.size(), mesh.triangles.size());
  EXPECT_EQ(back->partitions.size(), 2u);
  const auto before = foreign::extent_of(mesh), after = foreign::extent_of(*back);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(before.low[a], after.low[a], 0.5 * 0.076 / 16 + 1e-6);
    EXPECT_NEAR(before.high[a], after.high[a], 0.5 * 0.076 / 16 + 1e-6);
  }
  EXPECT_NEAR(foreign::volume_of(*back), foreign::volume_of(mesh), 0.01 * foreign::volume_of(mesh));
  EXPECT_TRUE(check_mesh(back->positions, back->triangles).watertight());
}

TEST(ForeignGlb, EqualPlacesAreJoinedWithAndWithoutIndices) {
  for (const bool indexed : {true, false}) {
    GlbMaker maker;
    std::vector<glm::dvec3> places, normals;
    std::vector<std::uint32_t> order;
    for (const auto& f : foreign::kFaces) {
      const auto c = foreign::corners_m();
      for (const std::uint32_t v : f) {
        order.push_back(static_cast<std::uint32_t>(places.size()));
        places.push_back(c[v]);
        normals.push_back(glm::normalize(glm::cross(c[f[1]] - c[f[0]], c[f[2]] - c[f[0]])));
      }
    }
    maker.primitive()["attributes"]["POSITION"] = maker.floats(places);
    maker.primitive()["attributes"]["NORMAL"] = maker.floats(normals);
    if (indexed) maker.primitive()["indices"] = maker.indices(order);
    const TriMesh mesh = read(maker);
    EXPECT_EQ(mesh.positions.size(), 6u);
    expect_body(mesh);
    ASSERT_EQ(mesh.normals.size(), 6u);
    for (std::size_t v = 0; v < 6; ++v)
      EXPECT_GT(glm::dot(mesh.normals[v], glm::normalize(mesh.positions[v])), 0.99f) << "between those of its faces";
  }
}

TEST(ForeignGlb, ClosedBodiesThatTouchStayApart) {
  GlbMaker maker = foreign::plain_glb();
  maker.json["nodes"] =
      Json::array({{{"children", {1, 2}}}, {{"mesh", 0}}, {{"mesh", 0}, {"translation", {0.04, 0, 0}}}});
  const TriMesh mesh = read(maker);
  EXPECT_EQ(mesh.positions.size(), 12u);
  EXPECT_EQ(check_mesh(mesh.positions, mesh.triangles).components, 2);
}

TEST(ForeignGlb, InstancesStandWhereTheyShall) {
  GlbMaker maker = foreign::plain_glb();
  const std::size_t places = maker.floats(std::vector<glm::dvec3>{{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}});
  const std::size_t scales = maker.floats(std::vector<glm::dvec3>{{1, 1, 1}, {2, 2, 2}, {-1, 1, 1}});
  maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places},
                                                                                   {"SCALE", scales}};
  maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const TriMesh mesh = read(maker);
  EXPECT_EQ(check_mesh(mesh.positions, mesh.triangles).components, 3);
  EXPECT_NEAR(foreign::volume_of(mesh), 4000.0 * (1 + 8 + 1), 1.0);
  EXPECT_NEAR(foreign::extent_of(mesh).high.x, 140.0, 1e-3);
  EXPECT_NEAR(foreign::extent_of(mesh).high.y, 215.0, 1e-3);
}

TEST(ForeignGlb, PointsAreToldAsTheyLie) {
  GlbMaker maker = foreign::plain_glb();
  maker.primitive()["mode"] = 0;
  const TriMesh mesh = read(maker);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_NEAR(foreign::extent_of(mesh).size().y, 30.0, 1e-4);
}

TEST(ForeignGlb, FarFromTheOriginTheShapeIsKept) {
  GlbMaker maker = foreign::plain_glb();
  maker.json["nodes"][0]["translation"] = {500123.0, 4187234.0, 12.0};
  const TriMesh mesh = read(maker);
  expect_body(mesh);
  EXPECT_NEAR(foreign::extent_of(mesh).low.x, 500123000.0 - 20.0, 1e-3);
}

}  // namespace
}  // namespace dubsar
