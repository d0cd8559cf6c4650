#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/numbers/bytes.h"
#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/base/text/json_text.h"
#include "core/mesh_io/glb/glb_data.h"
#include "core/mesh_io/glb/glb_nodes.h"
#include "core/mesh_io/glb/glb_words.h"
#include "core/mesh_io/glb/painted_mesh.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_text.h"
#include "core/mesh_io/vertex_places.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
constexpr std::size_t kMostRefined = 3'000'000;  // triangles
constexpr std::uint64_t kMostRepeats = 16;       // vertices for each byte of the file: a few bytes name a mesh again
constexpr std::uint64_t kBytesAVertex = 160;     // of memory, while it is read
constexpr int kPoints = 0, kTriangles = 4, kStrip = 5, kFan = 6;

/// Where a mesh stands, and how far it is morphed.
struct Placed {
  glm::dmat4 transform;
  const std::vector<double>& weights;
};

struct Parser {
  GlbData data;
  GlbPhotos photos;
  Progress& progress;
  std::uint64_t file_bytes = 0;
  PaintedMesh mesh{};
  std::vector<glm::dvec3> cloud{};  ///< of points that no triangle joins
  bool ours = false, all_normals = true, any_color = false;
  std::uint64_t corners = 0, lines = 0, skins = 0, checked_bytes = 0;

  explicit Parser(Json root, std::string_view bin, Progress& told, std::uint64_t bytes)
      : data(std::move(root), bin), photos(data), progress(told), file_bytes(bytes) {}

  /// Asks the system, where a file of many small meshes would ask it for each, only now and then.
  Result<void> check_room(std::uint64_t bytes) {
    if (bytes <= checked_bytes) return {};
    checked_bytes = bytes + bytes / 4;
    return check_memory("glb", bytes);
  }

  /// As far as the node is morphed, before it is moved.
  Result<void> morph(const Json& json, const std::vector<double>& weights, const char* name,
                     std::vector<glm::dvec3>& values) {
    const Json* const targets = glb_member(json, "targets");
    for (std::size_t t = 0; targets && targets->is_array() && t < std::min(weights.size(), targets->size()); ++t) {
      const Json* const index = weights[t] != 0.0 ? glb_member((*targets)[t], name) : nullptr;
      if (!index) continue;
      DUBSAR_ASSIGN(const GlbAccessor moved, data.accessor(index));
      if (moved.count != values.size() || moved.parts != 3) return broken_glb("a morph target is not one per vertex");
      for (std::uint64_t v = 0; v < moved.count; ++v)
        values[v] += weights[t] * glm::dvec3(moved.at(v, 0), moved.at(v, 1), moved.at(v, 2));
    }
    return {};
  }

  Result<std::vector<glm::dvec3>> places(const Json& json, const GlbAccessor& positions, const Placed& placed) {
    if (positions.parts != 3 || positions.component == 5125)
      return broken_glb("positions are not vectors of 3 numbers");
    // Nodes may share a mesh; a small file must not become an endless one.
    const std::uint64_t all = mesh.places.size() + cloud.size() + positions.count;
    if (all > kMostRepeats * file_bytes) return broken_glb("the node tree repeats meshes too often");
    DUBSAR_TRY(check_room(kBytesAVertex * all));
    std::vector<glm::dvec3> out;
    for (std::uint64_t v = 0; v < positions.count; ++v)
      out.emplace_back(positions.at(v, 0), positions.at(v, 1), positions.at(v, 2));
    DUBSAR_TRY(morph(json, placed.weights, "POSITION", out));
    for (glm::dvec3& p : out) {
      p = glm::dvec3(placed.transform * glm::dvec4(p, 1.0)) * (ours ? 1.0 : kMmPerGltfUnit);
      const glm::vec3 held(p);
      if (!std::isfinite(held.x) || !std::isfinite(held.y) || !std::isfinite(held.z))
        return broken_glb("a position is not finite, or beyond 3e38 mm");
    }
    return out;
  }

  Result<void> normals(const Json& json, const Json* index, std::uint64_t count, const Placed& placed) {
    mesh.normals.resize(mesh.places.size(), glm::dvec3(0.0));
    if (!index) {
      all_normals = false;
      return {};
    }
    DUBSAR_ASSIGN(const GlbAccessor read, data.accessor(index));
    if (read.count != count || read.parts != 3 || (!read.floats() && !read.normalized))
      return broken_glb("normals are not one vector per vertex");
    const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(placed.transform)));
    std::vector<glm::dvec3> out;
    for (std::uint64_t v = 0; v < count; ++v) out.emplace_back(read.at(v, 0), read.at(v, 1), read.at(v, 2));
    DUBSAR_TRY(morph(json, placed.weights, "NORMAL", out));
    for (std::uint64_t v = 0; v < count; ++v) {
      const glm::dvec3 turned = ours ? out[v] : turn * out[v];
      const double length = ours && read.floats() ? 1.0 : glm::length(turned);
      if (length > 0.0 && std::isfinite(length)) mesh.normals[mesh.places.size() - count + v] = turned / length;
    }
    return {};
  }

  /// Colours of the vertices, and where they lie on the photograph of their material.
  Result<void> paint(const Json& json, const Json& attributes, std::uint64_t count) {
    GlbPaint paint = photos.paint(glb_number(json, "material", std::nullopt));
    const std::string name = fmt::format("TEXCOORD_{}", paint.coordinates);
    const Json* const uv = paint.photo ? glb_member(attributes, name.c_str()) : nullptr;
    if (!uv) paint.photo = nullptr;
    mesh.uv.resize(mesh.places.size(), glm::dvec2(0.0));
    mesh.own.resize(mesh.places.size(), glm::dvec4(1.0));
    mesh.paint.resize(mesh.places.size(), static_cast<std::uint32_t>(mesh.paints.size()));
    const std::size_t base = mesh.places.size() - count;
    if (uv) {
      DUBSAR_ASSIGN(const GlbAccessor read, data.accessor(uv));
      if (read.count != count || read.parts != 2) return broken_glb("places on the photograph are not one per vertex");
      for (std::uint64_t v = 0; v < count; ++v) mesh.uv[base + v] = {read.at(v, 0), read.at(v, 1)};
    }
    if (const Json* const index = glb_member(attributes, "COLOR_0")) {
      DUBSAR_ASSIGN(const GlbAccessor read, data.accessor(index));
      if (read.count != count || read.parts < 3) return broken_glb("colours are not one per vertex");
      for (std::uint64_t v = 0; v < count; ++v)
        mesh.own[base + v] = {read.share(v, 0), read.share(v, 1), read.share(v, 2), 1.0};
      any_color = true;
    }
    any_color =
        any_color || paint.photo != nullptr || (!mesh.paints.empty() && mesh.paints.front().factor != paint.factor);
    mesh.paints.push_back(paint);
    return {};
  }

  Result<void> triangles(const Json& json, std::uint64_t count, int mode, bool mirrored, PartitionId partition) {
    std::optional<GlbAccessor> indices;
    if (const Json* const index = glb_member(json, "indices")) {
      DUBSAR_ASSIGN(indices, data.accessor(index));
      if (indices->parts != 1 || indices->floats()) return broken_glb("indices are not integers");
    }
    const std::uint64_t all = indices ? indices->count : count;
    const std::size_t base = mesh.places.size() - count;
    corners += all;
    if (corners > 4 * kMostRepeats * file_bytes) return broken_glb("the node tree repeats meshes too often");
    if (mode == kTriangles && all % 3 != 0) return broken_glb("the number of corners is not a multiple of 3");
    DUBSAR_TRY(check_room(kBytesAVertex * mesh.places.size() + 24 * (mesh.triangles.size() + all)));
    const std::uint64_t made = mode == kTriangles ? all / 3 : all < 3 ? 0 : all - 2;
    for (std::uint64_t t = 0; t < made; ++t) {
      std::array<std::uint64_t, 3> at{t, t + 1 + t % 2, t + 2 - t % 2};
      if (mode == kTriangles) at = {3 * t, 3 * t + 1, 3 * t + 2};
      if (mode == kFan) at = {t + 1, t + 2, 0};
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t v = indices ? static_cast<std::uint64_t>(indices->raw(at[k], 0)) : at[k];
        if (v >= count) return broken_glb("a triangle names a vertex that does not exist");
        triangle[k] = static_cast<std::uint32_t>(base + v);
      }
      // Strips go on over places that are named twice.
      if (mode != kTriangles &&
          (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]))
        continue;
      if (mirrored) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
      mesh.partitions.push_back(partition);
    }
    return {};
  }

  Result<void> primitive(const Json& json, const Placed& placed, PartitionId partition) {
    const auto mode = glb_number(json, "mode", kTriangles);
    if (!mode || *mode > kFan) return broken_glb("a primitive of no known kind found, expected triangles");
    const Json* const attributes = glb_member(json, "attributes");
    if (!attributes) return broken_glb("a primitive has no attributes");
    const int kind = static_cast<int>(*mode);
    if (kind > kPoints && kind < kTriangles) {
      ++lines;
      return {};
    }
    if (const Json* const packed = glb_extension(json, "KHR_draco_mesh_compression");
        packed && !data.has_bytes(glb_member(*attributes, "POSITION")))
      return broken_glb("KHR_draco_mesh_compression found, expected data without; convert it");
    DUBSAR_ASSIGN(const GlbAccessor positions, data.accessor(glb_member(*attributes, "POSITION")));
    DUBSAR_ASSIGN(const std::vector<glm::dvec3> moved, places(json, positions, placed));
    if (kind == kPoints) {
      cloud.insert(cloud.end(), moved.begin(), moved.end());
      return {};
    }
    mesh.places.insert(mesh.places.end(), moved.begin(), moved.end());
    DUBSAR_TRY(normals(json, glb_member(*attributes, "NORMAL"), positions.count, placed));
    DUBSAR_TRY(paint(json, *attributes, positions.count));
    // A node that mirrors turns what was counter-clockwise.
    const bool mirrored = glm::determinant(glm::dmat3(placed.transform)) < 0.0;
    return triangles(json, positions.count, kind, mirrored, partition);
  }

  /// Depth first, children in order; every node once.
  Result<void> nodes() {
    struct Visit {
      std::uint64_t node;
      glm::dmat4 parent;
      bool root;
    };
    const Json& root = data.root();
    DUBSAR_ASSIGN(const Json roots, glb_roots(root));
    const Json* all = glb_member(root, "nodes");
    std::vector<Visit> stack;
    std::vector<bool> seen(all->size());
    const auto push = [&](const Json* list, const glm::dmat4& parent, bool top) {
      if (!list) return true;
      if (!list->is_array()) return false;
      for (auto it = list->rbegin(); it != list->rend(); ++it) {
        if (!it->is_number_unsigned() || it->get<std::uint64_t>() >= seen.size()) return false;
        const auto id = static_cast<std::size_t>(it->get<std::uint64_t>());
        if (seen[id]) return false;
        seen[id] = true;
        stack.push_back({id, parent, top});
      }
      return true;
    };
    if (!push(&roots, glm::dmat4(1.0), true)) return broken_glb("the scene names nodes that do not exist");
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (progress.cancelled()) return cancelled_error();
      const Json& node = (*all)[visit.node];
      DUBSAR_ASSIGN(const glm::dmat4 local, glb_node_matrix(node));
      // The root of our own files turns millimetres into metres; what is below keeps millimetres.
      const glm::dmat4 transform = ours && visit.root ? glm::dmat4(1.0) : visit.parent * local;
      if (!push(glb_member(node, "children"), transform, false)) return broken_glb("the node tree is not a tree");
      if (!glb_member(node, "mesh")) continue;
      const Json* shape = glb_element(root, "meshes", glb_number(node, "mesh", std::nullopt));
      const Json* primitives = shape ? glb_member(*shape, "primitives") : nullptr;
      if (!primitives || !primitives->is_array()) return broken_glb("a node names a mesh that does not exist");
      const Json* extras = glb_member(node, "extras");
      const std::uint64_t id = ours && extras ? glb_number(*extras, "partition", 0).value_or(0) : 0;
      const auto partition = static_cast<PartitionId>(id <= PartitionTable::kHighest ? id : 0);
      skins += glb_member(node, "skin") != nullptr;
      const std::vector<double> weights = glb_weights(node, *shape);
      DUBSAR_ASSIGN(const std::vector<glm::dmat4> where, glb_instances(data, node, transform));
      for (const glm::dmat4& at : where) {
        if (progress.cancelled()) return cancelled_error();
        for (const Json& json : *primitives) DUBSAR_TRY(primitive(json, {at, weights}, partition));
      }
    }
    return {};
  }
};

/// What a reader of surfaces need not know, or what is read here.
bool is_known(const std::string& extension) {
  static constexpr std::array kNames{"KHR_mesh_quantization",   "EXT_meshopt_compression", "KHR_meshopt_compression",
                                     "EXT_mesh_gpu_instancing", "KHR_texture_transform",   "EXT_texture_webp",
                                     "KHR_texture_basisu"};
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_lights") ||
         std::find(kNames.begin(), kNames.end(), extension) != kNames.end();
}

Result<void> check_extensions(const Json& root) {
  const Json* const required = glb_member(root, "extensionsRequired");
  if (!required || !required->is_array()) return {};
  for (const Json& name : *required)
    if (!name.is_string() || !is_known(name.get<std::string>()))
      return fail(ErrorKind::kBadData, "glb: extension {} is required, expected a file without; convert it",
                  dump_json(name).substr(0, 80));
  return {};
}
}  // namespace

Result<TriMesh> parse_glb(std::string_view bytes, Progress& progress, const MeshReadOptions& options) {
  ByteReader reader(bytes);
  const auto magic = reader.little<std::uint32_t>(), version = reader.little<std::uint32_t>(),
             length = reader.little<std::uint32_t>();
  if (!reader.ok() || magic != kGlbMagic) return broken_glb("the file does not start with \"glTF\"");
  if (version != 2) return fail(ErrorKind::kBadData, "glb: version {} found, expected 2", version);
  if (length != bytes.size())
    return fail(ErrorKind::kBadData,
                "glb: {} bytes announced, {} found; it is cut or damaged, fetch or export it again", length,
                bytes.size());
  const auto json_bytes = reader.little<std::uint32_t>(), json_type = reader.little<std::uint32_t>();
  const std::string_view text = reader.take(json_bytes);
  if (!reader.ok() || json_type != kGlbJsonChunk) return broken_glb("the first chunk is not a whole JSON chunk");
  std::string_view bin;
  if (reader.left() > 0) {
    const auto bin_bytes = reader.little<std::uint32_t>(), bin_type = reader.little<std::uint32_t>();
    bin = reader.take(bin_bytes);
    if (!reader.ok() || bin_type != kGlbBinChunk) return broken_glb("the second chunk is not a whole BIN chunk");
  }
  DUBSAR_ASSIGN(Json root, parse_json(text, "glb"));
  DUBSAR_TRY(check_extensions(root));
  Parser parser(std::move(root), bin, progress, bytes.size());
  MeshTextReader lines;
  const Json* asset = glb_member(parser.data.root(), "asset");
  const Json* extras = asset ? glb_member(*asset, "extras") : nullptr;
  if (const Json* ours = extras ? glb_member(*extras, "dubsar") : nullptr; ours && ours->is_array())
    for (const Json& line : *ours)
      if (line.is_string()) lines.line(line.get_ref<const std::string&>());
  parser.ours = lines.ours();
  progress.begin("read glb", 0, "part");
  DUBSAR_TRY(parser.nodes());
  if (parser.skins > 0)
    log_warning("glb: {} surfaces with a skeleton found, which bends nothing here: they stand as before it",
                parser.skins);
  if (parser.lines > 0) log_warning("glb: {} sets of lines left out, expected triangles", parser.lines);
  PaintedMesh& painted = parser.mesh;
  if (options.photo_detail) refine_to_photo(painted, kMostRefined);
  TriMesh mesh;
  if (parser.any_color && !lines.colors_derived()) mesh.colors = painted_colors(painted);
  if (parser.all_normals) mesh.normals.assign(painted.normals.begin(), painted.normals.end());
  if (parser.ours)
    DUBSAR_TRY(lines.apply(mesh));
  else
    mesh.frame.input_voxel.provenance = kGltfMetres;
  mesh.triangles = std::move(painted.triangles);
  if (!mesh.partitions.empty()) mesh.triangle_partition = std::move(painted.partitions);
  set_places(mesh, mesh.triangles.empty() && !parser.cloud.empty() ? parser.cloud : painted.places);
  if (mesh.triangles.empty()) mesh.normals.clear(), mesh.colors.clear();
  if (!parser.ours) join_equal_places(mesh);
  progress.end();
  return mesh;
}

}  // namespace dubsar
