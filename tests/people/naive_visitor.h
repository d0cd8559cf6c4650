#pragma once
// Somebody who has never seen an object follow a hand: tries what he believes in, looks what comes of it, believes in
// it more or less, imitates the pictures that are shown. Knows nothing of the recogniser.

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string_view>

#include "input/simulated/seen_screen.h"
#include "tests/people/body.h"

namespace dubsar {

/// What the first idea is.
enum class NaiveKind { kWaves, kPokes, kPushes, kGrabsFar, kImitates };

enum class Intention {
  kNone,   ///< rests, talks, points, scratches, leaves: nothing should move
  kProbe,  ///< something should happen, whatever it is
  kTurn,
  kZoom,
  kOpen,  ///< what is inside should come out, or go back
};

class NaiveVisitor {
 public:
  NaiveVisitor(NaiveKind kind, std::uint64_t seed, double leaves_s);

  /// Decides what to do next when the last attempt is over. Rising times.
  void look(double t_s, const SeenScreen& seen);

  Intention intention(double t_s) const;
  /// What he tries now, in a word.
  std::string_view tries() const;
  /// The way of the hand in an attempt to turn, or its sign in one to zoom (x).
  const glm::dvec2& sense() const noexcept { return sense_; }
  const Body& body() const noexcept { return body_; }
  const std::array<Arm, 2>& arms() const noexcept { return arms_; }  ///< the better one first
  glm::dvec3 eyes_m(double t_s) const;

 private:
  enum Idea { kWave, kSweep, kPush, kPoke, kGrab, kPinch, kTwoHands, kPull, kTouch, kIdeas };
  void begin(Intention intention, double t_s, const SeenScreen& seen);
  void judge(const SeenScreen& seen);
  void study(SeenLesson lesson);
  double wit() const noexcept;
  void follow_arrow();
  Idea choose(const SeenScreen& seen);
  void act(double t_s, const SeenScreen& seen);
  void attempt(Idea idea, double t_s);
  void idle(double t_s);
  void wave(double t_s);
  void carry(double t_s, bool pinching);
  void sweep(double t_s, double hurry);
  void poke(double t_s);
  void two_hands(double t_s);
  void pull(double t_s);
  void touch(double t_s, const SeenScreen& seen);
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
    bool opened = false;  ///< before
    bool shown = false;   ///< a mark of the hand was to be seen
    bool arrow = false;   ///< an arrow upwards, while the hand was up
  } trial_;
  glm::dvec2 sense_{0.0};
  struct Manner {
    double effort = 1.0, hurry = 1.0, stretch = 0.6, wants = 0.6;
    int turned = 0, zoomed = 0, opened = 0;  ///< how often that worked
    bool lost = false;                       ///< no mark showed the hand lately
    double higher_m = 0.0;                   ///< held above where it would be held by itself
  } manner_;
  struct Aim {                       ///< a mark is to be brought to a sign, by looking at it
    std::optional<glm::dvec2> mark;  ///< where it was before the last step
    glm::dvec3 step_m{0.0};
    double heights_per_m = 1.0;  ///< what a metre of the hand does to the mark, as he believes
    int left = 0;
  } aim_;
  bool left_ = false;
};

}  // namespace dubsar
