#include "core/script/arrange_text.h"

#include <algorithm>
#include <array>
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

void number_lines(std::vector<ScriptWedge>& wedges, const TextSides& sides) {
  std::vector<std::vector<TextBody>> bodies(kTextSideCount);
  std::vector<double> widths;
  for (const ScriptWedge& w : wedges) {
    const glm::dvec3 right = sides.right_of(w.side), up = sides.up_of(w.side);
    const double head = glm::dot(w.head_mm, up), tail = glm::dot(w.tail_mm, up);
    const double half = 0.5 * std::abs(glm::dot(w.corner_mm[0] - w.corner_mm[1], up));
    bodies[static_cast<std::size_t>(w.side)].push_back(
        {0.5 * glm::dot(w.head_mm + w.tail_mm, right), std::min(head - half, tail), std::max(head + half, tail)});
    widths.push_back(w.width_mm);
  }
  const std::vector<std::vector<int>> lines = lines_of(bodies, median(widths));
  std::array<std::size_t, kTextSideCount> next{};
  for (ScriptWedge& w : wedges) {
    const auto side = static_cast<std::size_t>(w.side);
    w.line = lines[side][next[side]++];
  }
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
  number_lines(wedges, sides);
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
