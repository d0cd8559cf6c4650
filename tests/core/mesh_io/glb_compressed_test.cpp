#include <gmock/gmock.h>
#include <meshoptimizer.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "core/base/progress.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A wavy sheet of two partitions, with normals and shades.
TriMesh sheet() {
  TriMesh mesh;
  constexpr std::uint32_t kSide = 60;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      mesh.positions.emplace_back(fx, fy, 3.0f * std::sin(0.2f * fx) * std::cos(0.15f * fy));
      mesh.normals.push_back(glm::normalize(glm::vec3(std::cos(fx), std::sin(fy), 1.0f)));
      mesh.shape.push_back(static_cast<std::uint8_t>((x * y) % 127));
    }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t v = y * kSide + x;
      mesh.triangles.push_back({v, v + 1, v + kSide});
      mesh.triangles.push_back({v + 1, v + kSide + 1, v + kSide});
      for (int i = 0; i < 2; ++i) mesh.triangle_partition.push_back(x < 30 ? 0 : 1);
    }
  mesh.partitions = {{0, "tablet", "", 0, 0, false}, {1, "envelope", "", 0, 0, false}};
  mesh.frame.input_voxel = {{0.04, 0.04, 0.04}, "test"};
  return mesh;
}

struct PackedGlb {
  Json json;
  std::string binary;
};
PackedGlb open_glb(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(word(8), bytes.size());
  return {Json::parse(bytes.substr(20, word(12))), bytes.substr(20 + word(12) + 8, word(20 + word(12)))};
}

/// The bytes of an accessor, unpacked by the reference decoder.
std::vector<unsigned char> unpacked(const PackedGlb& glb, std::size_t accessor) {
  const Json& view = glb.json["bufferViews"][glb.json["accessors"][accessor]["bufferView"].get<std::size_t>()];
  const Json& packed = view["extensions"]["EXT_meshopt_compression"];
  const std::size_t count = packed["count"], stride = packed["byteStride"], length = packed["byteLength"];
  const auto* from =
      reinterpret_cast<const unsigned char*>(glb.binary.data()) + packed["byteOffset"].get<std::size_t>();
  std::vector<unsigned char> bytes(count * stride);
  EXPECT_EQ(bytes.size(), view["byteLength"].get<std::size_t>());
  EXPECT_EQ(packed["mode"] == "TRIANGLES" ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, length)
                                          : meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, length),
            0);
  return bytes;
}

TEST(GlbCompressed, DecodesToTheSameSurfaceWithinHalfAStepAndIsAThirdOfTheSize) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_glbz_{}", ::getpid());
  fs::create_directories(folder);
  SilentProgress progress;
  const TriMesh mesh = sheet();
  MeshWriteOptions options;
  ASSERT_TRUE(write_mesh(folder / "plain.glb", mesh, options, progress));
  options.compress = true;
  const auto written = write_mesh(folder / "small.glb", mesh, options, progress);
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_LT(fs::file_size(folder / "small.glb"), fs::file_size(folder / "plain.glb") / 3);
  const PackedGlb glb = open_glb(folder / "small.glb");
  EXPECT_EQ(glb.json["extensionsRequired"], (Json{"KHR_mesh_quantization", "EXT_meshopt_compression"}));
  ASSERT_EQ(glb.json["meshes"].size(), 2u);
  std::size_t triangles = 0;
  const double step_mm = 0.04 / 16.0;
  for (std::size_t p = 0; p < 2; ++p) {
    const Json& primitive = glb.json["meshes"][p]["primitives"][0];
    const Json& node = glb.json["nodes"][p + 1];
    EXPECT_NEAR(node["scale"][0].get<double>(), step_mm, 1e-12);
    const auto bytes = unpacked(glb, primitive["attributes"]["POSITION"]);
    std::set<std::array<long, 3>> expected;  // grid points, exactly those that the part uses
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.triangle_partition[t] == p)
        for (const std::uint32_t v : mesh.triangles[t])
          expected.insert({std::lround(mesh.positions[v].x), std::lround(mesh.positions[v].y), long{v}});
    EXPECT_EQ(bytes.size() / 8, expected.size());
    for (std::size_t v = 0; v < bytes.size() / 8; ++v) {
      glm::dvec3 mm;
      for (int a = 0; a < 3; ++a) {
        std::uint16_t steps = 0;
        std::memcpy(&steps, bytes.data() + 8 * v + 2 * static_cast<std::size_t>(a), 2);
        mm[a] = node["translation"][static_cast<std::size_t>(a)].get<double>() + steps * step_mm;
      }
      const auto x = std::lround(mm.x / 0.04), y = std::lround(mm.y / 0.04);
      ASSERT_TRUE(x >= 0 && x < 60 && y >= 0 && y < 60);
      const glm::dvec3 wanted = 0.04 * glm::dvec3(mesh.positions[static_cast<std::size_t>(y * 60 + x)]);
      for (int a = 0; a < 3; ++a) ASSERT_NEAR(mm[a], wanted[a], 0.51 * step_mm);
    }
    const auto indices = unpacked(glb, primitive["indices"]);
    triangles += indices.size() / 12;
    for (std::size_t i = 0; i < indices.size(); i += 4) {
      std::uint32_t v = 0;
      std::memcpy(&v, indices.data() + i, 4);
      ASSERT_LT(v, bytes.size() / 8);
    }
    EXPECT_EQ(unpacked(glb, primitive["attributes"]["NORMAL"]).size(), bytes.size() / 2);
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  const auto ply = write_mesh(folder / "small.ply", mesh, options, progress);
  ASSERT_FALSE(ply);
  EXPECT_EQ(ply.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(ply.error().message, ::testing::HasSubstr("GLB"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar
