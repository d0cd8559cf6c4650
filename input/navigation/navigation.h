#pragma once
// From input to the view: hands, mouse, keyboard and puck steer one object through a mapping. Time is an argument.

#include <array>
#include <optional>
#include <vector>

#include "input/gestures/gesture.h"
#include "input/input_source.h"
#include "input/navigation/mapping.h"
#include "input/navigation/view_state.h"
#include "input/people/person_keeper.h"

namespace dubsar {

class Navigator {
 public:
  explicit Navigator(const Mapping& mapping, const ViewState& home = {});

  /// Everything that came since the last update. Gestures, glides and quarter turns advance to `now`.
  void update(TimestampNs now, const InputFrame& frame);

  const ViewState& view() const noexcept { return view_; }
  Control control() const noexcept { return control_; }  ///< who steers now
  /// Something moves by itself or is held: a picture made now will soon be old.
  bool moving() const noexcept { return glide_.has_value() || control_ != Control::kNone || moving_; }
  /// Where a dwelling hand selected something since the last update, metres in the screen frame.
  const std::optional<glm::dvec3>& selected_m() const noexcept { return selected_m_; }
  const std::optional<HeadFrame>& kept_head() const noexcept { return kept_head_; }  ///< none: not in the last frame
  const std::array<GestureRecognizer, 2>& hands() const noexcept { return hands_; }
  std::size_t undo_depth() const noexcept { return undo_.size(); }

  void reset(TimestampNs now);  ///< back to the home view, as a glide
  void undo(TimestampNs now);   ///< back to the view before the last change, as a glide

 private:
  struct Glide {  ///< a smooth step between two views
    ViewState from, to;
    TimestampNs start = 0, duration = 1;
  };
  enum class HandMode { kNone, kOneGrab, kTwoGrabs, kPinch };

  bool claim(Control control, TimestampNs now);
  void drop_pending();
  void release_idle_control(TimestampNs now);
  void remember();
  void glide_to(const ViewState& target, TimestampNs now);
  void advance_glide(TimestampNs now);
  void turn_to_next_side(const glm::dvec3& axis, TimestampNs now);
  void step(Action action, TimestampNs now);

  void use_events(TimestampNs now, const InputFrame& frame);
  void use_mouse(const InputEvent& event, TimestampNs now);
  void use_puck(TimestampNs now, const std::optional<PuckMotion>& puck, double dt_s);
  void use_hands(TimestampNs now, const InputFrame& frame, double dt_s);
  void begin_or_end_hand_modes(TimestampNs now);
  void follow_hands();
  void spend_pending(double dt_s);
  void drag(Action action, const glm::dvec2& moved_mm, double turn_deg_per_mm);

  Mapping mapping_;
  ViewState home_, view_;
  std::vector<ViewState> undo_;
  std::optional<Glide> glide_;
  Control control_ = Control::kNone;
  TimestampNs control_used_ = 0, last_update_ = -1;
  bool fresh_claim_ = false;  // the last claim changed who steers
  std::array<bool, 3> buttons_{};
  Action mouse_action_ = Action::kNone;
  bool mouse_dragging_ = false;

  HeadKeeper head_keeper_;
  HandKeeper hand_keeper_;
  std::optional<HeadFrame> kept_head_;
  std::array<GestureRecognizer, 2> hands_;
  HandMode mode_ = HandMode::kNone;
  std::size_t leading_ = 0;      // the hand of one-handed modes
  bool needs_new_grab_ = false;  // after two hands, a remaining fist does not turn the object
  bool past_dead_zone_ = false, rolls_ = false, zooms_ = false;
  glm::dvec3 anchor_m_{0.0};               // of the leading hand, moves with it
  double span_m_ = 0.0, angle_rad_ = 0.0;  // of the line between two hands, where it was last used
  glm::dvec3 pending_turn_rad_{0.0};       // asked for by hands, spent at a bounded speed
  double pending_zoom_ = 0.0;              // logarithm
  glm::dvec3 inertia_rad_per_s_{0.0};
  bool moving_ = false;
  std::optional<glm::dvec3> selected_m_;
};

}  // namespace dubsar
