#include "core/script/correction/wedge_edits.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>

#include "core/script/arrange_text.h"

namespace dubsar {
namespace {

constexpr double kEditBeside = 0.25;   // widths beside a wedge that are still its own
constexpr double kEditLeast = 1e-6;    // mm
constexpr double kEditOffLevel = 1.5;  // widths above or below the writing surface: beyond is another side's

/// How a wedge lies along t, b and n of its own (docs/edition.md), from the places that `w` has.
bool lay(ScriptWedge& w, const TextSides& sides) {
  const glm::dvec3 along = w.tail_mm - w.head_mm, flat = along - glm::dot(along, w.normal) * w.normal;
  if (!(glm::length(flat) > kEditLeast) || !(w.width_mm > kEditLeast)) return false;
  w.direction = glm::normalize(flat);
  w.length_mm = glm::length(along);
  const SideAngle angle = sides.angle_of(w.direction, w.normal);
  w.side = angle.side;
  w.kind = wedge_kind(angle.angle, w.length_mm / w.width_mm);
  return true;
}

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * along);
}

/// 0 within the triangle of corners and tail.
double distance_to_wedge(const ScriptWedge& w, const glm::dvec3& place) {
  const glm::dvec3 across = glm::cross(w.normal, w.direction);
  const auto flat = [&](const glm::dvec3& p) {
    return glm::dvec2(glm::dot(p - w.head_mm, w.direction), glm::dot(p - w.head_mm, across));
  };
  const glm::dvec2 p = flat(place);
  const std::array<glm::dvec2, 3> corner{flat(w.corner_mm[0]), flat(w.corner_mm[1]), flat(w.tail_mm)};
  double nearest = 1e30;
  int left = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 &a = corner[k], &b = corner[(k + 1) % 3];
    nearest = std::min(nearest, distance_to_segment(p, a, b));
    left += (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0.0 ? 1 : 0;
  }
  return left == 0 || left == 3 ? 0.0 : nearest;
}

}  // namespace

std::optional<ScriptWedge> drawn_wedge(const DrawnWedge& drawn, const TextSides& sides) {
  ScriptWedge out;
  out.by = WedgeBy::kPerson;
  out.confidence = 1.0;
  out.normal = drawn.normal;
  out.head_mm = out.tip_mm = 0.5 * (drawn.corner_mm[0] + drawn.corner_mm[1]);
  out.tail_mm = drawn.tail_mm;
  out.width_mm = glm::distance(drawn.corner_mm[0], drawn.corner_mm[1]);
  if (!lay(out, sides)) return std::nullopt;
  const bool left_first =
      glm::dot(drawn.corner_mm[0] - drawn.corner_mm[1], glm::cross(out.normal, out.direction)) >= 0.0;
  out.corner_mm[left_first ? 0 : 1] = drawn.corner_mm[0];
  out.corner_mm[left_first ? 1 : 0] = drawn.corner_mm[1];
  return out;
}

std::optional<ScriptWedge> moved_wedge(const ScriptWedge& wedge, const glm::dvec3& head_mm, const glm::dvec3& tail_mm,
                                       const glm::dvec3& normal, const TextSides& sides) {
  ScriptWedge out = wedge;
  out.head_mm = head_mm;
  out.tail_mm = tail_mm;
  out.normal = normal;
  if (!lay(out, sides)) return std::nullopt;
  const glm::dvec3 was = glm::cross(wedge.normal, wedge.direction), is = glm::cross(out.normal, out.direction);
  const auto carried = [&](const glm::dvec3& p) {
    const glm::dvec3 off = p - wedge.head_mm;
    return out.head_mm + glm::dot(off, wedge.direction) * out.direction + glm::dot(off, was) * is +
           glm::dot(off, wedge.normal) * out.normal;
  };
  for (glm::dvec3& corner : out.corner_mm) corner = carried(corner);
  out.tip_mm = carried(out.tip_mm);
  out.pressed_after.clear();
  correct(out);
  return out;
}

void correct(ScriptWedge& wedge) {
  if (wedge.by == WedgeBy::kMachine) wedge.by = WedgeBy::kCorrected;
}

std::optional<std::size_t> wedge_at(std::span<const ScriptWedge> wedges, const glm::dvec3& place_mm) {
  std::optional<std::size_t> best;
  double off = 0.0, from_tip = 0.0;
  for (std::size_t k = 0; k < wedges.size(); ++k) {
    const ScriptWedge& w = wedges[k];
    if (std::abs(glm::dot(place_mm - w.head_mm, w.normal)) > kEditOffLevel * w.width_mm + w.depth_mm) continue;
    const double away = distance_to_wedge(w, place_mm), tip = glm::distance(place_mm, w.tip_mm);
    if (away > kEditBeside * w.width_mm) continue;
    if (best && (away > off || (away == off && tip >= from_tip))) continue;
    best = k;
    off = away;
    from_tip = tip;
  }
  return best;
}

void number_in_order(std::vector<ScriptWedge>& wedges) {
  std::map<int, int> now;
  for (std::size_t k = 0; k < wedges.size(); ++k) now[wedges[k].order] = static_cast<int>(k) + 1;
  for (std::size_t k = 0; k < wedges.size(); ++k) {
    ScriptWedge& w = wedges[k];
    w.order = static_cast<int>(k) + 1;
    std::erase_if(w.pressed_after, [&](const WedgeBefore& before) { return !now.contains(before.order); });
    for (WedgeBefore& before : w.pressed_after) before.order = now.at(before.order);
  }
}

}  // namespace dubsar
