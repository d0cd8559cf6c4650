#pragma once
// How one or two hands hold the object, and how far they have carried it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "input/gestures/gesture.h"
#include "input/navigation/mapping.h"

namespace dubsar {

enum class HandMode : std::uint8_t { kNone, kOneGrab, kTwoGrabs, kPinch };

/// What hands ask for since the last time.
struct HandPull {
  std::optional<glm::dvec2> dragged_m;  ///< by one hand that grabs or pinches
  double zoom = 0.0;                    ///< logarithm
  double roll_rad = 0.0;
};

class HandHold {
 public:
  using Hands = std::array<GestureRecognizer, 2>;

  HandMode mode() const noexcept { return mode_; }
  /// The hand of one-handed modes.
  std::size_t leading() const noexcept { return leading_; }
  /// One hand turns the object, rather than drawing it nearer or resting on it.
  bool turns() const noexcept { return mode_ == HandMode::kOneGrab && past_dead_zone_ && !pulls_; }

  /// The mode that the hands' gestures want, when it is another one or another hand's. After two hands a remaining
  /// fist holds nothing until it was opened.
  std::optional<HandMode> wanted(const Hands& hands, const HandMapping& mapping);
  void begin(HandMode mode, const Hands& hands);
  void let_go();
  /// Hands that close now hold again.
  void grabs_anew() { needs_new_grab_ = false; }
  /// Whoever holds must open the hand first.
  void needs_new_grab() { needs_new_grab_ = true; }
  /// Somebody with a better right steers.
  void take_away();

  HandPull follow(const Hands& hands, const Mapping& mapping);

 private:
  HandPull follow_one(const GestureRecognizer& hand, const Mapping& mapping);
  HandPull follow_two(const Hands& hands, const Mapping& mapping);

  HandMode mode_ = HandMode::kNone;
  std::size_t leading_ = 0;
  bool needs_new_grab_ = false, past_dead_zone_ = false, rolls_ = false, zooms_ = false, pulls_ = false;
  glm::dvec3 anchor_m_{0.0};               // of the leading hand, moves with it
  double span_m_ = 0.0, angle_rad_ = 0.0;  // of the line between two hands, where it was last used
};

}  // namespace dubsar
