#pragma once
// What hands asked of the object and it has not done yet: a bounded speed, a bounded backlog, and the turn that goes on
// after a throw.

#include "input/navigation/mapping.h"
#include "input/navigation/view_state.h"

namespace dubsar {

/// Turns the view's object; a view at rest stays the same to the last bit.
void turn_view(ViewState& view, const glm::dvec3& vector_rad);

class Momentum {
 public:
  void ask_turn(const glm::dvec3& vector_rad) { turn_rad_ += vector_rad; }
  void ask_zoom(double logarithm) { zoom_ += logarithm; }
  /// The object goes on as a hand that moved at `velocity_mps` let go of it; slow ones leave it where it is.
  void throw_by(const glm::dvec3& velocity_mps, const HandMapping& hands);
  void stop_throw() { inertia_rad_per_s_ = glm::dvec3(0.0); }
  /// Forgets everything.
  void drop();
  /// Does what `dt_s` seconds allow of it.
  void spend(double dt_s, const HandMapping& hands, ViewState& view);
  bool moving() const noexcept { return moving_; }  ///< the last spend moved something

 private:
  glm::dvec3 turn_rad_{0.0};
  double zoom_ = 0.0;  // logarithm
  glm::dvec3 inertia_rad_per_s_{0.0};
  bool moving_ = false;
};

}  // namespace dubsar
