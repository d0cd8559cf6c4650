#include "input/navigation/navigation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "input/navigation/square_turn.h"

namespace dubsar {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kMmPerWindow = 200.0;      // of a hand's way, when it pans by a window's height
constexpr double kPixelsPerWindow = 900.0;  // the same for the mouse
constexpr double kThrowDegPerS = 12.0;      // slower releases do not glide on
constexpr double kRestDegPerS = 1.0;
constexpr double kLongestStepS = 1.0 / 60.0;     // a late frame may not make up for its lateness in one jump
constexpr double kMostPendingRad = 20.0 * kRad;  // a hand that is faster than the object slips on it
constexpr double kMostPendingZoom = 0.4;
constexpr double kShortestGlideS = 0.25;
constexpr TimestampNs kDoubleClickNs = 400'000'000;
constexpr double kSamePlace = 0.01;  // heights of the window
constexpr double kFine = 0.25;
constexpr double kPullsRatherThanTurns = 1.5;  // of the way to the side
constexpr double kPullPerMetre = 7.0;          // logarithm of the zoom: a forearm's way is a factor of 3
constexpr double kLightLow = 5.0, kLightHigh = 85.0;

double seconds(TimestampNs ns) { return 1e-9 * static_cast<double>(ns); }

void turn(ViewState& view, const glm::dvec3& vector_rad) {
  if (vector_rad == glm::dvec3(0.0)) return;  // a view at rest stays the same to the last bit
  view.rotation = glm::normalize(turn_of(vector_rad) * view.rotation);
}

}  // namespace

Navigator::Navigator(const Mapping& mapping, const ViewState& home)
    : mapping_(mapping),
      home_(home),
      view_(home),
      hands_{GestureRecognizer(mapping.gestures), GestureRecognizer(mapping.gestures)} {}

/// True when `control` may steer now. A higher one takes the view away from a lower one.
bool Navigator::claim(Control control, TimestampNs now) {
  const auto rank = [&](Control c) {
    return std::find(mapping_.priority.begin(), mapping_.priority.end(), c) - mapping_.priority.begin();
  };
  if (rank(control) == static_cast<std::ptrdiff_t>(mapping_.priority.size())) return false;
  const auto at_desk = [](Control c) {
    return c == Control::kMouse || c == Control::kKeyboard;
  };  // one person's two hands
  if (control_ != Control::kNone && control_ != control && rank(control) > rank(control_) &&
      !(at_desk(control) && at_desk(control_)))
    return false;
  fresh_claim_ = control_ != control;
  if (fresh_claim_ && control != Control::kHands) {  // what hands had in flight ends where it is
    drop_pending();
    if (mode_ != HandMode::kNone) needs_new_grab_ = true;
    mode_ = HandMode::kNone;
  }
  control_ = control;
  control_used_ = now;
  return true;
}

void Navigator::drop_pending() {
  pending_turn_rad_ = inertia_rad_per_s_ = glm::dvec3(0.0);
  pending_zoom_ = 0.0;
}

void Navigator::release_idle_control(TimestampNs now) {
  if (mode_ != HandMode::kNone || mouse_.dragging) control_used_ = now;
  if (control_ != Control::kNone && now - control_used_ > mapping_.handover_ns) control_ = Control::kNone;
}

void Navigator::glide_to(const ViewState& target, TimestampNs now) {
  const double angle = turn_between_deg(view_.rotation, target.rotation);
  const double zoom = std::abs(std::log(target.zoom / view_.zoom));
  const double pan = glm::length(target.pan - view_.pan);
  // A smooth step is 1.5 times as fast in its middle as on average.
  const double longest = std::max({1.5 * angle / mapping_.hands.fastest_turn_deg_per_s,
                                   1.5 * zoom / std::log(mapping_.hands.fastest_zoom_per_s), pan, kShortestGlideS});
  drop_pending();
  glide_ = Glide{view_, target, now, static_cast<TimestampNs>(1e9 * longest)};
}

void Navigator::advance_glide(TimestampNs now) {
  if (!glide_) return;
  const double t =
      std::clamp(static_cast<double>(now - glide_->start) / static_cast<double>(glide_->duration), 0.0, 1.0);
  const double s = t * t * (3.0 - 2.0 * t);
  const ViewState &a = glide_->from, &b = glide_->to;
  view_.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, s));
  view_.zoom = a.zoom * std::pow(b.zoom / a.zoom, s);
  view_.pan = glm::mix(a.pan, b.pan, s);
  view_.light_azimuth_deg = glm::mix(a.light_azimuth_deg, b.light_azimuth_deg, s);
  view_.light_elevation_deg = glm::mix(a.light_elevation_deg, b.light_elevation_deg, s);
  if (t >= 1.0) {
    view_ = b;
    glide_.reset();
  }
}

void Navigator::go_to(const ViewState& view, TimestampNs now, bool glide) {
  if (glide) return glide_to(view, now);
  glide_.reset();
  drop_pending();
  view_ = view;
}

void Navigator::let_go_of_mouse() {
  mouse_.buttons = {};
  mouse_.dragging = false;
}

void Navigator::turn_to_next_side(const glm::dvec3& axis, TimestampNs now) {
  const glm::dquat from = nearest_square_turn(glide_ ? glide_->to.rotation : view_.rotation);
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
                     glm::length(*event.at - *mouse_.pressed_at) <= kSamePlace;
  mouse_.pressed = event.time;
  mouse_.pressed_at = event.at;
  mouse_.held.reset();
  if (event.at && event.lever) mouse_.held = glm::dvec3(*event.at - view_.pan, *event.lever);
  mouse_.dragging = true;
  if (twice && mouse_.action == Action::kRotate) {  // what is pointed at goes to the middle
    ViewState target = view_;
    target.pan -= *event.at;
    return glide_to(target, now);
  }
  glide_.reset();
}

/// Places of the pointer count in heights of the window, so that what is held stays under it; movements that come
/// without a place go by pixels.
void Navigator::drag_by_mouse(const InputEvent& event) {
  const MouseMapping& mouse = mapping_.mouse;
  const glm::dvec2 px = event.motion;
  const std::optional<glm::dvec2> before = std::exchange(mouse_.at, event.at);
  const glm::dvec2 moved = event.at && before ? *event.at - *before : glm::dvec2(px.x, -px.y) / kPixelsPerWindow;
  if (mouse_.action == Action::kRotate || mouse_.action == Action::kRotateFine) {
    double gain = mouse.turn_deg_per_px * kRad * glm::length(px);
    if (mouse_.held && event.at && before) gain = std::min(gain, glm::length(moved) / std::max(mouse_.held->z, 1e-3));
    if (mouse_.action == Action::kRotateFine) gain *= kFine;
    const double length = glm::length(px);
    if (length == 0.0) return;
    const glm::dvec3 vector = gain / length * glm::dvec3(px.y, px.x, 0);
    turn(view_, vector);
    if (mouse_.held) mouse_.held = turn_of(vector) * *mouse_.held;
  }
  if (mouse_.action == Action::kPan) view_.pan += moved;
  if (mouse_.action == Action::kZoom) zoom_about(mouse_.pressed_at, std::pow(mouse.zoom_per_100_px, -px.y / 100.0));
  if (mouse_.action == Action::kLight) drag(Action::kLight, glm::dvec2(px.x, -px.y), mouse.light_deg_per_px);
}

void Navigator::use_mouse(const InputEvent& event, TimestampNs now) {
  if (event.kind == EventKind::kButton) return use_button(event, now);
  if (event.kind == EventKind::kWheel) {
    if (chord_action(mapping_.mouse, event.modifiers, "wheel") != Action::kZoom || !claim(Control::kMouse, now)) return;
    if (fresh_claim_) ++movement_;
    glide_.reset();
    return zoom_about(event.at, std::pow(mapping_.mouse.zoom_per_notch, event.motion.y));
  }
  if (event.kind == EventKind::kMotion && mouse_.dragging && !glide_ && claim(Control::kMouse, now))
    drag_by_mouse(event);
}

void Navigator::use_events(TimestampNs now, const InputFrame& frame) {
  for (const InputEvent& event : frame.events)
    if (event.kind != EventKind::kKey) use_mouse(event, now);
}

void Navigator::use_puck(TimestampNs now, const std::optional<PuckMotion>& puck, double dt_s) {
  if (!puck) return;
  std::array<double, 6> axes{puck->push.x, puck->push.y, puck->push.z, puck->twist.x, puck->twist.y, puck->twist.z};
  double strongest = 0.0;
  for (double& a : axes) {
    const double zone = mapping_.puck.dead_zone;
    a = std::abs(a) <= zone ? 0.0 : std::copysign((std::min(std::abs(a), 1.0) - zone) / (1.0 - zone), a);
    strongest = std::max(strongest, std::abs(a));
  }
  if (strongest == 0.0 || !claim(Control::kPuck, now)) return;
  if (mapping_.puck.one_axis)
    for (double& a : axes) a = std::abs(a) == strongest ? a : 0.0;
  if (fresh_claim_) ++movement_;
  glide_.reset();
  turn(view_, mapping_.puck.turn_deg_per_s * kRad * dt_s * glm::dvec3(axes[3], axes[4], axes[5]));
  view_.pan += mapping_.puck.pan_per_s * dt_s * glm::dvec2(axes[0], axes[1]);
  view_.zoom *= std::pow(mapping_.puck.zoom_per_s, axes[2] * dt_s);
}

void Navigator::drag(Action action, const glm::dvec2& moved, double deg_per_unit) {
  if (action == Action::kLight) {
    view_.light_azimuth_deg = std::fmod(view_.light_azimuth_deg + deg_per_unit * moved.x + 360.0, 360.0);
    view_.light_elevation_deg = std::clamp(view_.light_elevation_deg + deg_per_unit * moved.y, kLightLow, kLightHigh);
  } else if (action == Action::kRotate) {
    pending_turn_rad_ += deg_per_unit * kRad * glm::dvec3(-moved.y, moved.x, 0.0);
  } else if (action == Action::kPan) {
    view_.pan += moved / kMmPerWindow;
  } else if (action == Action::kZoom) {
    pending_zoom_ += moved.y / kMmPerWindow;
  }
}

/// Which mode the hands are in follows from their gestures; leaving a mode by losing a hand throws nothing.
void Navigator::begin_or_end_hand_modes(TimestampNs now) {
  bool released = false, lost = false;
  for (std::size_t h = 0; h < hands_.size(); ++h)
    for (const GestureEvent& event : hands_[h].events()) {
      if (event.kind == GestureKind::kGrab && event.phase == GesturePhase::kBegin) needs_new_grab_ = false;
      lost = lost || event.phase == GesturePhase::kCancel;
      if (event.phase == GesturePhase::kEnd && h == leading_ && mode_ == HandMode::kOneGrab) released = true;
      if (event.kind == GestureKind::kSwipe && mapping_.hands.swipe == Action::kNextSide && mode_ == HandMode::kNone &&
          !hands_[1 - h].grabbing() && claim(Control::kHands, now)) {
        constexpr std::array<glm::dvec3, 4> kAxes{{{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}};
        ++movement_;
        turn_to_next_side(kAxes[static_cast<std::size_t>(event.direction)], now);
      }
      if (event.kind == GestureKind::kDwell && mapping_.hands.dwell == Action::kSelect)
        selected_m_ = hands_[h].cursor_m();
      if (event.kind == GestureKind::kDwell && mapping_.hands.dwell == Action::kReset && mode_ == HandMode::kNone &&
          claim(Control::kHands, now)) {
        ++movement_;
        glide_to(home_, now);
      }
    }
  const bool grab0 = hands_[0].grabbing(), grab1 = hands_[1].grabbing();
  HandMode wanted = HandMode::kNone;
  if (grab0 && grab1 && mapping_.hands.two_hands != Action::kNone) {
    wanted = needs_new_grab_ ? HandMode::kNone : HandMode::kTwoGrabs;
  } else if (grab0 || grab1) {
    wanted = needs_new_grab_ || mapping_.hands.grab == Action::kNone ? HandMode::kNone : HandMode::kOneGrab;
  } else if (hands_[0].pinching() || hands_[1].pinching()) {
    wanted = HandMode::kPinch;
  }
  if (mode_ == HandMode::kTwoGrabs && wanted == HandMode::kOneGrab) {
    needs_new_grab_ = true;
    wanted = HandMode::kNone;
  }
  const auto leads = [&](std::size_t h) {
    return wanted == HandMode::kPinch ? hands_[h].pinching() : hands_[h].grabbing();
  };
  const bool same_hand = wanted == HandMode::kTwoGrabs || wanted == HandMode::kNone || leads(leading_);
  if (wanted == mode_ && same_hand) return;
  if (released && wanted == HandMode::kNone && mapping_.hands.grab == Action::kRotate && past_dead_zone_ && !pulls_) {
    const glm::dvec3 v = hands_[leading_].velocity_mps() * 1e3 * mapping_.hands.turn_deg_per_mm;
    const double speed = std::hypot(v.x, v.y);
    if (speed > kThrowDegPerS && mapping_.hands.inertia_s > 0)
      inertia_rad_per_s_ =
          kRad * std::min(1.0, mapping_.hands.fastest_turn_deg_per_s / speed) * glm::dvec3(-v.y, v.x, 0);
  }
  mode_ = HandMode::kNone;
  past_dead_zone_ = rolls_ = zooms_ = pulls_ = false;
  if (lost) drop_pending();
  if (wanted == HandMode::kNone) return;
  if (!claim(Control::kHands, now)) {
    needs_new_grab_ = true;
    return;
  }
  ++movement_;
  mode_ = wanted;
  glide_.reset();
  inertia_rad_per_s_ = glm::dvec3(0.0);
  if (wanted == HandMode::kTwoGrabs) {
    const glm::dvec2 between(hands_[1].position_m() - hands_[0].position_m());
    span_m_ = glm::length(between);
    angle_rad_ = std::atan2(between.y, between.x);
  } else {
    leading_ = leads(0) ? 0 : 1;
    anchor_m_ = hands_[leading_].position_m();
  }
}

void Navigator::follow_hands() {
  const double start_m = mapping_.gestures.drag_start_m;
  if (mode_ == HandMode::kOneGrab || mode_ == HandMode::kPinch) {
    if (!hands_[leading_].seen_now()) return;
    const glm::dvec3 moved = hands_[leading_].position_m() - anchor_m_;
    const double sideways = std::hypot(moved.x, moved.y);
    if (!past_dead_zone_ && mode_ == HandMode::kOneGrab && mapping_.hands.pull != Action::kNone && !pulls_)
      pulls_ =
          std::abs(moved.z) >= mapping_.gestures.pull_start_m && std::abs(moved.z) > kPullsRatherThanTurns * sideways;
    if (pulls_) {
      if (past_dead_zone_) pending_zoom_ += kPullPerMetre * moved.z;
      past_dead_zone_ = true;
      anchor_m_ = hands_[leading_].position_m();
      return;
    }
    if (!past_dead_zone_ && mode_ == HandMode::kOneGrab && sideways < start_m) return;
    if (!past_dead_zone_ && mode_ == HandMode::kOneGrab && mapping_.hands.pull != Action::kNone &&
        std::abs(moved.z) > kPullsRatherThanTurns * sideways)
      return;  // not decided yet
    anchor_m_ = hands_[leading_].position_m();
    if (std::exchange(past_dead_zone_, true) || mode_ == HandMode::kPinch) {
      const Action action = mode_ == HandMode::kPinch ? mapping_.hands.pinch : mapping_.hands.grab;
      const double gain = action == Action::kLight ? mapping_.hands.light_deg_per_mm : mapping_.hands.turn_deg_per_mm;
      drag(action, 1e3 * glm::dvec2(moved), gain);
    }
  } else if (mode_ == HandMode::kTwoGrabs) {
    if (!hands_[0].seen_now() && !hands_[1].seen_now()) return;
    const glm::dvec2 between = glm::dvec2(hands_[1].position_m() - hands_[0].position_m());
    const double span = glm::length(between);
    if (span < 0.02) return;
    const double turned = std::remainder(std::atan2(between.y, between.x) - angle_rad_, 2.0 * std::numbers::pi);
    if (!zooms_ && std::abs(span - span_m_) >= start_m) {
      zooms_ = true;
      span_m_ = span;
    } else if (zooms_) {
      pending_zoom_ += std::log(span / span_m_);
      span_m_ = span;
    }
    if (mapping_.hands.two_hands != Action::kZoomAndRoll) return;
    if (!rolls_ && std::abs(turned) >= mapping_.gestures.roll_start_rad) {
      rolls_ = true;
      angle_rad_ += turned;
    } else if (rolls_) {
      pending_turn_rad_.z += turned;
      angle_rad_ += turned;
    }
  }
}

void Navigator::spend_pending(double dt_s) {
  const double fastest = mapping_.hands.fastest_turn_deg_per_s * kRad;
  const double dt = std::min(dt_s, kLongestStepS);
  double asked = glm::length(pending_turn_rad_);
  if (asked > kMostPendingRad) pending_turn_rad_ *= kMostPendingRad / asked;
  asked = std::min(asked, kMostPendingRad);
  pending_zoom_ = std::clamp(pending_zoom_, -kMostPendingZoom, kMostPendingZoom);
  glm::dvec3 now_rad = asked > fastest * dt ? pending_turn_rad_ * (fastest * dt / asked) : pending_turn_rad_;
  pending_turn_rad_ -= now_rad;
  if (asked == 0.0 && glm::length(inertia_rad_per_s_) > 0.0) {
    now_rad = inertia_rad_per_s_ * dt;
    inertia_rad_per_s_ *= std::exp(-dt / mapping_.hands.inertia_s);
    if (glm::length(inertia_rad_per_s_) < kRestDegPerS * kRad) inertia_rad_per_s_ = glm::dvec3(0.0);
  }
  const double most = std::log(mapping_.hands.fastest_zoom_per_s) * dt;
  const double zoom = std::clamp(pending_zoom_, -most, most);
  pending_zoom_ -= zoom;
  view_.zoom *= std::exp(zoom);
  turn(view_, now_rad);
  moving_ = glm::length(now_rad) > 0.0 || zoom != 0.0;
}

void Navigator::use_hands(TimestampNs now, const SteeringHands& kept, double dt_s) {
  for (std::size_t h = 0; h < hands_.size(); ++h) hands_[h].update(now, kept[h]);
  begin_or_end_hand_modes(now);
  follow_hands();
  spend_pending(dt_s);
}

void Navigator::update(TimestampNs now, const InputFrame& frame, const SteeringHands& hands) {
  const double dt_s = last_update_ < 0 ? 0.0 : std::max(0.0, seconds(now - last_update_));
  last_update_ = now;
  selected_m_.reset();
  release_idle_control(now);
  use_events(now, frame);
  use_puck(now, frame.puck, std::min(dt_s, 0.1));
  use_hands(now, hands, dt_s);
  advance_glide(now);
  view_.zoom = std::clamp(view_.zoom, mapping_.zoom_min, mapping_.zoom_max);
}

}  // namespace dubsar
