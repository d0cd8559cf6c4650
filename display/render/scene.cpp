#include "display/render/scene.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "display/render/mesh/lod_mesh.h"

namespace dubsar {
namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}
bool fraction(double value) { return value >= 0.0 && value <= 1.0; }

void grow(Box& box, const glm::dvec3& p) {
  box.min = glm::min(box.min, p);
  box.max = glm::max(box.max, p);
}

void grow_by(Box& box, const MeshItem& item) {
  for (std::size_t p = 0; p < item.parts.size(); ++p) {
    if (!item.parts[p].visible || !item.mesh->has_any(static_cast<std::uint8_t>(1 << p))) continue;
    const Box part = item.mesh->box_of(static_cast<std::uint8_t>(1 << p));
    for (int corner = 0; corner < 8; ++corner)
      grow(box, glm::dvec3(item.world_from_model * glm::dvec4(part.corner(corner) + item.parts[p].offset_mm, 1.0)));
  }
}

void grow_by(Box& box, const LinesItem& item) {
  for (const glm::dvec3& p : item.points_mm) grow(box, p);
}

void grow_by(Box& box, const LabelItem& item) { grow(box, item.at_mm); }

Result<void> check_item(const LabelItem& item) {
  if (item.font == nullptr) return fail(ErrorKind::kUsage, "scene: a label has no font");
  if (!finite(item.at_mm) || !finite(item.along_mm) || !(item.height_px > 0) || !std::isfinite(item.height_px) ||
      !fraction(item.opacity) || !fraction(item.hidden_opacity) || !fraction(item.anchor) || !fraction(item.plate) ||
      !std::isfinite(item.lift_mm) || !std::isfinite(item.shift_px.x) || !std::isfinite(item.shift_px.y))
    return fail(ErrorKind::kUsage,
                "scene: a label of {} pixels and opacities {} and {} found, expected more than 0 and 0 to 1",
                item.height_px, item.opacity, item.hidden_opacity);
  return {};
}

Result<void> check_item(const MeshItem& item) {
  if (item.mesh == nullptr) return fail(ErrorKind::kUsage, "scene: a mesh item has no mesh");
  if (!finite(item.world_from_model)) return fail(ErrorKind::kUsage, "scene: the place of a mesh is not finite");
  if (!fraction(item.other.share))
    return fail(ErrorKind::kUsage, "scene: a second look's share of {} found, expected 0 to 1", item.other.share);
  for (const PartLook& part : item.parts)
    if (!finite(part.offset_mm) || !fraction(part.opacity))
      return fail(ErrorKind::kUsage, "scene: a part with opacity {} or an offset that is not finite, expected 0 to 1",
                  part.opacity);
  return {};
}

Result<void> check_item(const LinesItem& item) {
  if (item.points_mm.size() % 2 != 0)
    return fail(ErrorKind::kUsage, "scene: lines of {} points found, expected two for each", item.points_mm.size());
  for (const glm::dvec3& p : item.points_mm)
    if (!finite(p)) return fail(ErrorKind::kUsage, "scene: a point of a line is not finite");
  if (!(item.width_px > 0) || !std::isfinite(item.width_px) || !fraction(item.opacity) ||
      !fraction(item.hidden_opacity) || !std::isfinite(item.lift_mm))
    return fail(ErrorKind::kUsage,
                "scene: lines of {} pixels and opacities {} and {} found, expected more than 0 and 0 to 1",
                item.width_px, item.opacity, item.hidden_opacity);
  return {};
}

}  // namespace

std::vector<ClipPlane> moved(std::span<const ClipPlane> clips, const glm::dmat4& world_from_model) {
  const glm::dmat3 normals = glm::inverseTranspose(glm::dmat3(world_from_model));
  std::vector<ClipPlane> out;
  for (const ClipPlane& clip : clips)
    out.push_back({glm::dvec3(world_from_model * glm::dvec4(clip.point_mm, 1.0)), normals * clip.normal});
  return out;
}

Result<ClipPlane> cut_from_side(const Box& box, std::string_view side, double share) {
  const ObjectFrame frame = object_frame(box);
  const std::array<std::pair<std::string_view, glm::dvec3>, 6> sides{{{"front", frame.front},
                                                                      {"back", -frame.front},
                                                                      {"left", -frame.right},
                                                                      {"right", frame.right},
                                                                      {"top", frame.up},
                                                                      {"bottom", -frame.up}}};
  if (share >= 0 && share <= 1)
    for (const auto& [name, outward] : sides)
      if (side == name) {
        const double extent = glm::dot(glm::abs(outward), box.size());
        return ClipPlane{box.centre() + (0.5 - share) * extent * outward, -outward};
      }
  return fail(ErrorKind::kUsage,
              "cut of {} from \"{}\" found, expected 0 to 1 from front, back, left, right, top or bottom", share, side);
}

bool has_transparency(const SceneView& scene) {
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item))
      for (const PartLook& part : mesh->parts)
        if (part.visible && part.opacity < 1.0) return true;
  return false;
}

bool casts_shadows(const SceneView& scene) {
  if (scene.light.shadows) return true;
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item))
      if (mesh->other.share > 0 && mesh->other.light.shadows) return true;
  return false;
}

Box scene_box_mm(const SceneView& scene) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box box{glm::dvec3(kInf), glm::dvec3(-kInf)};
  for (const DrawItem& item : scene.items) std::visit([&](const auto& i) { grow_by(box, i); }, item);
  return box.min.x <= box.max.x ? box : Box{};
}

Result<void> check_scene(const SceneView& scene) {
  if (scene.clips.size() > static_cast<std::size_t>(kMostClipPlanes))
    return fail(ErrorKind::kUsage, "scene: {} clip planes found, expected at most {}", scene.clips.size(),
                kMostClipPlanes);
  if (!fraction(scene.fog.strength))
    return fail(ErrorKind::kUsage, "scene: fog of {} found, expected 0 to 1", scene.fog.strength);
  if (!fraction(scene.glow.strength) || !finite(scene.glow.at_mm) ||
      (scene.glow.strength > 0 && !(scene.glow.radius_mm > 0 && std::isfinite(scene.glow.radius_mm))))
    return fail(ErrorKind::kUsage, "scene: a glow of {} over {} mm found, expected 0 to 1 around a place",
                scene.glow.strength, scene.glow.radius_mm);
  for (const ClipPlane& clip : scene.clips)
    if (!finite(clip.point_mm) || !finite(clip.normal) || clip.normal == glm::dvec3(0.0))
      return fail(ErrorKind::kUsage, "scene: a clip plane has no direction, expected a point and a normal");
  for (const DrawItem& item : scene.items) {
    auto checked = std::visit([](const auto& i) { return check_item(i); }, item);
    if (!checked) return checked;
  }
  return {};
}

}  // namespace dubsar
