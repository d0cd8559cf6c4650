#pragma once
// How people's arms and hands move, whoever watches them: reach, bows of a movement, tremor, fatigue; fingers as a real
// hand closed and opened them. Nothing here knows how gestures are recognised.

#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/numbers/pose.h"
#include "input/simulated/script.h"
#include "tests/people/recorded_hands.h"

namespace dubsar {

/// One person's measures. Metres in the screen frame, seconds.
struct Body {
  glm::dvec3 eyes_m{0.0, 0.1, 0.7};  ///< between them, standing where it stands
  double arm_m = 0.7;                ///< shoulder to palm, stretched
  double shoulders_m = 0.38;         ///< from one to the other
  double size = 1.0;                 ///< of the hand
  bool left_handed = false;
  double tremor_m = 0.0005, tremor_hz = 9.0;
  double sag_mps = 0.004;                         ///< a hand that is held up sinks
  double swiftness = 1.0;                         ///< 1: average
  double relaxed_grab = 0.1, closed_grab = 0.95;  ///< how closed a resting and a gripping hand look, 0..1
  double reaction_s = 0.3;
  bool sleeves = false;  ///< wide ones: the hand is lost more often
};

/// Adults, tall and short ones, children and people who sit, as they come; they stand before the panel's centre.
Body draw_body(ScriptRandom& random);
glm::dvec3 shoulder_m(const Body& body, bool left);
/// Where the hand is held: before the shoulder, or by `wants` (0..1) towards the object; `stretch`: share of the arm's
/// length, 0..1.
glm::dvec3 held_up_m(const Body& body, bool left, double stretch, double wants = 0.6);

/// A hand at one moment, as it is.
struct HandAsItIs {
  Pose palm{};
  double grab = 0.0, pinch_m = 0.06;
  double index = 0.0;  ///< how bent the index finger is, 0..1
};

/// One arm. Movements are added in the order of time; each begins when the one before has ended.
class Arm {
 public:
  Arm(const Body& body, bool left, std::uint64_t seed);

  /// Up from the hip to `at`, at `t_s` or when the movement before has ended. Returns the time of arrival, as all do.
  double raise(double t_s, const glm::dvec3& at_m);
  /// By minimum jerk (Flash and Hogan 1985), as long as Fitts' law (1954) wants for a target of `width_m`; `hurry`
  /// divides it.
  double move(double t_s, const glm::dvec3& to_m, double width_m = 0.03, double hurry = 1.0);
  double hold(double t_s, double seconds);
  double lower(double t_s);
  /// The fingers, beside what the arm does; 0: as relaxed as they are, 1: as closed as they get. Ends when they rest.
  double grip(double t_s, double effort);
  /// Thumb to index finger.
  double pinch(double t_s, double distance_m);
  /// The index finger is stretched, whatever the others do.
  void point(double t_s, bool stretched);

  /// Nothing while it hangs down.
  std::optional<HandAsItIs> at(double t_s) const;
  double busy_until_s() const noexcept { return strokes_.empty() ? 0.0 : strokes_.back().end_s; }
  bool is_up() const noexcept { return up_; }
  glm::dvec3 place_m() const;  ///< at the end of all movements
  bool left() const noexcept { return left_; }

 private:
  struct Stroke {
    double start_s, end_s;
    glm::dvec3 from_m, to_m, bow_m;
    bool visible;
  };
  struct Change {
    double start_s, end_s, from, to;
    const RecordedFingers* as;  ///< how a real hand did it
    glm::dvec3 palm_m;          ///< where the change before left the palm, beside where the arm holds it
  };
  double stroke(double t_s, const glm::dvec3& to_m, double seconds, bool visible);
  const Stroke* stroke_at(double t_s) const;
  glm::dvec3 steady_at(double t_s) const;  ///< without tremor
  static const Change* change_at(const std::vector<Change>& changes, double t_s);
  static double value_at(const std::vector<Change>& changes, double t_s, double rest,
                         double RecordedFingers::State::*what);
  double bent_at(double t_s) const;      ///< the index finger, of what the hand is
  glm::dvec3 palm_at(double t_s) const;  ///< what closing fingers do to the palm
  const RecordedFingers& some_fingers(bool close);

  Body body_;
  bool left_, up_ = false;
  ScriptRandom random_;
  double phase_;
  std::vector<Stroke> strokes_;
  std::vector<Change> grips_, pinches_;
  std::vector<std::pair<double, bool>> bends_;  ///< from when on the index finger is stretched, or not
};

}  // namespace dubsar
