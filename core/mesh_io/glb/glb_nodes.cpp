#include "core/mesh_io/glb/glb_nodes.h"

#include <array>
#include <glm/gtc/quaternion.hpp>

namespace dubsar {
namespace {
using Json = nlohmann::json;

bool read_numbers(const Json* array, double* out, std::size_t count) {
  if (!array || !array->is_array() || array->size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*array)[i].is_number()) return false;
    out[i] = (*array)[i].get<double>();
  }
  return true;
}

glm::dmat4 moved_by(const double* t, const double* r, const double* s) {
  const glm::dquat turn(r[3], r[0], r[1], r[2]);
  const double length = glm::length(turn);
  glm::dmat4 result = glm::mat4_cast(length > 0.0 ? turn / length : glm::dquat(1, 0, 0, 0));
  for (int c = 0; c < 3; ++c) result[c] *= s[c];
  result[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  return result;
}

}  // namespace

Result<Json> glb_roots(const Json& root) {
  const Json* const scenes = glb_member(root, "scenes");
  const Json* const all = glb_member(root, "nodes");
  if (!all || !all->is_array() || all->empty()) return broken_glb("no nodes found, expected a scene with a surface");
  if (scenes) {
    const Json* const scene = glb_element(root, "scenes", glb_number(root, "scene", 0));
    if (!scene) return broken_glb("the scene to be shown does not exist");
    const Json* const nodes = glb_member(*scene, "nodes");
    return nodes ? *nodes : Json::array();
  }
  std::vector<bool> child(all->size());
  for (const Json& node : *all)
    if (const Json* const children = glb_member(node, "children"); children && children->is_array())
      for (const Json& number : *children)
        if (number.is_number_unsigned() && number.get<std::uint64_t>() < child.size())
          child[number.get<std::uint64_t>()] = true;
  Json out = Json::array();
  for (std::size_t n = 0; n < child.size(); ++n)
    if (!child[n]) out.push_back(n);
  return out;
}

Result<glm::dmat4> glb_node_matrix(const Json& node) {
  double m[16], t[3] = {0, 0, 0}, r[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  if (const Json* matrix = glb_member(node, "matrix")) {
    if (!read_numbers(matrix, m, 16)) return broken_glb("a node matrix is broken");
    glm::dmat4 result;
    for (int c = 0; c < 16; ++c) result[c / 4][c % 4] = m[c];
    return result;
  }
  const auto broken = [&](const char* key, double* out, std::size_t count) {
    const Json* const value = glb_member(node, key);
    return value && !read_numbers(value, out, count);
  };
  if (broken("translation", t, 3) || broken("rotation", r, 4) || broken("scale", s, 3))
    return broken_glb("a node transform is broken");
  return moved_by(t, r, s);
}

Result<std::vector<glm::dmat4>> glb_instances(GlbData& data, const Json& node, const glm::dmat4& transform) {
  const Json* const many = glb_extension(node, "EXT_mesh_gpu_instancing");
  const Json* const attributes = many ? glb_member(*many, "attributes") : nullptr;
  if (!attributes || !attributes->is_object() || attributes->empty()) return std::vector<glm::dmat4>{transform};
  std::array<std::optional<GlbAccessor>, 3> read;
  constexpr std::array kNames{"TRANSLATION", "ROTATION", "SCALE"};
  constexpr std::array<std::uint64_t, 3> kParts{3, 4, 3};
  std::optional<std::uint64_t> count;
  for (const auto& [name, index] : attributes->items()) {
    DUBSAR_ASSIGN(const GlbAccessor values, data.accessor(&index));
    if (count && *count != values.count) return broken_glb("instances have not one place each");
    count = values.count;
    for (std::size_t a = 0; a < read.size(); ++a) {
      if (name != kNames[a]) continue;
      if (values.parts != kParts[a]) return broken_glb("instances have not one place each");
      read[a] = values;
    }
  }
  std::vector<glm::dmat4> out;
  for (std::uint64_t i = 0; i < count.value_or(0); ++i) {
    std::array<std::array<double, 4>, 3> v{{{0, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 0}}};
    for (std::size_t a = 0; a < read.size(); ++a)
      for (std::uint64_t k = 0; read[a] && k < kParts[a]; ++k) v[a][k] = read[a]->at(i, k);
    out.push_back(transform * moved_by(v[0].data(), v[1].data(), v[2].data()));
  }
  return out;
}

std::vector<double> glb_weights(const Json& node, const Json& mesh) {
  const Json* weights = glb_member(node, "weights");
  if (!weights) weights = glb_member(mesh, "weights");
  std::vector<double> out;
  if (weights && weights->is_array())
    for (const Json& weight : *weights) out.push_back(weight.is_number() ? weight.get<double>() : 0.0);
  return out;
}

}  // namespace dubsar
