#pragma once
// A simulated visitor with eyes and two hands: looks at the object, takes it, turns it, looks again, until it stands as
// wished. Does not know the gains exactly, overshoots, and does not notice at once when the tracker lost a hand.

#include "input/navigation/view_state.h"
#include "input/simulated/script.h"

namespace dubsar {

class SimulatedVisitor {
 public:
  SimulatedVisitor(const VisitorGoal& goal, std::uint64_t seed);

  /// Decides what to do next when the last movement is over. `seen` is what the display shows at t_s.
  void look(double t_s, const ViewState& seen);
  bool content() const noexcept { return content_; }
  bool gone() const noexcept { return gone_; }  ///< hands are down again, content or out of patience
  const std::array<HandTrack, 2>& hands() const noexcept { return hands_; }  ///< right, left

 private:
  void hold(double seconds);  ///< both hands stay as they are
  void move(std::size_t hand, const glm::dvec3& to, double seconds);
  void close(double seconds, bool both, double grab);
  void stroke(const glm::dvec3& error_rad);
  void two_hands(double zoom_error, double roll_error_rad);

  VisitorGoal goal_;
  glm::dquat wished_;
  ScriptRandom random_;
  std::array<HandTrack, 2> hands_;
  double busy_until_s_ = 0, gain_deg_per_mm_ = 0;
  bool left_in_ = false;  // the left hand is held up too
  bool entered_ = false, content_ = false, gone_ = false;
};

/// People who stand beside the visitor, lean in, and wave their fists into the zone.
void add_bystanders(Script& script);

}  // namespace dubsar
