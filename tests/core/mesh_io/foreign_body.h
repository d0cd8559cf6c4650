#pragma once
// A closed body as programs of all kinds write it: an octahedron of 40 x 30 x 20, whose volume is 4000.

#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/mesh/mesh_check.h"
#include "core/mesh/tri_mesh.h"
#include "core/mesh_io/glb/glb_words.h"
#include "core/mesh_io/mesh_formats.h"

namespace dubsar::foreign {

using Json = nlohmann::json;

inline const std::array<glm::dvec3, 6> kCorners{
    {{20, 0, 0}, {-20, 0, 0}, {0, 15, 0}, {0, -15, 0}, {0, 0, 10}, {0, 0, -10}}};
inline const std::array<std::array<std::uint32_t, 3>, 8> kFaces{
    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

/// Of a closed mesh, mm3; positive where triangles are counter-clockwise seen from outside.
inline double volume_of(const TriMesh& mesh) {
  double sum = 0.0;
  const auto at = [&](std::uint32_t v) {
    return mesh.frame.grid_voxel_mm() * glm::dvec3(mesh.positions[v] - mesh.positions[mesh.triangles[0][0]]);
  };
  for (const Triangle& t : mesh.triangles) sum += glm::dot(at(t[0]), glm::cross(at(t[1]), at(t[2]))) / 6.0;
  return sum;
}

struct Extent {
  glm::dvec3 low, high;
  glm::dvec3 size() const { return high - low; }
};
inline Extent extent_of(const TriMesh& mesh) {
  Extent out{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (const glm::vec3& v : mesh.positions) {
    const glm::dvec3 p = mesh.frame.mm_from_grid(glm::dvec3(v));
    out.low = glm::min(out.low, p);
    out.high = glm::max(out.high, p);
  }
  return out;
}

inline std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int b = 0; b < bytes; ++b) out.push_back(static_cast<char>(value >> (8 * b) & 255));
  return out;
}
inline std::string little(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, 4);
  return little(bits, 4);
}

/// A GLB file that grows.
struct GlbMaker {
  Json json{{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", {0}}}})},
            {"nodes", Json::array({{{"mesh", 0}}})},
            {"meshes", Json::array({{{"primitives", Json::array({{{"attributes", Json::object()}}})}}})},
            {"accessors", Json::array()},
            {"bufferViews", Json::array()}};
  std::string bin{};

  Json& primitive() { return json["meshes"][0]["primitives"][0]; }
  std::size_t view(const std::string& bytes) {
    bin.resize((bin.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}});
    bin += bytes;
    return json["bufferViews"].size() - 1;
  }
  std::size_t accessor(const std::string& bytes, std::size_t count, int component, const char* type) {
    const std::size_t number = view(bytes);
    json["accessors"].push_back(
        {{"bufferView", number}, {"componentType", component}, {"count", count}, {"type", type}});
    return json["accessors"].size() - 1;
  }
  std::size_t floats(const std::vector<glm::dvec3>& values) {
    std::string bytes;
    for (const glm::dvec3& v : values)
      for (int a = 0; a < 3; ++a) bytes += little(static_cast<float>(v[a]));
    return accessor(bytes, values.size(), 5126, "VEC3");
  }
  std::size_t floats(const std::vector<glm::dvec2>& values) {
    std::string bytes;
    for (const glm::dvec2& v : values)
      for (int a = 0; a < 2; ++a) bytes += little(static_cast<float>(v[a]));
    return accessor(bytes, values.size(), 5126, "VEC2");
  }
  std::size_t indices(const std::vector<std::uint32_t>& values) {
    std::string bytes;
    for (const std::uint32_t v : values) bytes += little(v, 2);
    return accessor(bytes, values.size(), 5123, "SCALAR");
  }
  std::string file() const {
    Json all = json;
    std::string data = bin;
    data.resize((data.size() + 3) / 4 * 4);
    all["buffers"] = Json::array({{{"byteLength", data.size()}}});
    if (all.contains("extra_buffer")) {
      all["buffers"].push_back(all["extra_buffer"]);
      all.erase("extra_buffer");
    }
    std::string text = all.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return little(kGlbMagic, 4) + little(2, 4) + little(28 + text.size() + data.size(), 4) + little(text.size(), 4) +
           little(kGlbJsonChunk, 4) + text + little(data.size(), 4) + little(kGlbBinChunk, 4) + data;
  }
};

/// In metres, so that it measures 40 x 30 x 20 mm.
inline std::vector<glm::dvec3> corners_m(double scale = 1e-3) {
  std::vector<glm::dvec3> out;
  for (const glm::dvec3& p : kCorners) out.push_back(scale * p);
  return out;
}
inline std::vector<std::uint32_t> face_indices() {
  std::vector<std::uint32_t> out;
  for (const auto& f : kFaces) out.insert(out.end(), f.begin(), f.end());
  return out;
}
inline GlbMaker plain_glb() {
  GlbMaker out;
  out.primitive()["attributes"]["POSITION"] = out.floats(corners_m());
  out.primitive()["indices"] = out.indices(face_indices());
  return out;
}

inline std::string obj_text(const glm::dvec3& at = glm::dvec3(0.0), double scale = 1.0, const char* end = "\n") {
  std::string out = "# made by hand";
  out += end;
  for (const glm::dvec3& p : kCorners) {
    const glm::dvec3 q = at + scale * p;
    out += fmt::format("v {:.4f} {:.4f} {:.4f}{}", q.x, q.y, q.z, end);
  }
  for (const auto& f : kFaces) out += fmt::format("f {} {} {}{}", f[0] + 1, f[1] + 1, f[2] + 1, end);
  return out;
}

/// Every word through `spelled`.
template <class Spell>
std::string stl_text(const glm::dvec3& at, double scale, Spell&& spelled) {
  std::string out = spelled("solid") + " body\n";
  for (const auto& f : kFaces) {
    out += spelled("facet") + " " + spelled("normal") + " 0 0 0\n " + spelled("outer") + " " + spelled("loop") + "\n";
    for (const std::uint32_t v : f) {
      const glm::dvec3 q = at + scale * kCorners[v];
      out += fmt::format("  {} {:.4f} {:.4f} {:.4f}\n", spelled("vertex"), q.x, q.y, q.z);
    }
    out += " " + spelled("endloop") + "\n" + spelled("endfacet") + "\n";
  }
  return out + spelled("endsolid") + " body\n";
}

/// The mesh of a file that must be readable.
inline TriMesh read(const GlbMaker& maker, const MeshReadOptions& options = {}) {
  SilentProgress progress;
  auto mesh = parse_glb(maker.file(), progress, options);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : TriMesh();
}

}  // namespace dubsar::foreign
