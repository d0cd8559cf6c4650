// Photographs on surfaces in glTF files: which colour each vertex gets.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "core/image_io/png_file.h"
#include "core/mesh_io/mesh_formats.h"
#include "tests/core/mesh_io/foreign_body.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {

using foreign::GlbMaker;
using foreign::Json;

/// A square of 2 x 2 with a picture of 8 x 4 on it.
struct Picture {
  Image image{8, 4, 3};
  std::string png;
  explicit Picture(const std::filesystem::path& folder) {
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x) {
        std::uint8_t* const p = image.at(x, y);
        p[0] = static_cast<std::uint8_t>(30 * x), p[1] = static_cast<std::uint8_t>(60 * y), p[2] = 100;
      }
    EXPECT_TRUE(write_png(folder / "p.png", image));
    std::ifstream in(folder / "p.png", std::ios::binary);
    png.assign(std::istreambuf_iterator<char>(in), {});
  }
};

GlbMaker square_with(const Picture& picture, const std::vector<glm::dvec2>& uv) {
  GlbMaker maker;
  maker.primitive()["attributes"]["POSITION"] =
      maker.floats(std::vector<glm::dvec3>{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  maker.primitive()["attributes"]["TEXCOORD_0"] = maker.floats(uv);
  maker.primitive()["indices"] = maker.indices({0, 1, 2, 0, 2, 3});
  maker.primitive()["material"] = 0;
  maker.json["images"] = Json::array({{{"bufferView", maker.view(picture.png)}, {"mimeType", "image/png"}}});
  maker.json["textures"] = Json::array({{{"source", 0}}});
  maker.json["materials"] = Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  return maker;
}

/// Nearest vertex of the mesh to a place of the square, 0..1.
std::array<std::uint8_t, 3> color_at(const TriMesh& mesh, double x, double y) {
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double d = glm::distance(glm::dvec3(mesh.positions[v]), glm::dvec3(2000 * x, 2000 * y, 0));
    if (d < least) least = d, best = v;
  }
  return mesh.colors[best];
}

TEST_F(FileTest, APhotographColoursTheVerticesAndIsKeptWholeWhereItIsAskedFor) {
  const Picture picture(folder_);
  // The lower side of the square has v = 1: the last row of the picture.
  const GlbMaker maker = square_with(picture, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  const TriMesh coarse = read(maker), fine = read(maker, {.photo_detail = true});
  EXPECT_EQ(coarse.positions.size(), 4u);
  ASSERT_EQ(coarse.colors.size(), 4u);
  EXPECT_GT(fine.triangles.size(), 16u);
  ASSERT_EQ(fine.colors.size(), fine.positions.size());
  EXPECT_EQ(check_mesh(fine.positions, fine.triangles).boundary_edges % 4, 0);
  EXPECT_EQ(check_mesh(fine.positions, fine.triangles).nonmanifold_edges, 0);
  for (const glm::vec3& p : fine.positions) EXPECT_EQ(p.z, 0.0f);
  // The pixel under each vertex, between its neighbours: colours are linear along rows and columns.
  for (double x : {0.25, 0.5, 0.75})
    for (double y : {0.25, 0.5, 0.75}) {
      const auto color = color_at(fine, x, y);
      EXPECT_NEAR(color[0], 30 * (8 * x - 0.5), 40) << x << " " << y;
      EXPECT_NEAR(color[1], 60 * (4 * (1 - y) - 0.5), 60) << x << " " << y;
      EXPECT_NEAR(color[2], 100, 2);
    }
  EXPECT_LT(color_at(fine, 0.25, 0.5)[0], color_at(fine, 0.75, 0.5)[0]);
  EXPECT_GT(color_at(fine, 0.5, 0.25)[1], color_at(fine, 0.5, 0.75)[1]);
}

TEST_F(FileTest, PhotographsAreMovedWrappedAndMixedAsTheMaterialSays) {
  const Picture picture(folder_);
  // All four vertices at the middle of one pixel.
  const auto seen = [&](const glm::dvec2& uv, const std::function<void(GlbMaker&)>& change) {
    GlbMaker maker = square_with(picture, {uv, uv, uv, uv});
    change(maker);
    const TriMesh mesh = read(maker);
    EXPECT_EQ(mesh.colors.size(), 4u);
    return mesh.colors.empty() ? std::array<std::uint8_t, 3>{} : mesh.colors[0];
  };
  const auto pixel = [](int x, int y) { return glm::dvec2((x + 0.5) / 8, (y + 0.5) / 4); };
  const auto as = [&](int x, int y) {
    const std::uint8_t* p = picture.image.at(x, y);
    return std::array<std::uint8_t, 3>{p[0], p[1], p[2]};
  };
  EXPECT_EQ(seen(pixel(3, 1), [](GlbMaker&) {}), as(3, 1));
  EXPECT_EQ(seen(pixel(3, 1) + glm::dvec2(-2, 5), [](GlbMaker&) {}), as(3, 1)) << "repeats unless it is said";
  const auto wrap = [](int mode) {
    return [mode](GlbMaker& m) {
      m.json["samplers"] = Json::array({{{"wrapS", mode}, {"wrapT", mode}}});
      m.json["textures"][0]["sampler"] = 0;
    };
  };
  EXPECT_EQ(seen({1.7, -0.4}, wrap(33071)), as(7, 0));
  EXPECT_EQ(seen(pixel(3, 1) + glm::dvec2(1, 1), wrap(33648)), as(4, 2));
  const auto moved = [](const Json& how) {
    return [how](GlbMaker& m) {
      m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = how;
    };
  };
  EXPECT_EQ(seen(pixel(0, 0) * 2.0, moved({{"scale", {0.5, 0.5}}, {"offset", {0.5, 0.25}}})), as(4, 1));
  const auto factor = [](const Json& f) {
    return [f](GlbMaker& m) { m.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = f; };
  };
  EXPECT_EQ(seen(pixel(5, 2), factor({1, 0, 1, 1})), (std::array<std::uint8_t, 3>{150, 0, 100}));
  const auto older = [](GlbMaker& m) {
    m.json["materials"] = Json::array(
        {{{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", {{"index", 0}}}}}}}}});
  };
  EXPECT_EQ(seen(pixel(6, 3), older), as(6, 3));
  const auto second = [&](GlbMaker& m) {
    m.primitive()["attributes"]["TEXCOORD_1"] = m.floats(std::vector<glm::dvec2>(4, pixel(2, 2)));
    m.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  };
  EXPECT_EQ(seen(pixel(6, 3), second), as(2, 2));
}

TEST_F(FileTest, APhotographThatCannotBeReadLeavesTheSurface) {
  const Picture picture(folder_);
  for (const std::string& bytes : {std::string("RIFFxxxxWEBP"), picture.png.substr(0, 40), std::string()}) {
    Picture other = picture;
    other.png = bytes.empty() ? "x" : bytes;
    const TriMesh mesh = read(square_with(other, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}), {.photo_detail = true});
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_TRUE(mesh.colors.empty());
  }
}

}  // namespace
}  // namespace dubsar
