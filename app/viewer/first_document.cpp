#include "app/viewer/first_document.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/viewer/surface_tools.h"

namespace dubsar::app {
namespace {

constexpr double kPartsGap = 0.1;  // between what is taken apart, of the object's height

std::vector<Part> parts_of(const TriMesh& mesh) {
  std::vector<Part> out;
  for (const Partition& partition : mesh.partitions) {
    const std::string& name = partition.body_name();
    auto at = std::find_if(out.begin(), out.end(), [&](const Part& part) { return part.name == name; });
    if (at == out.end()) at = out.insert(out.end(), Part{name});
    at->partitions = static_cast<std::uint8_t>(at->partitions | 1u << partition.id);
  }
  return out;
}

/// Of all vertices that triangles use, as the stage has it.
Box box_of(const TriMesh& mesh) {
  const auto at = [&](std::uint32_t v) { return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])); };
  Box out{at(mesh.triangles[0][0]), at(mesh.triangles[0][0])};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      out.min = glm::min(out.min, at(v));
      out.max = glm::max(out.max, at(v));
    }
  return out;
}

}  // namespace

Document first_document(const ViewOptions& options, const TriMesh& mesh) {
  Document out = options.work.document;
  if (out.parts.empty()) out.parts = parts_of(mesh);
  const Light& light = options.stage.shading.light;
  if (out.home_light == LightPlace() && out.light == LightPlace())
    out.home_light = out.light = {light.azimuth_deg, light.elevation_deg};
  if (out.scan == ScanView() && !mesh.triangles.empty()) {
    const Box box = box_of(mesh);
    out.scan.cursor_mm = out.scan.centre_mm = 0.5 * (box.min + box.max);
  }
  if (options.work.upright && !mesh.triangles.empty()) {
    if (const auto turn = upright_turn(mesh, first_turn(box_of(mesh), options.stage.direction)))
      out.home.rotation = out.now.rotation = *turn;
  }
  return out;
}

glm::dmat3 first_turn(const Box& model, const ViewDirection& direction) {
  const ObjectFrame frame = picture_frame(object_frame(model), direction);
  return glm::transpose(glm::dmat3(frame.right, frame.up, frame.front));
}

Shown shown_of(const Document& document, const ViewState& view, const StageOptions& stage, const Box& model) {
  Shown out;
  out.view = view;
  out.style = stage.shading.style;
  out.parts = stage.shading.parts;
  out.other = stage.shading.other;
  if (document.style.name != stage.style)
    if (const auto preset = shading_preset(document.style.name)) {
      out.style = preset->style;
      out.light = preset->light;
    }
  const StyleChoice& choice = document.style;
  if (const auto preset = shading_preset(choice.other); preset && choice.share > 0)
    out.other = {preset->style, preset->light, choice.share};
  const auto adapt = [&](Style& style) {
    style.mark_inferred = style.mark_inferred && choice.evidence;
    style.contrast *= choice.strength;
    style.ambient_occlusion = style.ambient_occlusion && choice.occlusion;
    style.radiance = std::max(style.radiance, choice.radiance);
    if (choice.colours == "blue-orange") style.field_colors = FieldColors::kBlueOrange;
    style.section = choice.section && !document.parts.empty();  // what parts are made of is closed
    if (choice.back_faces == "tint") style.back_faces = BackFaces::kTint;
    if (choice.back_faces == "hide") style.back_faces = BackFaces::kCull;
    if (choice.colours == "cividis") style.field_colors = FieldColors::kCividis;
    if (choice.colours == "grey") style.field_colors = FieldColors::kGrey;
  };
  adapt(out.style);
  adapt(out.other.style);
  out.fog.strength = document.fog;
  for (const Cut& cut : document.clips)
    if (cut.on) out.clips.push_back({cut.normal * cut.distance_mm / glm::dot(cut.normal, cut.normal), -cut.normal});
  const double unpack = can_unpack(document) ? document.unpack : 0.0;
  const ObjectFrame frame = object_frame(model);
  const double height = (1.0 + kPartsGap) * std::abs(glm::dot(model.size(), frame.up));
  out.fit = 1.0 / (1.0 + (1.0 + kPartsGap) * unpack);
  for (const Part& part : document.parts)
    for (int p = 0; p < kMaxPartitions; ++p) {
      if ((part.partitions >> p & 1) == 0) continue;
      PartLook& look = out.parts[static_cast<std::size_t>(p)];
      look.visible = look.visible && part.visible;
      look.opacity *= part.opacity;
      if (part.colour != Part().colour) look.color = part.colour;
      look.offset_mm = part.offset_mm + 0.5 * (part.name == "envelope" ? unpack : -unpack) * height * frame.up;
    }
  return out;
}

}  // namespace dubsar::app
