#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/files/buffered_writer.h"
#include "core/base/text/json_text.h"
#include "core/mesh_io/glb/glb_parts.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/mesh_text.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;

class Layout {
 public:
  explicit Layout(Json& json) : json_(json) {
    json_["accessors"] = Json::array();
    json_["bufferViews"] = Json::array();
  }
  /// Reserves the next bytes of the buffer and returns the number of the accessor.
  std::size_t add(std::size_t count, std::size_t item_bytes, int component, const char* type, int target) {
    Json view{{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", count * item_bytes}, {"target", target}};
    if (target == kGlArrayBuffer) view["byteStride"] = item_bytes;
    Json accessor{
        {"bufferView", json_["bufferViews"].size()}, {"componentType", component}, {"count", count}, {"type", type}};
    if (component == kGlUshort) accessor["normalized"] = true;
    json_["bufferViews"].push_back(std::move(view));
    json_["accessors"].push_back(std::move(accessor));
    bytes += count * item_bytes;
    return json_["accessors"].size() - 1;
  }
  std::uint64_t bytes = 0;

 private:
  Json& json_;
};

void append(BufferedWriter& out, const glm::vec3& v) {
  out.little(v.x);
  out.little(v.y);
  out.little(v.z);
}
}  // namespace

Result<void> write_glb(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress) {
  if (options.compress) return write_compressed_glb(path, mesh, options, progress);
  DUBSAR_TRY(check_tri_mesh(mesh));
  const OutputSpace space(mesh.frame, MeshUnits::kMm);
  const glm::dvec3 origin = space.far_origin(mesh);
  const auto place = [&](std::uint32_t v) { return glm::vec3(space.exact_position(mesh.positions[v]) - origin); };
  const VertexColors colors = output_colors(mesh);
  const std::vector<GlbPart> parts = glb_parts(mesh);

  Json json = glb_scene(mesh, colors.derived || options.colors_derived);
  Layout layout(json);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const GlbPart& part = parts[p];
    Json attributes;
    attributes["POSITION"] = layout.add(part.vertices.size(), 12, kGlFloat, "VEC3", kGlArrayBuffer);
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t v : part.vertices) {
      const glm::vec3 position = place(v);
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
    json["accessors"].back()["min"] = {low.x, low.y, low.z};
    json["accessors"].back()["max"] = {high.x, high.y, high.z};
    if (!mesh.normals.empty())
      attributes["NORMAL"] = layout.add(part.vertices.size(), 12, kGlFloat, "VEC3", kGlArrayBuffer);
    if (!colors.rgb.empty())
      attributes["COLOR_0"] = layout.add(part.vertices.size(), 8, kGlUshort, "VEC4", kGlArrayBuffer);
    const std::size_t indices = layout.add(part.triangles.size() * 3, 4, kGlUint, "SCALAR", kGlElementArrayBuffer);
    const std::string name = partition_name(mesh, part.id);
    json["meshes"].push_back(
        {{"name", name}, {"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}});
    json["nodes"].push_back({{"name", name}, {"mesh", p}, {"extras", {{"partition", part.id}}}});
    if (origin != glm::dvec3(0.0)) json["nodes"].back()["translation"] = {origin.x, origin.y, origin.z};
    json["nodes"][0]["children"].push_back(p + 1);
  }
  if (parts.empty())
    json.erase("accessors"), json.erase("bufferViews");
  else
    json["buffers"] = Json::array({{{"byteLength", layout.bytes}}});

  return write_glb_file(path, json, parts.empty() ? 0 : layout.bytes, [&](BufferedWriter& out) -> Result<void> {
    progress.begin("write glb", static_cast<std::int64_t>(parts.size()), "part");
    for (const GlbPart& part : parts) {
      for (const std::uint32_t v : part.vertices) append(out, place(v));
      if (progress.cancelled()) return cancelled_error();
      if (!mesh.normals.empty())
        for (const std::uint32_t v : part.vertices) append(out, space.normal(mesh.normals[v]));
      if (!colors.rgb.empty())
        for (const std::uint32_t v : part.vertices) {
          for (const std::uint8_t c : colors.rgb[v]) out.little(linear_u16(c));
          out.little(std::uint16_t{65535});
        }
      if (progress.cancelled()) return cancelled_error();
      for (const Triangle& t : part.triangles)
        for (const std::uint32_t v : t) out.little(v);
      progress.advance(1);
    }
    progress.end();
    return {};
  });
}

}  // namespace dubsar
