#pragma once
// The object in the hand: what closes within reach of it holds it, it goes where the hand goes and stays where the hand
// opens. Two hands scale it about the middle between them.

#include "input/hand_grip.h"

namespace dubsar {

/// Screen frame; metres.
struct HeldObject {
  glm::dvec3 centre_m{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;
  double radius_m = 0.05;  ///< of the object's sphere at scale 1
};

class GripHold {
 public:
  /// How far from the object's sphere a hand may close: the width of a palm.
  static constexpr double kReachM = 0.08;

  /// Follows the grips; true when something was taken hold of anew. The scale stays within [least, most].
  bool follow(const HandGrips& grips, HeldObject& object, double least, double most);
  bool holds() const noexcept { return held_[0] || held_[1]; }
  bool holds(std::size_t side) const noexcept { return held_[side]; }
  void let_go() noexcept { held_ = {}; }

 private:
  std::array<bool, 2> held_{}, closed_{};
  HandGrips from_;    // when the present hold began
  HeldObject began_;  // the object then
};

}  // namespace dubsar
