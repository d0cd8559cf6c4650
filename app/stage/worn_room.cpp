#include "app/stage/worn_room.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace dubsar::app {
namespace {

constexpr Rgb8 kSkin{226, 196, 164}, kController{190, 190, 200}, kFloor{62, 60, 58}, kPlinth{110, 104, 96};
constexpr double kFloorMm = 1500.0, kTileMm = 250.0;
constexpr double kUnderMm = 15.0;  // from the object to the plinth

/// The five fingers from the wrist on, in the order of XR_EXT_hand_tracking; the palm is joint 0.
void add_hand(const WornHand& hand, LinesItem& lines) {
  constexpr std::size_t kWrist = 1, kJoints = 26;
  const auto add = [&](std::size_t from, std::size_t to) {
    if (!hand.joints[from].valid || !hand.joints[to].valid) return;
    lines.points_mm.push_back(1e3 * hand.joints[from].pose.position_m);
    lines.points_mm.push_back(1e3 * hand.joints[to].pose.position_m);
  };
  constexpr std::size_t kFirst[] = {2, 6, 11, 16, 21, kJoints};
  for (std::size_t finger = 0; finger < 5; ++finger) {
    add(kWrist, kFirst[finger]);
    for (std::size_t joint = kFirst[finger]; joint + 1 < kFirst[finger + 1]; ++joint) add(joint, joint + 1);
  }
  for (std::size_t finger = 1; finger < 4; ++finger) add(kFirst[finger] + 1, kFirst[finger + 1] + 1);  // knuckles
}

/// A handle and a ring about the fist; -z is where the thumb points.
void add_controller(const WornController& controller, LinesItem& lines) {
  constexpr int kSides = 16;
  constexpr double kRingMm = 30.0, kHandleMm = 60.0;
  const auto at = [&](const glm::dvec3& p) { return 1e3 * controller.grip.position_m + controller.grip.rotation * p; };
  lines.points_mm.insert(lines.points_mm.end(), {at({0, 0, kHandleMm}), at({0, 0, -kHandleMm})});
  for (int i = 0; i < kSides; ++i)
    for (const int end : {i, i + 1}) {
      const double turn = 2.0 * std::numbers::pi * end / kSides;
      lines.points_mm.push_back(at({kRingMm * std::cos(turn), kRingMm * std::sin(turn), -kHandleMm}));
    }
}

LinesItem floor_lines(double floor_mm) {
  LinesItem out;
  out.width_px = 1.0;
  out.color = kFloor;
  for (double along = -kFloorMm; along <= kFloorMm; along += kTileMm)
    for (const bool across : {false, true})
      for (const double end : {-kFloorMm, kFloorMm})
        out.points_mm.push_back(across ? glm::dvec3(along, floor_mm, end) : glm::dvec3(end, floor_mm, along));
  return out;
}

LinesItem plinth_lines(double top_mm, double floor_mm, double half_mm) {
  LinesItem out;
  out.color = kPlinth;
  const glm::dvec2 corners[] = {{-half_mm, -half_mm}, {half_mm, -half_mm}, {half_mm, half_mm}, {-half_mm, half_mm}};
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 a = corners[i], b = corners[(i + 1) % 4];
    for (const double y : {top_mm, floor_mm}) out.points_mm.insert(out.points_mm.end(), {{a.x, y, a.y}, {b.x, y, b.y}});
    out.points_mm.insert(out.points_mm.end(), {{a.x, top_mm, a.y}, {a.x, floor_mm, a.y}});
  }
  return out;
}

}  // namespace

std::vector<LinesItem> worn_room(const WearerFrame& wearer, double object_radius_mm, bool see_through) {
  std::vector<LinesItem> out;
  const double top_mm = -object_radius_mm - kUnderMm;
  const double floor_mm = wearer.floor_m ? 1e3 * *wearer.floor_m : top_mm;
  if (!see_through && wearer.floor_m) out.push_back(floor_lines(floor_mm));
  if (!see_through && floor_mm < top_mm)
    out.push_back(plinth_lines(top_mm, floor_mm, std::max(120.0, object_radius_mm)));
  for (std::size_t side = 0; side < 2; ++side) {
    LinesItem lines;
    lines.width_px = 4.0;
    lines.hidden_opacity = 0.25;
    const bool held = wearer.controllers[side].active;
    lines.color = held ? kController : kSkin;
    if (held)
      add_controller(wearer.controllers[side], lines);
    else if (wearer.hands[side].active)
      add_hand(wearer.hands[side], lines);
    if (!lines.points_mm.empty()) out.push_back(std::move(lines));
  }
  return out;
}

}  // namespace dubsar::app
