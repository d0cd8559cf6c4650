#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/mesh_io/glb/glb_parts.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr const char* kExtension = "EXT_meshopt_compression";
constexpr double kStepsPerVoxel = 16.0, kMostSteps = 65535.0;
constexpr double kLeastSteps = 512.0;  // across a surface that is counted in voxels: 32 of them

/// Compressed bytes (buffer 0) of views into what they stand for (buffer 1, which no file holds).
class Views {
 public:
  explicit Views(Json& json) : json_(json) {
    json_["accessors"] = Json::array();
    json_["bufferViews"] = Json::array();
  }
  /// Items of `stride` bytes, a whole number of four. Returns the number of the accessor.
  std::size_t add_vertices(const std::vector<unsigned char>& items, std::size_t stride, int component, bool normalized,
                           const char* type) {
    const std::size_t count = items.size() / stride;
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(count, stride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), items.data(), count, stride));
    Json& accessor = add(packed, count, stride, "ATTRIBUTES", component, type);
    if (normalized) accessor["normalized"] = true;
    json_["bufferViews"].back()["byteStride"] = stride;
    json_["bufferViews"].back()["target"] = kGlArrayBuffer;
    return json_["accessors"].size() - 1;
  }
  std::size_t add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size()));
    add(packed, indices.size(), sizeof(std::uint32_t), "TRIANGLES", kGlUint, "SCALAR");
    json_["bufferViews"].back()["target"] = kGlElementArrayBuffer;
    return json_["accessors"].size() - 1;
  }
  const std::string& bytes() const { return bytes_; }
  std::uint64_t unpacked_bytes() const { return unpacked_; }

 private:
  Json& add(const std::vector<unsigned char>& packed, std::size_t count, std::size_t stride, const char* mode,
            int component, const char* type) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    Json extension{{"buffer", 0},
                   {"byteOffset", bytes_.size()},
                   {"byteLength", packed.size()},
                   {"byteStride", stride},
                   {"count", count},
                   {"mode", mode}};
    json_["bufferViews"].push_back({{"buffer", 1},
                                    {"byteOffset", unpacked_},
                                    {"byteLength", count * stride},
                                    {"extensions", {{kExtension, std::move(extension)}}}});
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    bytes_.append(packed.begin(), packed.end());
    unpacked_ += count * stride;
    return json_["accessors"].back();
  }
  Json& json_;
  std::string bytes_;
  std::uint64_t unpacked_ = 0;
};

/// Positions are origin + step * (0..65535).
struct Grid {
  glm::dvec3 origin{0.0};
  double step = 1.0;
};
Grid grid_of(const TriMesh& mesh, const OutputSpace& space) {
  if (mesh.positions.empty()) return {};
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, space.exact_position(p));
    high = glm::max(high, space.exact_position(p));
  }
  const glm::dvec3 voxel = mesh.frame.grid_voxel_mm(), size = high - low;
  const double finest = std::max({size.x, size.y, size.z}) / kMostSteps;
  const double wanted = std::min({voxel.x, voxel.y, voxel.z}) / kStepsPerVoxel;
  // A surface of other units than voxels is as fine as 16 bits are.
  const bool voxels = wanted >= finest && wanted * kLeastSteps <= kMostSteps * finest;
  return {low, voxels ? wanted : finest > 0 ? finest : 1.0};
}

template <class T>
void put(std::vector<unsigned char>& out, T value) {
  const auto bits = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t b = 0; b < sizeof(T); ++b) out.push_back(static_cast<unsigned char>(bits >> (8 * b)));
}

/// Puts triangles and vertices in the order in which they pack best; returns the indices.
std::vector<std::uint32_t> packed_order(GlbPart& part) {
  std::vector<std::uint32_t> indices, ordered;
  for (const Triangle& t : part.triangles) indices.insert(indices.end(), t.begin(), t.end());
  ordered.resize(indices.size());
  const std::size_t count = part.vertices.size();
  meshopt_optimizeVertexCacheStrip(ordered.data(), indices.data(), indices.size(), count);
  std::vector<std::uint32_t> place(count), vertices(count);
  meshopt_optimizeVertexFetchRemap(place.data(), ordered.data(), ordered.size(), count);
  meshopt_remapIndexBuffer(indices.data(), ordered.data(), ordered.size(), place.data());
  for (std::size_t v = 0; v < count; ++v) vertices[place[v]] = part.vertices[v];
  part.vertices = std::move(vertices);
  return indices;
}

Json attributes_of(const TriMesh& mesh, const GlbPart& part, const OutputSpace& space, const VertexColors& colors,
                   const Grid& grid, Views& views, Json& json) {
  Json attributes;
  std::vector<unsigned char> bytes;
  std::array<int, 3> low{65535, 65535, 65535}, high{0, 0, 0};
  for (const std::uint32_t v : part.vertices) {
    const glm::dvec3 place = (space.exact_position(mesh.positions[v]) - grid.origin) / grid.step;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const int steps = static_cast<int>(std::clamp(std::round(place[a]), 0.0, kMostSteps));
      low[i] = std::min(low[i], steps);
      high[i] = std::max(high[i], steps);
      put(bytes, static_cast<std::uint16_t>(steps));
    }
    put(bytes, std::uint16_t{0});
  }
  attributes["POSITION"] = views.add_vertices(bytes, 8, kGlUshort, false, "VEC3");
  json["accessors"].back()["min"] = low;
  json["accessors"].back()["max"] = high;
  if (!mesh.normals.empty()) {
    bytes.clear();
    for (const std::uint32_t v : part.vertices) {
      const glm::vec3 n = space.normal(mesh.normals[v]);
      for (int a = 0; a < 3; ++a)
        put(bytes, static_cast<std::int8_t>(std::lround(std::clamp(n[a], -1.0f, 1.0f) * 127)));
      put(bytes, std::int8_t{0});
    }
    attributes["NORMAL"] = views.add_vertices(bytes, 4, kGlByte, true, "VEC3");
  }
  if (!colors.rgb.empty()) {
    bytes.clear();
    for (const std::uint32_t v : part.vertices) {
      for (const std::uint8_t c : colors.rgb[v]) put(bytes, linear_u16(c));
      put(bytes, std::uint16_t{65535});
    }
    attributes["COLOR_0"] = views.add_vertices(bytes, 8, kGlUshort, true, "VEC4");
  }
  return attributes;
}
}  // namespace

Result<void> write_compressed_glb(const std::filesystem::path& path, const TriMesh& mesh,
                                  const MeshWriteOptions& options, Progress& progress) {
  DUBSAR_TRY(check_tri_mesh(mesh));
  const OutputSpace space(mesh.frame, MeshUnits::kMm);
  const VertexColors colors = output_colors(mesh);
  const Grid grid = grid_of(mesh, space);
  std::vector<GlbPart> parts = glb_parts(mesh);
  Json json = glb_scene(mesh, colors.derived || options.colors_derived);
  Views views(json);
  meshopt_encodeIndexVersion(1);
  meshopt_encodeVertexVersion(0);
  progress.begin("write glb", static_cast<std::int64_t>(parts.size()), "part");
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (progress.cancelled()) return cancelled_error();
    const std::vector<std::uint32_t> indices = packed_order(parts[p]);
    Json attributes = attributes_of(mesh, parts[p], space, colors, grid, views, json);
    const std::size_t triangles = views.add_indices(indices, parts[p].vertices.size());
    const std::string name = partition_name(mesh, parts[p].id);
    json["meshes"].push_back(
        {{"name", name},
         {"primitives", {{{"attributes", std::move(attributes)}, {"indices", triangles}, {"material", 0}}}}});
    json["nodes"].push_back({{"name", name},
                             {"mesh", p},
                             {"translation", {grid.origin.x, grid.origin.y, grid.origin.z}},
                             {"scale", {grid.step, grid.step, grid.step}},
                             {"extras", {{"partition", parts[p].id}}}});
    json["nodes"][0]["children"].push_back(p + 1);
    progress.advance(1);
  }
  std::string binary = views.bytes();
  binary.resize((binary.size() + 3) / 4 * 4);
  if (parts.empty()) {
    json.erase("accessors");
    json.erase("bufferViews");
  } else {
    json["extensionsUsed"] = json["extensionsRequired"] = {"KHR_mesh_quantization", kExtension};
    json["buffers"] =
        Json::array({{{"byteLength", binary.size()}},
                     {{"byteLength", views.unpacked_bytes()}, {"extensions", {{kExtension, {{"fallback", true}}}}}}});
  }
  DUBSAR_TRY(write_glb_file(path, json, binary.size(), [&](BufferedWriter& out) -> Result<void> {
    out.text(binary);
    return {};
  }));
  progress.end();
  return {};
}

}  // namespace dubsar
