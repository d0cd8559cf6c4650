// Files that say one thing and hold another: counts, ends, names, ranges of colours.

#include <gmock/gmock.h>

#include <fstream>

#include "core/mesh_io/mesh_io.h"
#include "core/mesh_io/text_encoding.h"
#include "tests/core/mesh_io/foreign_body.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {

using ::testing::HasSubstr;

class ForeignLies : public FileTest {
 protected:
  Result<TriMesh> read(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    SilentProgress progress;
    return read_mesh(folder_ / name, progress);
  }
  void expect_body(const std::string& name, const std::string& bytes) {
    const auto mesh = read(name, bytes);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 8u);
    EXPECT_TRUE(check_mesh(mesh->positions, mesh->triangles).watertight());
    EXPECT_NEAR(foreign::volume_of(*mesh), 4000.0, 1.0);
  }
  std::string says(const std::string& name, const std::string& bytes) {
    const auto mesh = read(name, bytes);
    return mesh ? "accepted" : mesh.error().message;
  }
};

/// `vertex` is told the number of the vertex and its coordinates, `corner` the number of a vertex of a face.
template <class Vertex, class Corner>
std::string obj(Vertex&& vertex, Corner&& corner, const std::string& face = "f") {
  std::string out;
  for (std::size_t v = 0; v < foreign::kCorners.size(); ++v) {
    const glm::dvec3& p = foreign::kCorners[v];
    out += vertex(v, fmt::format("v {} {} {}", p.x, p.y, p.z)) + "\n";
  }
  for (const auto& f : foreign::kFaces) {
    out += face;
    for (const std::uint32_t v : f) out += " " + corner(v + 1);
    out += "\n";
  }
  return out;
}
const auto kAsIs = [](std::size_t, const std::string& line) { return line; };
const auto kNumber = [](std::uint32_t v) { return std::to_string(v); };

TEST_F(ForeignLies, FoldersOfWindowsAreNoLineThatGoesOn) {
  const std::string body = obj(kAsIs, kNumber);
  for (const char* line : {"# C:\\scans\\", "mtllib C:\\scans\\", "usemtl a\\", "o clay\\", "g clay\\"})
    expect_body("a.obj", std::string(line) + "\n" + body);
  // These go on, with blanks behind the sign or without.
  for (const char* end : {" \\\n", "\\\n", " \\ \n", " \\\t\r\n"}) {
    std::string split = body;
    for (std::size_t at = 0; (at = split.find("f ", at)) != std::string::npos; at += 5)
      split.replace(split.find(' ', at + 2), 1, std::string(end) + " ");
    expect_body("a.obj", split);
  }
}

TEST_F(ForeignLies, CornersOfObjWithoutANormalSayItInThreeWays) {
  for (const char* behind : {"//", "/0/0", "/", "//0"})
    expect_body("a.obj", "vt 0 0\n" + obj(kAsIs, [&](std::uint32_t v) { return std::to_string(v) + behind; }));
  EXPECT_THAT(says("a.obj", obj(kAsIs, [](std::uint32_t v) { return std::to_string(v) + "//x"; })),
              HasSubstr("expected normal numbers that exist"));
  expect_body("a.obj", obj(kAsIs, kNumber, "fo"));
}

TEST_F(ForeignLies, SevenNumbersOfAnObjVertexAreColourAndOneMore) {
  const auto colored = [](const std::string& before, const std::string& behind) {
    return obj(
        [&](std::size_t v, const std::string& line) {
          return line + before + fmt::format(" {} 0.2 {}", v == 0 ? 1.0 : 0.4, v == 1 ? 1.0 : 0.6) + behind;
        },
        kNumber);
  };
  for (const auto& text : {colored("", ""), colored("", " 1"), colored(" 1", ""), colored(" 1.0", "")}) {
    const auto mesh = read("a.obj", text);
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->colors.size(), 6u);
    EXPECT_EQ(mesh->colors[0], (std::array<std::uint8_t, 3>{255, 51, 153}));
    EXPECT_EQ(mesh->colors[1], (std::array<std::uint8_t, 3>{102, 51, 255}));
  }
}

std::string stl(std::uint32_t announced, std::uint16_t numbered = 0) {
  std::string out(80, ' ');
  out[0] = '\1';
  out += foreign::little(announced, 4);
  for (const auto& f : foreign::kFaces) {
    out += std::string(12, '\0');
    for (const std::uint32_t v : f)
      for (int a = 0; a < 3; ++a) out += foreign::little(static_cast<float>(foreign::kCorners[v][a]));
    out += foreign::little(numbered, 2);
  }
  return out;
}

TEST_F(ForeignLies, WhatStandsBehindStlTrianglesIsWasteOnlyWhereItCannotBeTriangles) {
  expect_body("a.stl", stl(8));
  expect_body("a.stl", stl(8, 0x801F));
  for (const std::string& waste : {std::string("abc"), std::string(49, 'x'), std::string(512, '\0')})
    expect_body("a.stl", stl(8) + waste);
  for (const std::uint32_t announced : {0u, 7u, 9u, 0xFFFFFFFFu})
    EXPECT_THAT(says("a.stl", stl(announced)), HasSubstr("cut or damaged")) << announced;
  EXPECT_THAT(says("a.stl", std::string(200, 'x')), HasSubstr("a text that does not begin with \"solid\""));

  const auto as_is = [](const std::string& word) { return word; };
  expect_body("a.stl", foreign::stl_text({}, 1.0, as_is) + std::string(100, '\0'));
  expect_body("a.stl", foreign::stl_text({}, 1.0, as_is) + "\x1A");
}

std::string ply(const std::string& properties, const std::string& values, const std::string& list = "vertex_indices",
                int vertices = 6) {
  std::string out = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
      "element face 8\nproperty list uchar int {}\nend_header\n",
      vertices, properties, list);
  for (const glm::dvec3& p : foreign::kCorners) out += fmt::format("{} {} {} {}\n", p.x, p.y, p.z, values);
  for (const auto& f : foreign::kFaces) out += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
  return out;
}

TEST_F(ForeignLies, ColoursOfPlyAreReadInTheRangeAndByTheNamesThatAreThere) {
  const auto named = [](const char* type, const std::array<const char*, 3>& names) {
    std::string out;
    for (const char* name : names) out += fmt::format("property {} {}\n", type, name);
    return out;
  };
  const std::array<const char*, 3> usual{"red", "green", "blue"};
  for (const auto& [properties, values] : std::vector<std::pair<std::string, std::string>>{
           {named("uchar", usual), "255 51 0"},
           {named("ushort", usual), "255 51 0"},
           {named("int", usual), "255 51 0"},
           {named("ushort", usual), "65535 13107 0"},
           {named("float", usual), "1 0.2 0"},
           {named("float", usual), "255 51 0"},
           {named("double", usual), "255.0 51.0 0"},
           {named("uchar", {"diffuse_red", "diffuse_green", "diffuse_blue"}), "255 51 0"},
           {named("uchar", {"r", "g", "b"}), "255 51 0"}}) {
    const auto mesh = read("a.ply", ply(properties, values));
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->colors.size(), 6u) << properties;
    EXPECT_EQ(mesh->colors[3], (std::array<std::uint8_t, 3>{255, 51, 0})) << properties << values;
  }
}

TEST_F(ForeignLies, CountsAndNamesThatDoNotFitThePlyDataAreTold) {
  EXPECT_THAT(says("a.ply", ply("", "", "indices")), HasSubstr("8 items \"face\" found without"));
  // One vertex less than there is: its coordinates are taken for faces, here all of no corners.
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 8\nproperty list uchar int vertex_indices\nend_header\n";
  bytes += std::string(12 * 6, '\0');
  for (const auto& f : foreign::kFaces) {
    bytes += foreign::little(3, 1);
    for (const std::uint32_t v : f) bytes += foreign::little(v, 4);
  }
  EXPECT_THAT(says("a.ply", bytes), HasSubstr("of which none has 3 corners"));
}

TEST_F(ForeignLies, OtherFilesUnderTheNameOfAMeshAreNamed) {
  for (const char* name : {"a.obj", "a.stl", "a.ply", "a.glb"}) {
    EXPECT_THAT(says(name, "PK\x03\x04 and more"), HasSubstr("a ZIP archive found, expected a mesh; unpack it"));
    EXPECT_THAT(says(name, "\x1F\x8B\x08 and more"), HasSubstr("gzip"));
    EXPECT_THAT(says(name, "version https://git-lfs.github.com/spec/v1\n"), HasSubstr("git lfs pull"));
    EXPECT_THAT(says(name, "ISO-10303-21;\nHEADER;\n"), HasSubstr("STEP"));
    EXPECT_THAT(says(name, "\x89PNG\r\n\x1A\n"), HasSubstr("a picture found"));
    EXPECT_THAT(says(name, " {\"scene\":0, \"asset\":{\"version\":\"2.0\"}}"), HasSubstr("glTF as text (.gltf) found"));
  }
  EXPECT_THAT(says("a.gltf", "{\"asset\":{\"version\":\"2.0\"}}"), HasSubstr("glTF as text (.gltf) found"));
}

TEST_F(ForeignLies, LettersOfFourBytesAreLetters) {
  const std::string text = obj(kAsIs, kNumber);
  for (const bool big : {false, true}) {
    std::string wide = big ? std::string("\0\0\xFE\xFF", 4) : std::string("\xFF\xFE\0\0", 4);
    for (const char c : text) wide += big ? std::string{'\0', '\0', '\0', c} : std::string{c, '\0', '\0', '\0'};
    expect_body("a.obj", wide);
  }
  EXPECT_EQ(utf8_bytes(std::string("\xFF\xFE\0\0\x81\x20\x01\0\0\xD8\0\0\0\0\x11\0", 16)),
            "\xF0\x92\x82\x81\xEF\xBF\xBD\xEF\xBF\xBD");
}

}  // namespace
}  // namespace dubsar
