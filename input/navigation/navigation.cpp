#include "input/navigation/navigation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "core/base/numbers/angle.h"
#include "input/navigation/square_turn.h"

namespace dubsar {
namespace {

constexpr double kMmPerWindow = 200.0;  // of a hand's way, when it pans by a window's height
constexpr TimestampNs kDoubleClickNs = 400'000'000;
constexpr double kSamePlace = 0.01;  // heights of the window
constexpr double kSameTouch = 0.03;  // of a finger: 1 cm of a panel of 27 inches
constexpr double kFine = 0.25;
constexpr double kLightLow = 5.0, kLightHigh = 85.0;

double seconds(TimestampNs ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

Navigator::Navigator(const Mapping& mapping, const ViewState& home)
    : mapping_(mapping),
      home_(home),
      view_(home),
      claims_(mapping.priority, mapping.handover_ns),
      hands_{GestureRecognizer(mapping.gestures), GestureRecognizer(mapping.gestures)} {}

bool Navigator::claim(Control control, TimestampNs now) {
  if (!claims_.claim(control, now)) return false;
  if (claims_.fresh() && control != Control::kHands) {  // what hands had in flight ends where it is
    momentum_.drop();
    hold_.take_away();
  }
  return true;
}

void Navigator::glide_to(const ViewState& target, TimestampNs now) {
  momentum_.drop();
  glide_.start(view_, target, now, mapping_.hands);
}

void Navigator::go_to(const ViewState& view, TimestampNs now, bool glide) {
  if (glide) return glide_to(view, now);
  glide_.stop();
  momentum_.drop();
  view_ = view;
}

void Navigator::let_go_of_mouse() {
  mouse_.buttons = {};
  mouse_.dragging = mouse_.pinching = false;
}

void Navigator::turn_to_next_side(const glm::dvec3& axis, TimestampNs now) {
  const glm::dquat from = nearest_square_turn(goal().rotation);
  ViewState target = view_;
  target.rotation = glm::normalize(glm::angleAxis(0.5 * std::numbers::pi, axis) * from);
  glide_to(target, now);
}

void Navigator::zoom_about(const std::optional<glm::dvec2>& at, double factor) {
  const double zoom = std::clamp(view_.zoom * factor, mapping_.zoom_min, mapping_.zoom_max);
  if (at) view_.pan = *at - (*at - view_.pan) * (zoom / view_.zoom);
  view_.zoom = zoom;
}

void Navigator::use_button(const InputEvent& event, TimestampNs now) {
  constexpr std::array<std::string_view, 3> kNames{"left", "middle", "right"};
  const auto button = static_cast<std::size_t>(event.button);
  mouse_.buttons[button] = event.down;
  mouse_.at = event.at;
  if (!event.down) {
    const auto& held = mouse_.buttons;
    if (std::none_of(held.begin(), held.end(), [](bool b) { return b; })) mouse_.dragging = false;
    return;
  }
  if (mouse_.dragging) return;
  mouse_.action = chord_action(mapping_.mouse, event.modifiers, kNames[button]);
  if (mouse_.action == Action::kNone || !claim(Control::kMouse, now)) return;
  ++movement_;
  const bool twice = event.at && mouse_.pressed_at && event.time - mouse_.pressed <= kDoubleClickNs &&
                     glm::length(*event.at - *mouse_.pressed_at) <= (event.touched ? kSameTouch : kSamePlace);
  mouse_.pressed = event.time;
  mouse_.pressed_at = event.at;
  mouse_.held.reset();
  if (event.at && event.lever) mouse_.held.emplace(event, view_.pan);
  mouse_.dragging = true;
  if (twice && mouse_.action == Action::kRotate) {  // what is pointed at goes to the middle
    ViewState target = view_;
    target.pan -= held_at(event);
    return glide_to(target, now);
  }
  glide_.stop();
}

/// What is held stays under the pointer; where nothing is, the turn goes by the pointer's way.
void Navigator::turn_by_mouse(const glm::dvec2& px, const std::optional<glm::dvec2>& moved, double gain) {
  if (mouse_.held && moved)
    if (const auto turn = mouse_.held->follow(gain * *moved)) return turn_view(view_, *turn);
  mouse_.held.reset();
  turn_view(view_, gain * mapping_.mouse.turn_deg_per_px * kRadPerDeg * glm::dvec3(px.y, px.x, 0));
}

/// Places of the pointer count in heights of the window; movements that come without a place go by pixels.
void Navigator::drag_by_mouse(const InputEvent& event) {
  const MouseMapping& mouse = mapping_.mouse;
  const glm::dvec2 px = event.motion;
  const std::optional<glm::dvec2> before = std::exchange(mouse_.at, event.at);
  const bool known = event.at && before;
  const glm::dvec2 moved = known ? *event.at - *before : glm::dvec2(px.x, -px.y) / kPixelsPerWindow;
  if (mouse_.action == Action::kRotate || mouse_.action == Action::kRotateFine)
    turn_by_mouse(px, known ? std::optional(moved) : std::nullopt, mouse_.action == Action::kRotateFine ? kFine : 1.0);
  if (mouse_.action == Action::kPan) view_.pan += moved;
  if (mouse_.action == Action::kZoom) zoom_about(mouse_.pressed_at, std::pow(mouse.zoom_per_100_px, -px.y / 100.0));
  if (mouse_.action == Action::kLight) drag(Action::kLight, glm::dvec2(px.x, -px.y), mouse.light_deg_per_px);
}

/// The object goes with the fingers, by the plane in which the surface stands that is between them.
void Navigator::use_pinch(const InputEvent& event, TimestampNs now) {
  if (!event.down || !event.at) {
    mouse_.pinching = false;
    return;
  }
  if (!claim(Control::kMouse, now)) return;
  if (!mouse_.pinching) {
    ++movement_;
    glide_.stop();
  }
  mouse_.pinching = true;
  if (glide_.running()) return;
  InputEvent before = event;
  *before.at -= event.pinch.by;
  const glm::dvec2 from = held_at(before), to = held_at(event);
  view_.pan += to - from;
  zoom_about(to, event.pinch.factor);
  const glm::dvec2 arm = view_.pan - to;
  const double c = std::cos(event.pinch.roll_rad), s = std::sin(event.pinch.roll_rad);
  view_.pan = to + glm::dvec2(c * arm.x - s * arm.y, s * arm.x + c * arm.y);
  turn_view(view_, {0.0, 0.0, event.pinch.roll_rad});
}

void Navigator::use_mouse(const InputEvent& event, TimestampNs now) {
  if (event.kind == EventKind::kButton) return use_button(event, now);
  if (event.kind == EventKind::kPinch) return use_pinch(event, now);
  if (event.kind == EventKind::kWheel) {
    if (chord_action(mapping_.mouse, event.modifiers, "wheel") != Action::kZoom || !claim(Control::kMouse, now)) return;
    if (claims_.fresh()) ++movement_;
    glide_.stop();
    return zoom_about(event.at ? std::optional(held_at(event)) : std::nullopt,
                      std::pow(mapping_.mouse.zoom_per_notch, event.motion.y));
  }
  if (event.kind == EventKind::kMotion && mouse_.dragging && !glide_.running() && claim(Control::kMouse, now))
    drag_by_mouse(event);
}

void Navigator::use_events(TimestampNs now, const InputFrame& frame) {
  for (const InputEvent& event : frame.events)
    if (event.kind != EventKind::kKey) use_mouse(event, now);
}

void Navigator::use_space_mouse(TimestampNs now, const std::optional<SpaceMouseMotion>& space_mouse, double dt_s) {
  if (!space_mouse) return;
  std::array<double, 6> axes{space_mouse->push.x,  space_mouse->push.y,  space_mouse->push.z,
                             space_mouse->twist.x, space_mouse->twist.y, space_mouse->twist.z};
  double strongest = 0.0;
  for (double& a : axes) {
    const double zone = mapping_.space_mouse.dead_zone;
    a = std::abs(a) <= zone ? 0.0 : std::copysign((std::min(std::abs(a), 1.0) - zone) / (1.0 - zone), a);
    strongest = std::max(strongest, std::abs(a));
  }
  if (strongest == 0.0 || !claim(Control::kSpaceMouse, now)) return;
  if (mapping_.space_mouse.one_axis)
    for (double& a : axes) a = std::abs(a) == strongest ? a : 0.0;
  if (claims_.fresh()) ++movement_;
  glide_.stop();
  turn_view(view_, mapping_.space_mouse.turn_deg_per_s * kRadPerDeg * dt_s * glm::dvec3(axes[3], axes[4], axes[5]));
  view_.pan += mapping_.space_mouse.pan_per_s * dt_s * glm::dvec2(axes[0], axes[1]);
  view_.zoom *= std::pow(mapping_.space_mouse.zoom_per_s, axes[2] * dt_s);
}

void Navigator::drag(Action action, const glm::dvec2& moved, double deg_per_unit) {
  if (action == Action::kLight) {
    view_.light_azimuth_deg = std::fmod(view_.light_azimuth_deg + deg_per_unit * moved.x + 360.0, 360.0);
    view_.light_elevation_deg = std::clamp(view_.light_elevation_deg + deg_per_unit * moved.y, kLightLow, kLightHigh);
  } else if (action == Action::kRotate) {
    momentum_.ask_turn(deg_per_unit * kRadPerDeg * glm::dvec3(-moved.y, moved.x, 0.0));
  } else if (action == Action::kPan) {
    view_.pan += moved / kMmPerWindow;
  } else if (action == Action::kZoom) {
    momentum_.ask_zoom(moved.y / kMmPerWindow);
  }
}

void Navigator::use_gestures(TimestampNs now) {
  for (std::size_t h = 0; h < hands_.size(); ++h)
    for (const GestureEvent& event : hands_[h].events()) {
      if (event.kind == GestureKind::kGrab && event.phase == GesturePhase::kBegin) hold_.grabs_anew();
      if (event.kind == GestureKind::kSwipe && mapping_.hands.swipe == Action::kNextSide &&
          hold_.mode() == HandMode::kNone && !hands_[1 - h].grabbing() && claim(Control::kHands, now)) {
        constexpr std::array<glm::dvec3, 4> kAxes{{{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}};
        ++movement_;
        turn_to_next_side(kAxes[static_cast<std::size_t>(event.direction)], now);
      }
      if (event.kind == GestureKind::kDwell && mapping_.hands.dwell == Action::kReset &&
          hold_.mode() == HandMode::kNone && claim(Control::kHands, now)) {
        ++movement_;
        glide_to(home_, now);
      }
    }
}

/// How hands hold follows from their gestures; a hold that ends because a hand is lost throws nothing.
void Navigator::begin_or_end_hold(TimestampNs now) {
  bool released = false, lost = false;
  for (std::size_t h = 0; h < hands_.size(); ++h)
    for (const GestureEvent& event : hands_[h].events()) {
      lost = lost || event.phase == GesturePhase::kCancel;
      if (event.phase == GesturePhase::kEnd && h == hold_.leading() && hold_.mode() == HandMode::kOneGrab)
        released = true;
    }
  const auto wanted = hold_.wanted(hands_, mapping_.hands);
  if (!wanted) return;
  if (released && *wanted == HandMode::kNone && mapping_.hands.grab == Action::kRotate && hold_.turns())
    momentum_.throw_by(hands_[hold_.leading()].velocity_mps(), mapping_.hands);
  hold_.let_go();
  if (lost) momentum_.drop();
  if (*wanted == HandMode::kNone) return;
  if (!claim(Control::kHands, now)) return hold_.needs_new_grab();
  ++movement_;
  glide_.stop();
  momentum_.stop_throw();
  hold_.begin(*wanted, hands_);
}

void Navigator::follow_hands() {
  const HandMode mode = hold_.mode();
  const HandPull pull = hold_.follow(hands_, mapping_);
  if (pull.dragged_m) {
    const Action action = mode == HandMode::kPinch ? mapping_.hands.pinch : mapping_.hands.grab;
    const double gain = action == Action::kLight ? mapping_.hands.light_deg_per_mm : mapping_.hands.turn_deg_per_mm;
    drag(action, 1e3 * *pull.dragged_m, gain);
  }
  momentum_.ask_zoom(pull.zoom);
  momentum_.ask_turn({0.0, 0.0, pull.roll_rad});
}

/// Of who wears a headset: the object is in the hand.
void Navigator::use_grips(TimestampNs now, const HandGrips& grips) {
  const double height = room_.window_height_m;
  HeldObject object{height * glm::dvec3(view_.pan, view_.nearer), view_.rotation, view_.zoom, room_.radius_m};
  if (grip_.follow(grips, object, mapping_.zoom_min, mapping_.zoom_max)) {
    if (!claim(Control::kHands, now)) return grip_.let_go();
    ++movement_;
    glide_.stop();
    momentum_.drop();
  }
  if (!grip_.holds()) return;
  view_.rotation = object.rotation;
  view_.zoom = object.scale;
  view_.pan = glm::dvec2(object.centre_m) / height;
  view_.nearer = object.centre_m.z / height;
  light_by_other_hand(grips, object);
}

/// An open hand beside the one that holds is a lamp.
void Navigator::light_by_other_hand(const HandGrips& grips, const HeldObject& object) {
  constexpr double kNearM = 0.05, kFarM = 0.4;
  const HandGrip& other = grips[grip_.holds(0) ? 1 : 0];
  const glm::dvec3 way = other.pose.position_m - object.centre_m;
  const double length = glm::length(way);
  if ((grip_.holds(0) && grip_.holds(1)) || !other.active || other.closed || length < kNearM || length > kFarM) return;
  view_.light_azimuth_deg = std::fmod(std::atan2(way.x, way.y) / kRadPerDeg + 360.0, 360.0);
  view_.light_elevation_deg = std::clamp(std::asin(way.z / length) / kRadPerDeg, kLightLow, kLightHigh);
}

void Navigator::use_hands(TimestampNs now, const SteeringHands& kept, const SteeringStanding& standing, double dt_s) {
  for (std::size_t h = 0; h < hands_.size(); ++h) hands_[h].update(now, kept[h], standing[h]);
  use_gestures(now);
  begin_or_end_hold(now);
  follow_hands();
  momentum_.spend(dt_s, mapping_.hands, view_);
}

void Navigator::update(TimestampNs now, const InputFrame& frame, const SteeringHands& hands,
                       const SteeringStanding& standing) {
  const double dt_s = last_update_ < 0 ? 0.0 : std::max(0.0, seconds(now - last_update_));
  last_update_ = now;
  claims_.advance(now, hold_.mode() != HandMode::kNone || grip_.holds() || mouse_.dragging || mouse_.pinching);
  use_events(now, frame);
  use_space_mouse(now, frame.space_mouse, std::min(dt_s, 0.1));
  use_grips(now, frame.grips);
  const bool worn = frame.grips[0].active || frame.grips[1].active;
  use_hands(now, worn ? SteeringHands{} : hands, standing, dt_s);
  glide_.advance(now, view_);
  view_.zoom = std::clamp(view_.zoom, mapping_.zoom_min, mapping_.zoom_max);
}

}  // namespace dubsar
