#include "app/stage/shown_document.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar::app {
namespace {

constexpr Hatch kMutedHatch{{186, 172, 154}, {168, 152, 132}};  // for visitors
constexpr double kPartsGap = 0.1;                               // between what is taken apart, of the object's height

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
    style.hatch = stage.room.gallery ? kMutedHatch : choice.hatch == "blue" ? kBlueHatch : kSepiaHatch;
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
