// Wedges as lines on the surface: the head's edge, and two flanks that run together into the tail.

#include <glm/geometric.hpp>

#include "app/document/edition_wedges.h"
#include "app/stage/ground_color.h"
#include "app/stage/marks.h"

namespace dubsar::app {
namespace {

constexpr Rgb8 kMachineWedge{0x6f, 0xd0, 0xe8}, kPersonWedge{0xff, 0x9d, 0x5c}, kChosenWedge{0xff, 0xf2, 0x3a};
constexpr double kWedgePx = 1.8, kChosenPx = 3.2, kWedgeBorderPx = 1.6;
constexpr double kWedgeLift = 0.12;  // mm towards the eye: heads lie on a rim that is not level

struct WedgeLines {
  std::vector<glm::dvec3> of_machine, of_person, chosen;
};

/// Where the part stands beside its place in the scan; none: it is not shown.
std::optional<glm::dvec3> offset_of(const Document& document, const std::string& name, const PartLooks& looks) {
  for (const Part& part : document.parts) {
    if (part.name != name) continue;
    for (std::size_t p = 0; p < looks.size(); ++p)
      if ((part.partitions >> p & 1) != 0)
        return looks[p].visible && looks[p].opacity > 0 ? std::optional(looks[p].offset_mm) : std::nullopt;
  }
  return glm::dvec3(0.0);
}

void add_outline(const ScriptWedge& w, const glm::dvec3& offset, std::vector<glm::dvec3>& pairs) {
  const glm::dvec3 a = w.corner_mm[0] + offset, b = w.corner_mm[1] + offset, end = w.tail_mm + offset;
  // Heads are about as long as they are broad; flanks meet there, and the tail goes on.
  const double head = 0.75 * w.width_mm;
  if (w.length_mm < 1.3 * w.width_mm) {
    for (const glm::dvec3& p : {a, b, b, end, end, a}) pairs.push_back(p);
    return;
  }
  const glm::dvec3 neck = w.head_mm + offset + head * glm::normalize(w.tail_mm - w.head_mm);
  for (const glm::dvec3& p : {a, b, b, neck, neck, a, neck, end}) pairs.push_back(p);
}

void add_lines(std::vector<LinesItem>& out, const std::vector<glm::dvec3>& pairs, double px, const Rgb8& color) {
  if (pairs.empty()) return;
  LinesItem item;
  item.points_mm = pairs;
  item.lift_mm = kWedgeLift;
  item.width_px = px + 2.0 * kWedgeBorderPx;
  item.color = kGroundColor;
  item.opacity = 0.55;
  out.push_back(item);
  item.width_px = px;
  item.color = color;
  item.opacity = 1.0;
  item.lift_mm += 0.02;
  out.push_back(std::move(item));
}

}  // namespace

std::vector<LinesItem> wedge_lines(const Document& document, std::size_t chosen, const PartLooks& parts, double scale) {
  WedgeLines lines;
  for (const MarkedWedge& marked : document.edition.wedges) {
    if (marked.deleted) continue;
    const auto offset = offset_of(document, marked.part, parts);
    if (!offset) continue;
    const ScriptWedge& w = marked.wedge;
    const bool is_chosen = chosen != 0 && static_cast<std::size_t>(w.order) == chosen;
    add_outline(w, *offset, is_chosen ? lines.chosen : w.by == WedgeBy::kMachine ? lines.of_machine : lines.of_person);
    if (is_chosen) {  // a cross at the deepest place
      const glm::dvec3 at = w.tip_mm + *offset, along = 0.12 * w.width_mm * w.direction,
                       across = glm::cross(w.normal, along);
      for (const glm::dvec3& p : {at - along, at + along, at - across, at + across}) lines.chosen.push_back(p);
    }
  }
  std::vector<LinesItem> out;
  add_lines(out, lines.of_machine, kWedgePx * scale, kMachineWedge);
  add_lines(out, lines.of_person, kWedgePx * scale, kPersonWedge);
  add_lines(out, lines.chosen, kChosenPx * scale, kChosenWedge);
  return out;
}

}  // namespace dubsar::app
