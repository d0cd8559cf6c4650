#include "core/script/arrange_text.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "core/base/numbers/median.h"
#include "core/script/line_cuts.h"

namespace dubsar {
namespace {

constexpr double kKindHalf = 22.0;        // degrees around the line and around down
constexpr double kKindOblique = 68.0;     // beyond is vertical, or upwards
constexpr double kKindShort = 1.3;        // lengths over the width: a Winkelhaken is no longer
constexpr double kKindBackwards = 140.0;  // degrees: against the line

void number_lines(std::vector<ScriptWedge>& wedges, const TextSides& sides, TextSide side) {
  std::vector<TextBody> bodies;
  std::vector<std::size_t> which;
  std::vector<double> widths;
  const glm::dvec3 right = sides.right_of(side), up = sides.up_of(side);
  for (std::size_t i = 0; i < wedges.size(); ++i) {
    const ScriptWedge& w = wedges[i];
    if (w.side != side) continue;
    const double head = glm::dot(w.head_mm, up), tail = glm::dot(w.tail_mm, up);
    const double half =
        0.5 * w.width_mm * std::abs(glm::dot(w.corner_mm[0] - w.corner_mm[1], up)) / std::max(w.width_mm, 1e-9);
    bodies.push_back(
        {0.5 * glm::dot(w.head_mm + w.tail_mm, right), std::min(head - half, tail), std::max(head + half, tail)});
    which.push_back(i);
    widths.push_back(w.width_mm);
  }
  const std::vector<int> lines = lines_of(bodies, median(widths));
  for (std::size_t k = 0; k < which.size(); ++k) wedges[which[k]].line = lines[k];
}

}  // namespace

WedgeKind wedge_kind(double angle, double length_per_width) {
  const double degrees = std::remainder(angle * 180.0 / std::numbers::pi, 360.0);
  if (std::abs(degrees) < kKindHalf) return WedgeKind::kHorizontal;
  if (std::abs(degrees + 90.0) < kKindHalf) return WedgeKind::kVertical;
  if (degrees < 0.0 && degrees > -kKindOblique) return WedgeKind::kObliqueDown;
  if (degrees > 0.0 && degrees < kKindOblique) return WedgeKind::kObliqueUp;
  if (std::abs(degrees) > kKindBackwards && length_per_width < 2.0 * kKindShort) return WedgeKind::kWinkelhaken;
  return length_per_width < kKindShort ? WedgeKind::kWinkelhaken : WedgeKind::kOdd;
}

void arrange_text(std::vector<ScriptWedge>& wedges, const TextSides& sides) {
  for (ScriptWedge& w : wedges) {
    const SideAngle angle = sides.angle_of(w.direction, w.normal);
    w.side = angle.side;
    w.kind = wedge_kind(angle.angle, w.width_mm > 0.0 ? w.length_mm / w.width_mm : 0.0);
  }
  for (std::size_t s = 0; s < kTextSideCount; ++s) number_lines(wedges, sides, static_cast<TextSide>(s));
  std::stable_sort(wedges.begin(), wedges.end(), [&](const ScriptWedge& a, const ScriptWedge& b) {
    const auto key = [&](const ScriptWedge& w) {
      return std::tuple(w.side, w.column, w.line, glm::dot(w.head_mm, sides.right_of(w.side)),
                        -glm::dot(w.head_mm, sides.up_of(w.side)));
    };
    return key(a) < key(b);
  });
  int order = 0;
  for (ScriptWedge& w : wedges) w.order = ++order;
}

}  // namespace dubsar
