// PLY, STL and OBJ as other programs, editors and web servers leave them.

#include <gmock/gmock.h>

#include <fstream>

#include "core/mesh_io/mesh_io.h"
#include "core/mesh_io/text_encoding.h"
#include "tests/core/mesh_io/foreign_body.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {

using ::testing::HasSubstr;

class ForeignText : public FileTest {
 protected:
  Result<TriMesh> read(const std::string& name, const std::string& bytes, const MeshReadOptions& options = {}) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    SilentProgress progress;
    return read_mesh(folder_ / name, progress, options);
  }
  void expect_body(const std::string& name, const std::string& bytes, double scale = 1.0) {
    const auto mesh = read(name, bytes);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions.size(), 6u);
    EXPECT_EQ(mesh->triangles.size(), 8u);
    EXPECT_TRUE(check_mesh(mesh->positions, mesh->triangles).watertight());
    EXPECT_NEAR(foreign::volume_of(*mesh) / std::pow(scale, 3), 4000.0, 1.0);
  }
  std::string says(const std::string& name, const std::string& bytes) {
    const auto mesh = read(name, bytes);
    return mesh ? "accepted" : mesh.error().message;
  }
};

std::string utf16(const std::string& text, bool big, bool mark) {
  std::string out = mark ? (big ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : text) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

std::string ply_text(const char* end = "\n") {
  std::string out;
  const auto line = [&](const std::string& text) { out += text + end; };
  for (const char* head :
       {"ply", "format ascii 1.0", "element vertex 6", "property float x", "property float y", "property float z",
        "element face 8", "property list uchar int vertex_indices", "end_header"})
    line(head);
  for (const glm::dvec3& p : foreign::kCorners) line(fmt::format("{} {} {}", p.x, p.y, p.z));
  for (const auto& f : foreign::kFaces) line(fmt::format("3 {} {} {}", f[0], f[1], f[2]));
  return out;
}

TEST_F(ForeignText, ByteOrderMarksAndWideLettersAreNoPartOfTheText) {
  const auto as_is = [](const std::string& word) { return word; };
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.obj", foreign::obj_text()}, {"a.ply", ply_text()}, {"a.stl", foreign::stl_text({}, 1.0, as_is)}}) {
    expect_body(name, text);
    expect_body(name, "\xEF\xBB\xBF" + text);
    for (const bool big : {false, true})
      for (const bool mark : {false, true}) expect_body(name, utf16(text, big, mark));
  }
  // No comment before the first vertex: the mark would take it away.
  expect_body("b.obj", "\xEF\xBB\xBF" + foreign::obj_text().substr(foreign::obj_text().find('v')));
}

TEST(TextEncoding, LettersBeyondAsciiKeepTheirCodes) {
  EXPECT_EQ(utf8_bytes(std::string("\xFF\xFE\xE4\0\x61\x01\x08\xD8\x79\xDC", 10)), "\xC3\xA4\xC5\xA1\xF0\x92\x81\xB9");
  EXPECT_EQ(utf8_bytes(std::string("\xFE\xFF\x20\xAC", 4)), "\xE2\x82\xAC");
  EXPECT_EQ(utf8_bytes(std::string("\xFF\xFE\x08\xD8", 4)), "\xEF\xBF\xBD") << "half a pair";
  EXPECT_EQ(utf8_bytes("v 1 2 3"), "v 1 2 3");
  EXPECT_EQ(utf8_bytes(""), "");
}

TEST_F(ForeignText, LinesEndInAnyWay) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    expect_body("a.obj", foreign::obj_text({}, 1.0, end));
    expect_body("a.ply", ply_text(end));
  }
}

/// Binary, little endian; `first` is the x of the first vertex, and all others are moved with it.
std::string ply_bytes(const char* end, float first) {
  std::string out;
  for (const char* head :
       {"ply", "format binary_little_endian 1.0", "element vertex 6", "property float x", "property float y",
        "property float z", "element face 8", "property list uchar int vertex_indices", "end_header"})
    out += std::string(head) + end;
  for (const glm::dvec3& p : foreign::kCorners)
    for (int a = 0; a < 3; ++a)
      out += foreign::little(a == 0 ? static_cast<float>(p.x) - 20.0f + first : static_cast<float>(p[a]));
  for (const auto& f : foreign::kFaces) {
    out += foreign::little(3, 1);
    for (const std::uint32_t v : f) out += foreign::little(v, 4);
  }
  return out;
}

TEST_F(ForeignText, TheFirstByteOfPlyDataIsNoLineEnd) {
  for (const std::uint32_t bits : {0x41A0000Au, 0x41A0000Du, 0x41A00A0Du, 0x41A00020u}) {
    float first = 0.0f;
    std::memcpy(&first, &bits, 4);  // 20.00002 and the like: its first byte is LF, CR, CR before LF, a blank
    for (const char* end : {"\n", "\r\n", "\r"}) expect_body("a.ply", ply_bytes(end, first));
  }
}

TEST_F(ForeignText, StlWordsAreReadInLargeLettersAndInTwoWords) {
  const auto upper = [](std::string word) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::toupper(c); });
    return word;
  };
  const auto mixed = [](std::string word) {
    word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    return word;
  };
  const auto apart = [](const std::string& word) { return word.starts_with("end") ? "end " + word.substr(3) : word; };
  expect_body("a.stl", foreign::stl_text({}, 1.0, upper));
  expect_body("a.stl", foreign::stl_text({}, 1.0, mixed));
  expect_body("a.stl", foreign::stl_text({}, 1.0, apart));
  expect_body("a.stl", foreign::stl_text({}, 1.0, [&](const std::string& word) { return upper(apart(word)); }));
  expect_body("a.stl", "\n\t " + foreign::stl_text({}, 1.0, apart));
  expect_body("noname", foreign::stl_text({}, 1.0, upper));
}

TEST_F(ForeignText, SurveyCoordinatesKeepTheShape) {
  const auto as_is = [](const std::string& word) { return word; };
  const glm::dvec3 far(500123.0, 4187234.0, 100.0);
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.obj", foreign::obj_text(far, 0.01)}, {"a.stl", foreign::stl_text(far, 0.01, as_is)}}) {
    expect_body(name, text, 0.01);
    const auto mesh = read(name, text);
    EXPECT_NEAR(foreign::extent_of(*mesh).high.x, far.x + 0.2, 1e-4);
    EXPECT_NEAR(foreign::extent_of(*mesh).low.y, far.y - 0.15, 1e-4);
    EXPECT_NEAR(foreign::extent_of(*mesh).size().z, 0.2, 1e-6);
    // On to other files: at the same place where they can say it, else of the same shape.
    SilentProgress progress;
    for (const char* out : {"b.ply", "b.obj", "b.glb", "c.glb", "b.stl"}) {
      MeshWriteOptions options;
      options.compress = out[0] == 'c';
      ASSERT_TRUE(write_mesh(folder_ / out, *mesh, options, progress));
      const auto back = read_mesh(folder_ / out, progress);
      ASSERT_TRUE(back) << out << back.error().message;
      EXPECT_NEAR(foreign::extent_of(*back).size().y, 0.3, 1e-5) << out;
      EXPECT_NEAR(foreign::volume_of(*back), 4000e-6, 4e-6) << out;
      if (out[2] != 's') {
        EXPECT_NEAR(foreign::extent_of(*back).high.x, far.x + 0.2, 1e-4) << out;
      }
    }
  }
  const auto near = read("a.obj", foreign::obj_text({7, 8, 9}));
  EXPECT_EQ(near->frame.origin_vox, glm::dvec3(0.0)) << "ordinary coordinates stay numbers of the file";
}

TEST_F(ForeignText, PagesOfTheWebAreNoSurfaces) {
  for (const char* page : {"<!DOCTYPE html>\n<html><body>v 1 2 3</body></html>", "<html>\nv 1 2 3\nf 1 1 1\n",
                           "\n  <?xml version=\"1.0\"?><COLLADA/>", "<HEAD><title>404</title>"})
    for (const char* name : {"a.obj", "a.stl", "a.ply", "a.glb"})
      EXPECT_THAT(says(name, page), HasSubstr("web page")) << name;
  EXPECT_THAT(says("a.obj", "Not Found\n"), HasSubstr("\"Not Found\" found, expected a line of an OBJ file"));
  EXPECT_THAT(says("a.obj", "{\"error\": 404}"), HasSubstr("JSON found"));
  EXPECT_THAT(says("a.obj", "# only a comment\n"), HasSubstr("without a vertex"));
  EXPECT_THAT(says("a.obj", "g nothing\n"), HasSubstr("without a vertex"));
  // Words of the format that carry no shape, and strange ones behind vertices, leave the surface.
  expect_body("a.obj",
              "mtllib a.mtl\no body\ng all\ns off\n" + foreign::obj_text() + "usemtl clay\nl 1 2\nstrange 7\n");
}

TEST_F(ForeignText, ColoursOfObjAreSharesOrBytes) {
  for (const double scale : {1.0, 255.0}) {
    std::string text;
    for (std::size_t v = 0; v < 6; ++v)
      text += fmt::format("v {} {} {} {:.6f} {:.6f} {:.6f}\n", foreign::kCorners[v].x, foreign::kCorners[v].y,
                          foreign::kCorners[v].z, scale, scale * 0.2, scale * static_cast<double>(v) / 5);
    for (const auto& f : foreign::kFaces) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    const auto mesh = read("a.obj", text);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->colors[5], (std::array<std::uint8_t, 3>{255, 51, 255})) << scale;
  }
}

TEST_F(ForeignText, TrianglesWithVerticesOfTheirOwnAreJoined) {
  std::string obj, ply =
                       "ply\nformat ascii 1.0\nelement vertex 24\nproperty double x\nproperty double y\n"
                       "property double z\nelement face 8\nproperty list uchar uint vertex_index\nend_header\n";
  std::string faces;
  int next = 0;
  for (const auto& f : foreign::kFaces) {
    for (const std::uint32_t v : f) {
      const glm::dvec3& p = foreign::kCorners[v];
      obj += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
      ply += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    }
    obj += "f -3 -2 -1\n";
    faces += fmt::format("3 {} {} {}\n", next, next + 1, next + 2);
    next += 3;
  }
  expect_body("a.obj", obj);
  expect_body("a.ply", ply + faces);
}

TEST_F(ForeignText, StripsOfPlyAreTriangles) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  for (const glm::dvec3& p : foreign::kCorners) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  // Each strip of four: two faces that share an edge; -1 between them.
  expect_body("a.ply", text + "19 4 0 2 5 -1 4 2 1 5 -1 4 1 3 5 -1 4 3 0 5\n");
  EXPECT_THAT(says("a.ply", text + "3 0 1 6\n"), HasSubstr("vertex 6"));
}

TEST_F(ForeignText, PointCloudsAreToldWithTheirBox) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n";
  for (const glm::dvec3& p : foreign::kCorners) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  std::ofstream(folder_ / "a.ply") << text;
  SilentProgress progress;
  const auto info = mesh_info(folder_ / "a.ply", progress);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->triangles, 0);
  EXPECT_EQ(info->max_mm - info->min_mm, glm::dvec3(40, 30, 20));
}

TEST_F(ForeignText, AUnitIsTakenAtItsWordWhereTheFileHasNone) {
  SilentProgress progress;
  const auto metres = read("a.obj", foreign::obj_text({}, 1e-3), {.unit_mm = 1000.0});
  ASSERT_TRUE(metres);
  EXPECT_NEAR(foreign::extent_of(*metres).size().x, 40.0, 0.1);
  EXPECT_NEAR(foreign::volume_of(*metres), 4000.0, 20.0);
  foreign::GlbMaker maker;
  maker.primitive()["attributes"]["POSITION"] = maker.floats(foreign::corners_m(1.0));
  maker.primitive()["indices"] = maker.indices(foreign::face_indices());
  const auto told = read("a.glb", maker.file(), {.unit_mm = 1.0});
  ASSERT_TRUE(told);
  EXPECT_NEAR(foreign::extent_of(*told).size().x, 40.0, 1e-3) << "a glTF file whose numbers are mm";
  EXPECT_NEAR(foreign::extent_of(*read("a.glb", maker.file())).size().x, 40000.0, 1e-1) << "metres, as the format says";
  ASSERT_TRUE(write_mesh(folder_ / "ours.ply", sample_mesh(), {}, progress));
  const auto ours = read_mesh(folder_ / "ours.ply", progress, MeshReadOptions{.unit_mm = 10.0});
  ASSERT_FALSE(ours);
  EXPECT_EQ(ours.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
