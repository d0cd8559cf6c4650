#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/numbers/bytes.h"
#include "core/base/text/json_text.h"
#include "core/mesh_io/glb_words.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_text.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr std::uint64_t kMost = std::uint64_t{1} << 40;  // larger offsets and counts cannot be meant
constexpr double kMmPerM = 1000.0;

const Json* member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

/// The number under `key`; `otherwise` when it is absent; nothing when it is not an integer 0..2^40.
std::optional<std::uint64_t> number(const Json& object, const char* key, std::optional<std::uint64_t> otherwise) {
  const Json* value = member(object, key);
  if (!value) return otherwise;
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() > kMost) return std::nullopt;
  return value->get<std::uint64_t>();
}

/// Element number `index` of the array under `key`.
const Json* element(const Json& root, const char* key, std::optional<std::uint64_t> index) {
  const Json* array = member(root, key);
  if (!array || !array->is_array() || !index || *index >= array->size()) return nullptr;
  return &(*array)[*index];
}

bool read_numbers(const Json* array, double* out, std::size_t count) {
  if (!array || !array->is_array() || array->size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*array)[i].is_number()) return false;
    out[i] = (*array)[i].get<double>();
  }
  return true;
}

std::uint8_t srgb_u8(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055)));
}

struct Accessor {
  std::string_view bytes;
  std::uint64_t count = 0, stride = 0, parts = 0;
  int component = 0;

  double at(std::uint64_t item, std::uint64_t part) const {
    const auto read = [&]<class T>(T) {
      T value;
      std::memcpy(&value, bytes.data() + item * stride + part * sizeof(T), sizeof(T));
      return static_cast<double>(value);
    };
    switch (component) {
      case 5121:
        return read(std::uint8_t{});
      case 5123:
        return read(std::uint16_t{});
      case 5125:
        return read(std::uint32_t{});
      default:
        return read(float{});
    }
  }
  double scale() const { return component == 5121 ? 1.0 / 255.0 : component == 5123 ? 1.0 / 65535.0 : 1.0; }
};

tl::unexpected<Error> broken(std::string_view what) { return fail(ErrorKind::kBadData, "glb: {}", what); }

struct Parser {
  Json root;
  std::string_view bin;
  Progress& progress;
  std::uint64_t file_bytes = 0;
  TriMesh mesh;
  bool ours = false, all_normals = true, all_colors = true;
  std::uint64_t corners = 0;

  Result<Accessor> accessor(const Json* index) {
    if (!index || !index->is_number_unsigned()) return broken("a primitive has no usable accessor number");
    const Json* json = element(root, "accessors", index->get<std::uint64_t>());
    if (!json) return broken("an accessor is missing");
    if (member(*json, "sparse")) return broken("sparse accessors found, expected plain ones; convert the file");
    const Json* view = element(root, "bufferViews", number(*json, "bufferView", std::nullopt));
    if (!view) return broken("an accessor has no buffer view");
    Accessor result;
    const auto component = number(*json, "componentType", std::nullopt);
    const Json* type = member(*json, "type");
    const auto count = number(*json, "count", std::nullopt);
    if (!component || !count || !type || !type->is_string()) return broken("an accessor is broken");
    result.component = static_cast<int>(*component);
    result.count = *count;
    const std::string name = type->get<std::string>();
    result.parts = name == "SCALAR" ? 1 : name == "VEC3" ? 3 : name == "VEC4" ? 4 : 0;
    const std::uint64_t part_bytes = *component == 5121                         ? 1
                                     : *component == 5123                       ? 2
                                     : *component == 5125 || *component == 5126 ? 4
                                                                                : 0;
    const std::uint64_t item_bytes = part_bytes * result.parts;
    if (item_bytes == 0) return broken("an accessor has a type that is not supported");
    const auto view_offset = number(*view, "byteOffset", 0), view_length = number(*view, "byteLength", std::nullopt);
    const auto offset = number(*json, "byteOffset", 0), stride = number(*view, "byteStride", item_bytes);
    if (number(*view, "buffer", std::nullopt) != 0) return broken("data outside the file, expected buffer 0");
    if (!view_offset || !view_length || !offset || !stride || *stride < item_bytes || *stride > 4096)
      return broken("a buffer view is broken");
    if (*view_offset > bin.size() || *view_length > bin.size() - *view_offset)
      return broken("a buffer view lies outside the data");
    result.stride = *stride;
    if (result.count == 0 || result.count > kMost / 4096 ||
        *offset + (result.count - 1) * *stride + item_bytes > *view_length)
      return broken("an accessor lies outside its buffer view");
    result.bytes = bin.substr(*view_offset, *view_length).substr(*offset);
    return result;
  }

  Result<void> primitive(const Json& json, const glm::dmat4& transform, PartitionId partition) {
    if (number(json, "mode", 4) != 4) return broken("points, lines or strips found, expected triangles");
    const Json* attributes = member(json, "attributes");
    if (!attributes) return broken("a primitive has no attributes");
    DUBSAR_ASSIGN(const Accessor positions, accessor(member(*attributes, "POSITION")));
    if (positions.component != 5126 || positions.parts != 3) return broken("positions are not float vectors");
    const std::size_t base = mesh.positions.size();
    // Nodes may share a mesh; a small file must not become an endless one.
    if (base + positions.count > file_bytes) return broken("the node tree repeats meshes too often");
    const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(transform)));
    for (std::uint64_t v = 0; v < positions.count; ++v) {
      const glm::dvec4 p(positions.at(v, 0), positions.at(v, 1), positions.at(v, 2), 1.0);
      const glm::vec3 moved(ours ? glm::dvec3(p) : glm::dvec3(transform * p) * kMmPerM);
      if (!std::isfinite(moved.x) || !std::isfinite(moved.y) || !std::isfinite(moved.z))
        return broken("a position is not finite");
      mesh.positions.push_back(moved);
    }
    if (const Json* index = member(*attributes, "NORMAL")) {
      DUBSAR_ASSIGN(const Accessor normals, accessor(index));
      if (normals.count != positions.count || normals.component != 5126 || normals.parts != 3)
        return broken("normals are not one float vector per vertex");
      for (std::uint64_t v = 0; v < normals.count; ++v) {
        glm::dvec3 n(normals.at(v, 0), normals.at(v, 1), normals.at(v, 2));
        if (!ours) n = turn * n;
        const double length = ours ? 1.0 : glm::length(n);
        mesh.normals.push_back(length > 0.0 && std::isfinite(length) ? glm::vec3(n / length) : glm::vec3(0.0f));
      }
    } else {
      all_normals = false;
    }
    if (const Json* index = member(*attributes, "COLOR_0")) {
      DUBSAR_ASSIGN(const Accessor colors, accessor(index));
      if (colors.count != positions.count || colors.parts < 3) return broken("colours are not one per vertex");
      for (std::uint64_t v = 0; v < colors.count; ++v)
        mesh.colors.push_back({srgb_u8(colors.at(v, 0) * colors.scale()), srgb_u8(colors.at(v, 1) * colors.scale()),
                               srgb_u8(colors.at(v, 2) * colors.scale())});
    } else {
      all_colors = false;
    }
    std::optional<Accessor> indices;
    if (const Json* index = member(json, "indices")) {
      DUBSAR_ASSIGN(indices, accessor(index));
      if (indices->parts != 1 || indices->component == 5126) return broken("indices are not integers");
    }
    const std::uint64_t count = indices ? indices->count : positions.count;
    corners += count;
    if (count % 3 != 0) return broken("the number of corners is not a multiple of 3");
    if (corners > 4 * file_bytes) return broken("the node tree repeats meshes too often");
    for (std::uint64_t c = 0; c < count; c += 3) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = indices ? static_cast<std::uint64_t>(indices->at(c + k, 0)) : c + k;
        if (v >= positions.count) return broken("a triangle names a vertex that does not exist");
        triangle[k] = static_cast<std::uint32_t>(base + v);
      }
      mesh.triangles.push_back(triangle);
      mesh.triangle_partition.push_back(partition);
    }
    return {};
  }

  Result<glm::dmat4> node_matrix(const Json& node) {
    double m[16], t[3] = {0, 0, 0}, r[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (const Json* matrix = member(node, "matrix")) {
      if (!read_numbers(matrix, m, 16)) return broken("a node matrix is broken");
      glm::dmat4 result;
      for (int c = 0; c < 16; ++c) result[c / 4][c % 4] = m[c];
      return result;
    }
    if ((member(node, "translation") && !read_numbers(member(node, "translation"), t, 3)) ||
        (member(node, "rotation") && !read_numbers(member(node, "rotation"), r, 4)) ||
        (member(node, "scale") && !read_numbers(member(node, "scale"), s, 3)))
      return broken("a node transform is broken");
    glm::dmat4 result = glm::mat4_cast(glm::dquat(r[3], r[0], r[1], r[2]));
    for (int c = 0; c < 3; ++c) result[c] *= s[c];
    result[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
    return result;
  }

  /// Depth first, children in order; every node once.
  Result<void> nodes() {
    struct Visit {
      std::uint64_t node;
      glm::dmat4 parent;
    };
    const Json* scene = element(root, "scenes", number(root, "scene", 0));
    const Json* all = member(root, "nodes");
    if (!scene || !all || !all->is_array()) return broken("no scene with nodes");
    std::vector<Visit> stack;
    std::vector<bool> seen(all->size());
    const auto push = [&](const Json& holder, const char* key, const glm::dmat4& parent) {
      const Json* list = member(holder, key);
      if (!list) return true;
      if (!list->is_array()) return false;
      for (auto it = list->rbegin(); it != list->rend(); ++it) {
        if (!it->is_number_unsigned() || it->get<std::uint64_t>() >= seen.size()) return false;
        const auto id = static_cast<std::size_t>(it->get<std::uint64_t>());
        if (seen[id]) return false;
        seen[id] = true;
        stack.push_back({id, parent});
      }
      return true;
    };
    if (!push(*scene, "nodes", glm::dmat4(1.0))) return broken("the scene names nodes that do not exist");
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (progress.cancelled()) return cancelled_error();
      const Json& node = (*all)[visit.node];
      DUBSAR_ASSIGN(const glm::dmat4 local, node_matrix(node));
      const glm::dmat4 transform = visit.parent * local;
      if (!push(node, "children", transform)) return broken("the node tree is not a tree");
      if (!member(node, "mesh")) continue;
      const Json* shape = element(root, "meshes", number(node, "mesh", std::nullopt));
      const Json* primitives = shape ? member(*shape, "primitives") : nullptr;
      if (!primitives || !primitives->is_array()) return broken("a node names a mesh that does not exist");
      const Json* extras = member(node, "extras");
      const std::uint64_t id = ours && extras ? number(*extras, "partition", 0).value_or(0) : 0;
      const auto partition = static_cast<PartitionId>(id <= PartitionTable::kHighest ? id : 0);
      for (const Json& json : *primitives) DUBSAR_TRY(primitive(json, transform, partition));
    }
    return {};
  }
};
}  // namespace

Result<TriMesh> parse_glb(std::string_view bytes, Progress& progress) {
  ByteReader reader(bytes);
  const auto magic = reader.little<std::uint32_t>(), version = reader.little<std::uint32_t>(),
             length = reader.little<std::uint32_t>();
  if (!reader.ok() || magic != kGlbMagic) return broken("the file does not start with \"glTF\"");
  if (version != 2) return fail(ErrorKind::kBadData, "glb: version {} found, expected 2", version);
  if (length != bytes.size())
    return fail(ErrorKind::kBadData, "glb: {} bytes announced, {} found", length, bytes.size());
  const auto json_bytes = reader.little<std::uint32_t>(), json_type = reader.little<std::uint32_t>();
  const std::string_view text = reader.take(json_bytes);
  if (!reader.ok() || json_type != kGlbJsonChunk) return broken("the first chunk is not a whole JSON chunk");
  std::string_view bin;
  if (reader.left() > 0) {
    const auto bin_bytes = reader.little<std::uint32_t>(), bin_type = reader.little<std::uint32_t>();
    bin = reader.take(bin_bytes);
    if (!reader.ok() || bin_type != kGlbBinChunk) return broken("the second chunk is not a whole BIN chunk");
  }
  DUBSAR_ASSIGN(Json root, parse_json(text, "glb"));
  if (const Json* required = member(root, "extensionsRequired"); required && !required->empty())
    return fail(ErrorKind::kBadData, "glb: extension {} is required, expected a file without; convert it",
                dump_json((*required)).substr(0, 80));
  Parser parser{std::move(root), bin, progress, bytes.size(), {}};
  MeshTextReader lines;
  const Json* asset = member(parser.root, "asset");
  const Json* extras = asset ? member(*asset, "extras") : nullptr;
  if (const Json* ours = extras ? member(*extras, "dubsar") : nullptr; ours && ours->is_array())
    for (const Json& line : *ours)
      if (line.is_string()) lines.line(line.get_ref<const std::string&>());
  parser.ours = lines.ours();
  progress.begin("read glb", 0, "part");
  DUBSAR_TRY(parser.nodes());
  progress.end();
  TriMesh& mesh = parser.mesh;
  if (!parser.all_normals) mesh.normals.clear();
  if (!parser.all_colors || lines.colors_derived()) mesh.colors.clear();
  if (parser.ours)
    DUBSAR_TRY(lines.apply(mesh));
  else
    mesh.frame.input_voxel.provenance = "glTF is in metres";
  if (mesh.partitions.empty()) mesh.triangle_partition.clear();
  return std::move(mesh);
}

}  // namespace dubsar
