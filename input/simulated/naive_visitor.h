#pragma once
// Somebody who has never seen an object follow a hand: tries what he believes in, looks what comes of it, believes in
// it more or less, imitates the pictures that are shown. Knows nothing of the recogniser.

#include <array>
#include <glm/vec2.hpp>
#include <optional>

#include "input/navigation/view_state.h"
#include "input/simulated/body.h"

namespace dubsar {

/// What the first idea is.
enum class NaiveKind { kWaves, kPokes, kPushes, kGrabsFar, kImitates };

enum class Intention {
  kNone,   ///< rests, talks, points, scratches, leaves: nothing should move
  kProbe,  ///< something should happen, whatever it is
  kTurn,
  kZoom,
};

/// A picture beside the object that shows a gesture.
enum class Lesson { kNone, kGrabAndMove, kSwipe, kNearer };

class NaiveVisitor {
 public:
  NaiveVisitor(NaiveKind kind, std::uint64_t seed, double leaves_s);

  /// Decides what to do next when the last attempt is over. Rising times; what the display shows: the object, a lesson,
  /// and whether a mark shows where his hand is.
  void look(double t_s, const ViewState& seen, Lesson lesson, bool hand_shown);

  Intention intention(double t_s) const;
  /// The way of the hand in an attempt to turn, or its sign in one to zoom (x).
  const glm::dvec2& sense() const noexcept { return sense_; }
  const Body& body() const noexcept { return body_; }
  const std::array<Arm, 2>& arms() const noexcept { return arms_; }  ///< the better one first
  glm::dvec3 eyes_m(double t_s) const;

 private:
  enum Idea { kWave, kSweep, kPush, kPoke, kGrab, kPinch, kTwoHands, kPull, kIdeas };
  void begin(Intention intention, double t_s, const ViewState& seen);
  void judge(const ViewState& seen);
  void study(Lesson lesson);
  Idea choose();
  void attempt(Idea idea, double t_s);
  void idle(double t_s);
  void wave(double t_s);
  void carry(double t_s, bool pinching);
  void sweep(double t_s, double hurry);
  void poke(double t_s);
  void two_hands(double t_s);
  void pull(double t_s);
  double ready(double t_s);
  glm::dvec3 spot();
  glm::dvec2 some_way();

  NaiveKind kind_;
  ScriptRandom random_;
  Body body_;
  std::array<Arm, 2> arms_;
  std::array<double, kIdeas> belief_{};
  double leaves_s_, wakes_s_, studies_s_;
  struct Trial {
    Idea idea = kIdeas;
    Intention intention = Intention::kNone;
    double end_s = 0.0;
    ViewState before{};
    bool shown = false;  ///< a mark of the hand was to be seen
  } trial_;
  glm::dvec2 sense_{0.0};
  struct Manner {
    double effort = 1.0, hurry = 1.0, stretch = 0.6, wants = 0.6;
    int turned = 0, zoomed = 0;  ///< how often that worked
  } manner_;
  bool left_ = false;
};

}  // namespace dubsar
