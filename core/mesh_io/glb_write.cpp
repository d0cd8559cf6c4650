#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/buffered_writer.h"
#include "core/base/json_text.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/mesh_text.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr int kFloat = 5126, kUint = 5125, kUshort = 5123, kArrayBuffer = 34962, kElementArrayBuffer = 34963;

/// One partition with vertices of its own, in mm.
struct Part {
  PartitionId id = 0;
  std::vector<std::uint32_t> vertices;  ///< ids in the mesh
  std::vector<Triangle> triangles;      ///< local ids
};

std::vector<Part> split(const TriMesh& mesh) {
  std::vector<Part> parts;
  std::vector<std::uint32_t> local(mesh.positions.size());
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id) {
    std::fill(local.begin(), local.end(), std::numeric_limits<std::uint32_t>::max());
    Part part;
    part.id = id;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (mesh.partition_of(i) != id) continue;
      const Triangle& t = mesh.triangles[i];
      Triangle moved;
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t& slot = local[t[c]];
        if (slot == std::numeric_limits<std::uint32_t>::max()) {
          slot = static_cast<std::uint32_t>(part.vertices.size());
          part.vertices.push_back(t[c]);
        }
        moved[c] = slot;
      }
      part.triangles.push_back(moved);
    }
    if (!part.triangles.empty()) parts.push_back(std::move(part));
    if (mesh.triangle_partition.empty()) break;
  }
  return parts;
}

/// glTF vertex colours are linear light, our bytes are sRGB.
std::uint16_t linear_u16(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(linear * 65535.0));
}

class Layout {
 public:
  explicit Layout(Json& json) : json_(json) {
    json_["accessors"] = Json::array();
    json_["bufferViews"] = Json::array();
  }
  /// Reserves the next bytes of the buffer and returns the number of the accessor.
  std::size_t add(std::size_t count, std::size_t item_bytes, int component, const char* type, int target) {
    Json view{{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", count * item_bytes}, {"target", target}};
    if (target == kArrayBuffer) view["byteStride"] = item_bytes;
    Json accessor{
        {"bufferView", json_["bufferViews"].size()}, {"componentType", component}, {"count", count}, {"type", type}};
    if (component == kUshort) accessor["normalized"] = true;
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
  DUBSAR_TRY(check_tri_mesh(mesh));
  const OutputSpace space(mesh.frame, MeshUnits::kMm);
  const VertexColors colors = output_colors(mesh);
  const bool derived = colors.derived || options.colors_derived;
  const std::vector<Part> parts = split(mesh);

  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "dubsar"}};
  json["asset"]["extras"] = {{"dubsar", mesh_text_lines(mesh, {MeshUnits::kMm}, derived)}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", {0}}}});
  // Grid millimetres with z up to metres with y up, as glTF wants; the data keep millimetres.
  Json root{
      {"name", "scan"}, {"scale", {0.001, 0.001, 0.001}}, {"rotation", {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}};
  json["materials"] = Json::array({{{"name", "clay"},
                                    {"doubleSided", true},
                                    {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}}});
  json["nodes"] = Json::array({nullptr});
  Layout layout(json);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    Json attributes;
    attributes["POSITION"] = layout.add(part.vertices.size(), 12, kFloat, "VEC3", kArrayBuffer);
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t v : part.vertices) {
      const glm::vec3 position = space.position(mesh.positions[v]);
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
    json["accessors"].back()["min"] = {low.x, low.y, low.z};
    json["accessors"].back()["max"] = {high.x, high.y, high.z};
    if (!mesh.normals.empty())
      attributes["NORMAL"] = layout.add(part.vertices.size(), 12, kFloat, "VEC3", kArrayBuffer);
    if (!colors.rgb.empty()) attributes["COLOR_0"] = layout.add(part.vertices.size(), 8, kUshort, "VEC4", kArrayBuffer);
    const std::size_t indices = layout.add(part.triangles.size() * 3, 4, kUint, "SCALAR", kElementArrayBuffer);
    const std::string name = partition_name(mesh, part.id);
    json["meshes"].push_back(
        {{"name", name}, {"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}});
    json["nodes"].push_back({{"name", name}, {"mesh", p}, {"extras", {{"partition", part.id}}}});
    root["children"].push_back(p + 1);
  }
  json["nodes"][0] = std::move(root);
  if (parts.empty())
    json.erase("accessors"), json.erase("bufferViews");
  else
    json["buffers"] = Json::array({{{"byteLength", layout.bytes}}});

  std::string text = dump_json(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + text.size() + (parts.empty() ? 0 : 8 + layout.bytes);
  if (total > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::kUsage, "glb: {} bytes do not fit the 4 GiB of the format; export one partition or use PLY",
                total);
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path, static_cast<std::int64_t>(total)));
  BufferedWriter out(file);
  for (const std::uint32_t word : {kMagic, std::uint32_t{2}, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(text.size()), kJsonChunk})
    out.little(word);
  out.text(text);
  if (!parts.empty()) {
    out.little(static_cast<std::uint32_t>(layout.bytes));
    out.little(kBinChunk);
  }
  progress.begin("write glb", static_cast<std::int64_t>(parts.size()), "part");
  for (const Part& part : parts) {
    for (const std::uint32_t v : part.vertices) append(out, space.position(mesh.positions[v]));
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
  DUBSAR_TRY(out.flush());
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

}  // namespace dubsar
