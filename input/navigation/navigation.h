#pragma once
// From input to the view: hands, mouse, keyboard and puck steer one object through a mapping. Time is an argument.

#include <array>
#include <cstdint>
#include <optional>

#include "input/gestures/gesture.h"
#include "input/input_source.h"
#include "input/navigation/mapping.h"
#include "input/navigation/view_state.h"

namespace dubsar {

/// The hands of the person who steers (input/people/person_keeper.h), null where one is not seen.
using SteeringHands = std::array<const HandFrame*, 2>;

class Navigator {
 public:
  explicit Navigator(const Mapping& mapping, const ViewState& home = {});

  /// Everything that came since the last update; of the events those of the mouse. Gestures, glides and quarter turns
  /// advance to `now`.
  void update(TimestampNs now, const InputFrame& frame, const SteeringHands& hands);

  const ViewState& view() const noexcept { return view_; }
  /// Where the view will be when nobody does anything more: the end of a glide.
  const ViewState& goal() const noexcept { return glide_ ? glide_->to : view_; }
  /// Counts what people did, from 1 on: a drag is one movement, with the throw at its end.
  std::uint64_t movement() const noexcept { return movement_; }
  Control control() const noexcept { return control_; }  ///< who steers now
  /// Something moves by itself or is held: a picture made now will soon be old.
  bool moving() const noexcept { return glide_.has_value() || control_ != Control::kNone || moving_; }
  /// Where a dwelling hand selected something since the last update, metres in the screen frame.
  const std::optional<glm::dvec3>& selected_m() const noexcept { return selected_m_; }
  const std::array<GestureRecognizer, 2>& hands() const noexcept { return hands_; }

  /// True when a key may change the view now: nobody with a better right holds it.
  bool claim_for_keys(TimestampNs now) { return claim(Control::kKeyboard, now); }
  /// The view that a command made: at once, or as a glide.
  void go_to(const ViewState& view, TimestampNs now, bool glide);
  void set_home(const ViewState& home) { home_ = home; }
  /// Whoever held a mouse button is gone without letting go of it.
  void let_go_of_mouse();

 private:
  struct Glide {  ///< a smooth step between two views
    ViewState from, to;
    TimestampNs start = 0, duration = 1;
  };
  struct MouseDrag {
    std::array<bool, 3> buttons{};
    Action action = Action::kNone;
    bool dragging = false;
    std::optional<glm::dvec2> at, pressed_at;  // heights of the window
    std::optional<glm::dvec3> held;            // the point of the surface under the pointer, from the object's centre
    TimestampNs pressed = -1;                  // the last press, for clicks that come in pairs
  };
  enum class HandMode { kNone, kOneGrab, kTwoGrabs, kPinch };

  bool claim(Control control, TimestampNs now);
  void drop_pending();
  void release_idle_control(TimestampNs now);
  void glide_to(const ViewState& target, TimestampNs now);
  void advance_glide(TimestampNs now);
  void turn_to_next_side(const glm::dvec3& axis, TimestampNs now);

  void use_events(TimestampNs now, const InputFrame& frame);
  void use_mouse(const InputEvent& event, TimestampNs now);
  void use_button(const InputEvent& event, TimestampNs now);
  void drag_by_mouse(const InputEvent& event);
  void zoom_about(const std::optional<glm::dvec2>& at, double factor);
  void use_puck(TimestampNs now, const std::optional<PuckMotion>& puck, double dt_s);
  void use_hands(TimestampNs now, const SteeringHands& hands, double dt_s);
  void begin_or_end_hand_modes(TimestampNs now);
  void follow_hands();
  void spend_pending(double dt_s);
  void drag(Action action, const glm::dvec2& moved_mm, double turn_deg_per_mm);

  Mapping mapping_;
  ViewState home_, view_;
  std::optional<Glide> glide_;
  std::uint64_t movement_ = 0;
  Control control_ = Control::kNone;
  TimestampNs control_used_ = 0, last_update_ = -1;
  bool fresh_claim_ = false;  // the last claim changed who steers
  MouseDrag mouse_;

  std::array<GestureRecognizer, 2> hands_;
  HandMode mode_ = HandMode::kNone;
  std::size_t leading_ = 0;      // the hand of one-handed modes
  bool needs_new_grab_ = false;  // after two hands, a remaining fist does not turn the object
  bool past_dead_zone_ = false, rolls_ = false, zooms_ = false, pulls_ = false;
  glm::dvec3 anchor_m_{0.0};               // of the leading hand, moves with it
  double span_m_ = 0.0, angle_rad_ = 0.0;  // of the line between two hands, where it was last used
  glm::dvec3 pending_turn_rad_{0.0};       // asked for by hands, spent at a bounded speed
  double pending_zoom_ = 0.0;              // logarithm
  glm::dvec3 inertia_rad_per_s_{0.0};
  bool moving_ = false;
  std::optional<glm::dvec3> selected_m_;
};

}  // namespace dubsar
