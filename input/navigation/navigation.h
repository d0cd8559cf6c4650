#pragma once
// From input to the view: hands, mouse, keyboard and SpaceMouse steer one object through a mapping. Time is an
// argument.

#include <array>
#include <cstdint>
#include <optional>

#include "input/gestures/gesture.h"
#include "input/hand_standing.h"
#include "input/input_source.h"
#include "input/navigation/control_claims.h"
#include "input/navigation/grip_hold.h"
#include "input/navigation/hand_hold.h"
#include "input/navigation/held_place.h"
#include "input/navigation/mapping.h"
#include "input/navigation/momentum.h"
#include "input/navigation/view_glide.h"
#include "input/navigation/view_state.h"

namespace dubsar {

/// The hold of a mouse on the object.
struct MouseDrag {
  std::array<bool, 3> buttons{};
  Action action = Action::kNone;
  bool dragging = false, pinching = false;
  std::optional<glm::dvec2> at, pressed_at;  ///< heights of the window
  std::optional<HeldPlace> held;             ///< of the surface, under the pointer; none: the drag turns by its length
  TimestampNs pressed = -1;                  ///< the last press, for clicks that come in pairs
};

/// The hands of the person who steers (input/people/person_keeper.h), null where one is not seen.
using SteeringHands = std::array<const HandFrame*, 2>;
using SteeringStanding = std::array<HandStanding, 2>;

/// What a hand of a headset's wearer needs to know to take hold of the object; metres.
struct WornRoom {
  double window_height_m = 0.3;  ///< what pan and nearer count in
  double radius_m = 0.05;        ///< of the object's sphere at zoom 1
};

class Navigator {
 public:
  explicit Navigator(const Mapping& mapping, const ViewState& home = {});

  /// Everything that came since the last update; of the events those of the mouse. Gestures, glides and quarter turns
  /// advance to `now`.
  void update(TimestampNs now, const InputFrame& frame, const SteeringHands& hands,
              const SteeringStanding& standing = {});

  const ViewState& view() const noexcept { return view_; }
  /// Where the view will be when nobody does anything more: the end of a glide.
  const ViewState& goal() const noexcept { return glide_.running() ? glide_.goal() : view_; }
  /// Counts what people did, from 1 on: a drag is one movement, with the throw at its end.
  std::uint64_t movement() const noexcept { return movement_; }
  Control control() const noexcept { return claims_.control(); }  ///< who steers now
  /// Something moves by itself or is held: a picture made now will soon be old.
  bool moving() const noexcept { return glide_.running() || claims_.control() != Control::kNone || momentum_.moving(); }
  const std::array<GestureRecognizer, 2>& hands() const noexcept { return hands_; }

  /// True when a key may change the view now: nobody with a better right holds it.
  bool claim_for_keys(TimestampNs now) { return claim(Control::kKeyboard, now); }
  /// The view that a command made: at once, or as a glide.
  void go_to(const ViewState& view, TimestampNs now, bool glide);
  void set_home(const ViewState& home) { home_ = home; }
  /// What whoever leads the session knows of it; for both hands.
  void set_scene(const GestureScene& scene) {
    for (GestureRecognizer& hand : hands_) hand.set_scene(scene);
  }
  void set_room(const WornRoom& room) { room_ = room; }
  /// Whoever held a mouse button or had fingers on the glass is gone without letting go.
  void let_go_of_mouse();

 private:
  bool claim(Control control, TimestampNs now);
  void glide_to(const ViewState& target, TimestampNs now);
  void turn_to_next_side(const glm::dvec3& axis, TimestampNs now);

  void use_events(TimestampNs now, const InputFrame& frame);
  void use_mouse(const InputEvent& event, TimestampNs now);
  void use_button(const InputEvent& event, TimestampNs now);
  void drag_by_mouse(const InputEvent& event);
  void use_pinch(const InputEvent& event, TimestampNs now);
  void turn_by_mouse(const glm::dvec2& px, const std::optional<glm::dvec2>& moved, double gain);
  void zoom_about(const std::optional<glm::dvec2>& at, double factor);
  void use_space_mouse(TimestampNs now, const std::optional<SpaceMouseMotion>& space_mouse, double dt_s);
  void use_hands(TimestampNs now, const SteeringHands& hands, const SteeringStanding& standing, double dt_s);
  void use_grips(TimestampNs now, const HandGrips& grips);
  void light_by_other_hand(const HandGrips& grips, const HeldObject& object);
  void use_gestures(TimestampNs now);
  void begin_or_end_hold(TimestampNs now);
  void follow_hands();
  void drag(Action action, const glm::dvec2& moved_mm, double turn_deg_per_mm);

  Mapping mapping_;
  ViewState home_, view_;
  ViewGlide glide_;
  std::uint64_t movement_ = 0;
  ControlClaims claims_;
  TimestampNs last_update_ = -1;
  MouseDrag mouse_;
  std::array<GestureRecognizer, 2> hands_;
  HandHold hold_;
  GripHold grip_;
  WornRoom room_;
  Momentum momentum_;
};

}  // namespace dubsar
