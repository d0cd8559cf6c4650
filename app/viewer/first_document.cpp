#include "app/viewer/first_document.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

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
  for (const Partition& partition : mesh.partitions)
    for (Part& part : out)
      if (!partition.within.empty() && part.name == partition.within && part.name != partition.body_name())
        part.pores = static_cast<std::uint8_t>(part.pores | 1u << partition.id);
  return out;
}

/// What was chosen of parts with the same names.
std::vector<Part> chosen(std::vector<Part> parts, const std::vector<Part>& choices) {
  for (Part& part : parts) {
    const auto same = [&](const Part& other) { return other.name == part.name; };
    const auto at = std::find_if(choices.begin(), choices.end(), same);
    if (at == choices.end()) continue;
    const Part of_mesh = part;
    part = *at;
    part.partitions = of_mesh.partitions;
    part.pores = of_mesh.pores;
  }
  return parts;
}

/// A body with the pores in its clay. Both stand where they are moved to, besides what takes them apart.
void dress(PartLook& look, const Part& part) {
  look.visible = look.visible && part.visible;
  look.opacity *= part.opacity;
  look.offset_mm += part.offset_mm;
}

/// How far an envelope goes that is lifted from its tablet, and which way.
glm::dvec3 lift_mm(const Box& model) {
  const ObjectFrame frame = object_frame(model);
  return (1.0 + kPartsGap) * std::abs(glm::dot(model.size(), frame.up)) * frame.up;
}

}  // namespace

Box surface_box(const TriMesh& mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box out{glm::dvec3(kInf), glm::dvec3(-kInf)};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const glm::dvec3 at = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
      if (!std::isfinite(at.x + at.y + at.z)) continue;
      out.min = glm::min(out.min, at);
      out.max = glm::max(out.max, at);
    }
  return out;
}

FirstDocument first_document(const ViewOptions& options, const TriMesh& mesh) {
  FirstDocument first{options.work.document, options.work.doubt};
  Document& out = first.document;
  out.parts = chosen(parts_of(mesh), out.parts);
  const Light& light = options.stage.shading.light;
  if (out.home_light == LightPlace() && out.light == LightPlace())
    out.home_light = out.light = {light.azimuth_deg, light.elevation_deg};
  if (out.scan == ScanView() && !mesh.triangles.empty()) {
    const Box box = surface_box(mesh);
    out.scan.cursor_mm = out.scan.centre_mm = 0.5 * (box.min + box.max);
  }
  if (options.work.upright && !mesh.triangles.empty()) {
    if (auto upright = upright_turn(mesh, first_turn(surface_box(mesh), options.stage.direction))) {
      out.home.rotation = out.now.rotation = upright->turn;
      first.doubt = std::move(upright->doubt);
    }
  }
  return first;
}

std::string first_words(const SessionWork& work) {
  if (work.restored) return "What you measured and noted here last time is here again.";
  if (!work.doubt.empty()) {
    std::string doubt = work.doubt;
    if (doubt[0] >= 'a' && doubt[0] <= 'z') doubt[0] = static_cast<char>(doubt[0] - 'a' + 'A');
    return doubt + ". Shift+Home: half a turn. Ctrl+Shift+Home: the other side. Ctrl+Home: this is the obverse.";
  }
  return "Drag to turn. 1 to 6: sides. U: lift the envelope. Ctrl+K: everything. F1: help.";
}

glm::dmat3 first_turn(const Box& model, const ViewDirection& direction) {
  const ObjectFrame frame = picture_frame(object_frame(model), direction);
  return glm::transpose(glm::dmat3(frame.right, frame.up, frame.front));
}

PartLooks laid_out(const Document& document, PartLooks looks, const Box& model) {
  const double unpack = can_unpack(document) ? document.unpack : 0.0;
  const glm::dvec3 half_way = 0.5 * unpack * lift_mm(model);
  const auto envelope = std::find_if(document.parts.begin(), document.parts.end(),
                                     [](const Part& part) { return part.name == "envelope"; });
  const int lifted = envelope == document.parts.end() ? 0 : envelope->partitions | envelope->pores;
  for (int p = 0; p < kMaxPartitions; ++p) {
    PartLook& look = looks[static_cast<std::size_t>(p)];
    bool known = false;
    for (const Part& part : document.parts) {
      const bool own = (part.partitions >> p & 1) != 0;
      if (own || (part.pores >> p & 1) != 0) dress(look, part);
      if (own && part.colour != Part().colour) look.color = part.colour;
      known = known || own;
    }
    if (known) look.offset_mm += (lifted >> p & 1) != 0 ? half_way : -half_way;
  }
  return looks;
}

Shown shown_of(const Document& document, const ViewState& view, const StageOptions& stage, const Box& model) {
  Shown out;
  out.view = view;
  out.style = stage.shading.style;
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
  out.parts = laid_out(document, stage.shading.parts, model);
  out.fit = 1.0 / (1.0 + (1.0 + kPartsGap) * (can_unpack(document) ? document.unpack : 0.0));
  return out;
}

}  // namespace dubsar::app
