#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/files/input_file.h"
#include "core/base/numbers/bytes.h"
#include "core/mesh_io/mesh_formats.h"
#include "mesh_samples.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using Json = nlohmann::json;

class Glb : public FileTest {};

struct Chunks {
  Json json;
  std::string bin;
};

Chunks chunks_of(const std::string& bytes) {
  ByteReader reader(bytes);
  EXPECT_EQ(reader.take(4), "glTF");
  EXPECT_EQ(reader.little<std::uint32_t>(), 2u);
  EXPECT_EQ(reader.little<std::uint32_t>(), bytes.size());
  const auto json_bytes = reader.little<std::uint32_t>();
  EXPECT_EQ(json_bytes % 4, 0u);
  EXPECT_EQ(reader.take(4), "JSON");
  Chunks chunks{Json::parse(reader.take(json_bytes)), {}};
  const auto bin_bytes = reader.little<std::uint32_t>();
  EXPECT_EQ(bin_bytes % 4, 0u);
  EXPECT_EQ(reader.take(4), std::string_view("BIN\0", 4));
  chunks.bin = reader.take(bin_bytes);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.left(), 0u);
  return chunks;
}

std::string glb_of(const Json& json, const std::string& bin) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append_little(bytes, 2u);
  append_little(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bin.size()));
  append_little(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append_little(bytes, static_cast<std::uint32_t>(bin.size()));
  return bytes + std::string("BIN\0", 4) + bin;
}

TEST_F(Glb, AccessorsLieInsideTheirViewsAndBoundsAreTight) {
  SilentProgress progress;
  const TriMesh mesh = sample_mesh();
  ASSERT_TRUE(write_mesh(folder_ / "a.glb", mesh, {}, progress));
  const auto [json, bin] = chunks_of(*read_file_bytes(folder_ / "a.glb"));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  ASSERT_EQ(json["buffers"].size(), 1u);
  EXPECT_EQ(json["buffers"][0]["byteLength"], bin.size());
  for (const Json& view : json["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), bin.size());
  }
  ASSERT_EQ(json["meshes"].size(), 2u);
  EXPECT_EQ(json["meshes"][0]["name"], "tablet");
  EXPECT_EQ(json["nodes"][2]["name"], "envelope inside");
  EXPECT_EQ(json["nodes"][0]["children"], (Json{1, 2}));
  for (const Json& entry : json["meshes"]) {
    const Json& primitive = entry["primitives"][0];
    const Json& position = json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    const Json& view = json["bufferViews"][position["bufferView"].get<std::size_t>()];
    const auto count = position["count"].get<std::size_t>();
    EXPECT_EQ(count, 288u);
    EXPECT_EQ(view["byteLength"], count * 12);
    glm::vec3 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
    for (std::size_t v = 0; v < count; ++v) {
      glm::vec3 p;
      std::memcpy(&p, bin.data() + view["byteOffset"].get<std::size_t>() + 12 * v, 12);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(position["min"][static_cast<std::size_t>(axis)].get<float>(), low[axis]);
      EXPECT_EQ(position["max"][static_cast<std::size_t>(axis)].get<float>(), high[axis]);
    }
    const Json& index = json["accessors"][primitive["indices"].get<std::size_t>()];
    EXPECT_EQ(index["count"], 576u * 3u);
    EXPECT_EQ(index["componentType"], 5125);
    const auto start = json["bufferViews"][index["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    for (std::size_t c = 0; c < 576 * 3; ++c) {
      std::uint32_t v = 0;
      std::memcpy(&v, bin.data() + start + 4 * c, 4);
      EXPECT_LT(v, count);
    }
  }
  // The root turns z up into y up and millimetres into metres.
  EXPECT_EQ(json["nodes"][0]["scale"], (Json{0.001, 0.001, 0.001}));
  const auto q = json["nodes"][0]["rotation"].get<std::vector<double>>();
  EXPECT_NEAR(q[0] * q[0] + q[3] * q[3], 1.0, 1e-12);
  EXPECT_NEAR(2.0 * (q[1] * q[2] - q[0] * q[3]), 1.0, 1e-12) << "the y component of the turned z axis";
}

TEST_F(Glb, PartsColoursAndNormalsReadBackEqual) {
  const TriMesh mesh = sample_mesh();
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.glb", mesh, {}, progress));
  const auto read = read_mesh(folder_ / "a.glb", progress);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->triangle_partition, mesh.triangle_partition);
  ASSERT_EQ(read->triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = read->triangles[t][c], b = mesh.triangles[t][c];
      EXPECT_EQ(read->positions[a], glm::vec3(mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[b]))));
      EXPECT_EQ(read->normals[a], mesh.normals[b]);
      EXPECT_EQ(read->colors[a], mesh.colors[b]) << "sRGB to linear and back";
    }
  const auto info = mesh_info(folder_ / "a.glb", progress);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->vertices, 576);
  EXPECT_EQ(info->triangles, 1152);
  EXPECT_NEAR(info->max_mm.x, (0.5 + 2.0 * 140.0) * 0.038, 1e-5);
  EXPECT_EQ(info->partitions[0].name, "tablet");
}

Json foreign() {
  return Json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"translation":[1,0,0],"children":[1]},{"mesh":0,"scale":[2,2,2]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":44}]})");
}

std::string foreign_bin() {
  std::string bin;
  for (const float f : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) append_little(bin, f);
  for (const int i : {0, 1, 2, 0}) append_little(bin, static_cast<std::uint16_t>(i));
  return bin;
}

TEST_F(Glb, ForeignNodeTreesAreAppliedAndMetresBecomeMillimetres) {
  SilentProgress progress;
  const auto mesh = parse_glb(glb_of(foreign(), foreign_bin()), progress);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh->positions[1], glm::vec3(3000.0f, 0.0f, 0.0f));
  EXPECT_EQ(mesh->positions[2], glm::vec3(1000.0f, 2000.0f, 0.0f));
}

TEST_F(Glb, LiesAreRefusedWithASentence) {
  SilentProgress progress;
  const auto says = [&](const char* pointer, const Json& value) {
    Json json = foreign();
    json[Json::json_pointer(pointer)] = value;
    const auto mesh = parse_glb(glb_of(json, foreign_bin()), progress);
    if (mesh) return std::string("accepted");
    EXPECT_EQ(mesh.error().kind, ErrorKind::kBadData);
    return mesh.error().message;
  };
  EXPECT_THAT(says("/accessors/0/count", 4), HasSubstr("outside its buffer view"));
  EXPECT_THAT(says("/accessors/0/count", 1099511627776), HasSubstr("outside its buffer view"));
  EXPECT_THAT(says("/accessors/0/count", -1), HasSubstr("broken"));
  EXPECT_THAT(says("/bufferViews/1/byteOffset", 44), HasSubstr("outside the data"));
  EXPECT_THAT(says("/bufferViews/0/byteStride", 4), HasSubstr("buffer view is broken"));
  EXPECT_THAT(says("/accessors/1/componentType", 5126), HasSubstr("outside its buffer view"));
  EXPECT_THAT(says("/nodes/1/children", Json{0}), HasSubstr("not a tree"));
  EXPECT_THAT(says("/nodes/0/children", Json{7}), HasSubstr("not a tree"));
  EXPECT_THAT(says("/nodes/1/mesh", 3), HasSubstr("mesh that does not exist"));
  EXPECT_THAT(says("/nodes/0/translation", Json{1, 2}), HasSubstr("transform"));
  EXPECT_THAT(says("/meshes/0/primitives/0/mode", 7), HasSubstr("expected triangles"));
  EXPECT_THAT(says("/extensionsRequired", Json{"KHR_draco_mesh_compression"}), HasSubstr("KHR_draco"));
  EXPECT_THAT(says("/accessors/0/sparse", Json::object()), HasSubstr("sparse"));
  std::string bin = foreign_bin();
  bin[36] = 3;
  EXPECT_THAT(parse_glb(glb_of(foreign(), bin), progress).error().message, HasSubstr("vertex that does not exist"));
  Json crowd = foreign();
  for (int i = 2; i < 2000; ++i) {
    crowd["nodes"].push_back({{"mesh", 0}});
    crowd["nodes"][0]["children"].push_back(i);
  }
  EXPECT_TRUE(parse_glb(glb_of(crowd, foreign_bin()), progress)) << "sharing a mesh is allowed";
}

}  // namespace
}  // namespace dubsar
