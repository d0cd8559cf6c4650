#include "tests/people/naive_visitor.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/numbers/angle.h"

namespace dubsar {
namespace {

constexpr double kNoticed_rad = 5.0 * kRadPerDeg, kNoticedZoom = 0.08;
constexpr double kAfter_s = 0.5;  // what happens so soon after a movement came of it
constexpr double kHelped = 5.0, kOddly = 1.4, kDidNothing = 0.4, kUnderstood = 4.0;
constexpr double kKnownByNow = 1.0;
constexpr double kFollowArrows = 0.56;
constexpr double kHighest_m = 0.25;  // a forearm: nobody reaches above his head for an arrow
constexpr int kEnough = 2;           // successes until something else is wanted

Body body_of(std::uint64_t seed) {
  ScriptRandom random(seed * 31 + 7);
  return draw_body(random);
}

}  // namespace

NaiveVisitor::NaiveVisitor(NaiveKind kind, std::uint64_t seed, double leaves_s)
    : kind_(kind),
      random_(seed),
      body_(body_of(seed)),
      arms_{Arm(body_, body_.left_handed, seed * 3 + 1), Arm(body_, !body_.left_handed, seed * 3 + 2)},
      leaves_s_(leaves_s) {
  belief_ = {0.4, 0.4, 0.4, 0.4, 0.8, 0.3, 0.05, 0.05, 0.2};
  switch (kind) {
    case NaiveKind::kWaves:
      belief_[kWave] = 4.0;
      break;
    case NaiveKind::kPokes:
      belief_[kPoke] = 4.0;
      break;
    case NaiveKind::kPushes:
      belief_[kPush] = 4.0;
      break;
    case NaiveKind::kGrabsFar:
      belief_[kGrab] = 4.0;
      break;
    case NaiveKind::kImitates:
      break;
  }
  manner_.stretch = kind == NaiveKind::kGrabsFar ? random_.uniform(0.3, 0.5) : random_.uniform(0.5, 0.85);
  manner_.wants = random_.uniform(0.5, 0.85);
  wakes_s_ = random_.uniform(0.6, 2.5);
  studies_s_ = random_.uniform(0.8, 3.0);
}

glm::dvec3 NaiveVisitor::eyes_m(double t_s) const {
  return body_.eyes_m + 0.012 * glm::dvec3(std::sin(0.9 * t_s), 0.3 * std::sin(0.7 * t_s), std::sin(0.5 * t_s));
}

Intention NaiveVisitor::intention(double t_s) const {
  return t_s <= trial_.end_s + kAfter_s ? trial_.intention : Intention::kNone;
}

std::string_view NaiveVisitor::tries() const {
  constexpr std::array<std::string_view, kIdeas + 1> kNames{"wave",  "sweep",     "push", "poke",  "grab",
                                                            "pinch", "two hands", "pull", "touch", "nothing"};
  return kNames[trial_.idea];
}

glm::dvec2 NaiveVisitor::some_way() {
  const double side = random_.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  const double steep = random_.uniform(0.0, 1.0) < 0.75 ? 0.25 * random_.normal() : 1.2 * random_.normal();
  return glm::normalize(glm::dvec2(side, steep));
}

glm::dvec3 NaiveVisitor::spot() {
  return held_up_m(body_, arms_[0].left(), manner_.stretch, manner_.wants) +
         0.03 * glm::dvec3(random_.normal(), random_.normal(), 0.5 * random_.normal()) +
         glm::dvec3(0.0, manner_.higher_m, 0.0);
}

double NaiveVisitor::ready(double t_s) {
  if (!arms_[0].is_up())
    t_s = arms_[0].raise(t_s, spot());
  else if (manner_.lost)  // who saw no trace of his hand holds it elsewhere
    t_s = arms_[0].move(t_s, spot());
  manner_.lost = false;
  arms_[0].grip(t_s, 0.0);
  return arms_[0].hold(t_s, random_.uniform(0.15, 0.5));
}

void NaiveVisitor::begin(Intention intention, double t_s, const SeenScreen& seen) {
  trial_.intention = intention;
  trial_.end_s = t_s;
  trial_.before = seen.view;
  trial_.opened = seen.opened;
  trial_.shown = trial_.arrow = false;
}

/// There and back again, several times.
void NaiveVisitor::wave(double t_s) {
  t_s = ready(t_s);
  const glm::dvec3 middle = arms_[0].place_m();
  const double reach = random_.uniform(0.05, 0.12);
  const int times = 3 + static_cast<int>(random_.uniform(0.0, 4.0));
  for (int i = 0; i < times; ++i)
    t_s = arms_[0].move(t_s, middle + glm::dvec3(i % 2 == 0 ? reach : -reach, 0.0, 0.0), 0.09, 1.5 * manner_.hurry);
  trial_.end_s = arms_[0].move(t_s, middle);
}

/// A flat hand pushes the object's side, as one turns a globe.
void NaiveVisitor::sweep(double t_s, double hurry) {
  sense_ = some_way();
  t_s = ready(t_s);
  const glm::dvec3 from = spot() - 0.5 * random_.uniform(0.12, 0.25) * glm::dvec3(sense_, 0.0);
  t_s = arms_[0].hold(arms_[0].move(t_s, from), random_.uniform(0.1, 0.4));
  t_s = arms_[0].move(t_s, from + random_.uniform(0.15, 0.3) * glm::dvec3(sense_, 0.0), 0.06, hurry * manner_.hurry);
  trial_.end_s = arms_[0].hold(t_s, random_.uniform(0.2, 0.6));
}

void NaiveVisitor::poke(double t_s) {
  t_s = ready(t_s);
  const glm::dvec3 from = arms_[0].place_m();
  arms_[0].point(t_s, true);
  for (int i = 0, times = 1 + static_cast<int>(random_.uniform(0.0, 3.0)); i < times; ++i) {
    arms_[0].grip(t_s, 0.55 * random_.uniform(0.7, 1.1));  // the index finger alone is stretched
    t_s = arms_[0].move(t_s, from + glm::dvec3(0.0, 0.0, -random_.uniform(0.06, 0.15)), 0.02, manner_.hurry);
    t_s = arms_[0].move(t_s, from);
  }
  arms_[0].point(t_s, false);
  arms_[0].grip(t_s, 0.0);
  trial_.end_s = t_s;
}

/// Takes hold and carries the side of the object along.
void NaiveVisitor::carry(double t_s, bool pinching) {
  sense_ = some_way();
  t_s = ready(t_s);
  const glm::dvec3 from = arms_[0].place_m();
  t_s = pinching ? arms_[0].pinch(t_s, 0.012) : arms_[0].grip(t_s, std::min(1.15, manner_.effort));
  t_s = arms_[0].hold(t_s, random_.uniform(0.0, 0.3));
  t_s = arms_[0].move(t_s, from + random_.uniform(0.08, 0.22) * glm::dvec3(sense_, 0.15 * random_.normal()), 0.03,
                      0.9 * manner_.hurry);
  t_s = arms_[0].hold(t_s, random_.uniform(0.1, 0.6));
  trial_.end_s = arms_[0].grip(t_s, 0.0);
}

void NaiveVisitor::two_hands(double t_s) {
  sense_ = {random_.uniform(0.0, 1.0) < 0.7 ? 1.0 : -1.0, 0.0};
  const glm::dvec3 middle = 0.5 * (held_up_m(body_, false, manner_.stretch, manner_.wants) +
                                   held_up_m(body_, true, manner_.stretch, manner_.wants));
  const double near = random_.uniform(0.08, 0.13), far = random_.uniform(0.17, 0.26);
  const double first = sense_.x > 0 ? near : far, last = sense_.x > 0 ? far : near;
  double end = t_s;
  for (Arm& arm : arms_) {
    const glm::dvec3 side(arm.left() ? -1.0 : 1.0, 0.0, 0.0);
    double t = arm.is_up() ? arm.move(t_s, middle + first * side) : arm.raise(t_s, middle + first * side);
    arm.grip(t_s, 0.0);
    t = arm.hold(t, random_.uniform(0.2, 0.5));
    t = arm.grip(t, std::min(1.15, manner_.effort));
    t = arm.hold(t, random_.uniform(0.0, 0.3));
    t = arm.move(t, middle + last * side, 0.04, 0.9 * manner_.hurry);
    t = arm.hold(t, random_.uniform(0.1, 0.4));
    end = std::max(end, arm.grip(t, 0.0));
  }
  arms_[1].lower(arms_[1].hold(end, 0.2));
  trial_.end_s = end;
}

/// Takes hold and draws the object nearer.
void NaiveVisitor::pull(double t_s) {
  sense_ = {random_.uniform(0.0, 1.0) < 0.75 ? 1.0 : -1.0, 0.0};
  t_s = ready(t_s);
  const glm::dvec3 from = arms_[0].place_m();
  t_s = arms_[0].hold(arms_[0].grip(t_s, std::min(1.15, manner_.effort)), random_.uniform(0.0, 0.3));
  const glm::dvec3 way(0.2 * random_.normal(), 0.2 * random_.normal(), sense_.x);
  t_s = arms_[0].move(t_s, from + random_.uniform(0.07, 0.15) * way, 0.03, 0.9 * manner_.hurry);
  t_s = arms_[0].hold(t_s, random_.uniform(0.1, 0.5));
  trial_.end_s = arms_[0].grip(t_s, 0.0);
}

/// Brings the mark of the hand over the sign, one movement after the other, and rests there; without a mark, the hand
/// itself is held between eye and sign.
void NaiveVisitor::touch(double t_s, const SeenScreen& seen) {
  Arm& arm = arms_[0];
  const auto give_up = [&] {
    aim_.left = 0;
    trial_.end_s = t_s;
  };
  if (seen.sign && seen.sign_filled > 0.0) {  // something goes on: wait and see
    trial_.end_s = arm.hold(t_s, random_.uniform(0.2, 0.5));
    return;
  }
  if (!seen.sign || aim_.left-- <= 0) return give_up();
  if (!arm.is_up()) {
    arm.grip(t_s, 0.0);
    trial_.end_s = arm.hold(arm.raise(t_s, spot()), body_.reaction_s);
    return;
  }
  if (!seen.my_mark) {
    const glm::dvec3 sign_m(0.3 * *seen.sign, 0.0);  // a panel is about a foot high
    const glm::dvec3 to = glm::mix(body_.eyes_m, sign_m, manner_.stretch * body_.arm_m / glm::length(body_.eyes_m));
    trial_.end_s = arm.hold(arm.move(t_s, to, 0.04), 1.0);
    aim_.mark.reset();
    return;
  }
  const glm::dvec2 error = *seen.sign - *seen.my_mark;
  if (aim_.mark && glm::length(aim_.step_m) > 0.02) {  // what came of the last movement
    const double done =
        glm::dot(*seen.my_mark - *aim_.mark, glm::dvec2(aim_.step_m)) / glm::dot(aim_.step_m, aim_.step_m);
    if (done > 0.1) aim_.heights_per_m = std::clamp(done, 0.3, 5.0);
  }
  if (glm::length(error) < 0.6 * seen.sign_radius) {
    trial_.end_s = arm.hold(t_s, random_.uniform(1.2, 2.2));
    aim_.mark.reset();
    return;
  }
  aim_.mark = seen.my_mark;
  aim_.step_m = glm::dvec3(error / aim_.heights_per_m, 0.0);
  if (const double length = glm::length(aim_.step_m); length > 0.35) aim_.step_m *= 0.35 / length;
  const glm::dvec3 shoulder = shoulder_m(body_, arm.left());
  glm::dvec3 to = arm.place_m() + aim_.step_m;
  if (const double far = glm::length(to - shoulder); far > 0.97 * body_.arm_m)
    to = shoulder + (0.97 * body_.arm_m / far) * (to - shoulder);
  trial_.end_s = arm.hold(arm.move(t_s, to, 0.03), 0.5 * body_.reaction_s);
}

/// What people do between: let the arm hang, talk with the hand, scratch, rest the hand in the air.
void NaiveVisitor::idle(double t_s) {
  const double what = random_.uniform(0.0, 1.0);
  Arm& arm = arms_[0];
  if (what < 0.4 && arm.is_up()) {
    t_s = arm.lower(t_s);
    wakes_s_ = t_s + random_.uniform(0.5, 3.0);
  } else if (what < 0.6) {  // points at something and says so
    if (!arm.is_up()) t_s = arm.raise(t_s, spot());
    arm.point(t_s, random_.uniform(0.0, 1.0) < 0.8);
    arm.grip(t_s, random_.uniform(0.2, 0.6));
    for (int i = 0; i < 3; ++i)
      t_s = arm.move(t_s, spot() + glm::dvec3(random_.uniform(-0.1, 0.1), 0.0, -0.05), 0.06, 0.7);
    arm.point(t_s, false);
    wakes_s_ = arm.grip(t_s, 0.1);
  } else if (what < 0.75 && arm.is_up()) {  // to the chin and back
    arm.grip(t_s, random_.uniform(0.3, 0.8));
    t_s = arm.move(t_s, body_.eyes_m + glm::dvec3(0.02, -0.08, -0.08), 0.05, 0.8);
    t_s = arm.hold(t_s, random_.uniform(0.5, 2.0));
    wakes_s_ = arm.grip(arm.move(t_s, spot()), 0.0);
  } else {
    wakes_s_ = t_s + random_.uniform(0.5, 2.0);
  }
  wakes_s_ += body_.reaction_s;
}

void NaiveVisitor::attempt(Idea idea, double t_s) {
  trial_.idea = idea;
  switch (idea) {
    case kWave:
      return wave(t_s);
    case kSweep:
      return sweep(t_s, 1.7);
    case kPush:
      return sweep(t_s, 0.8);
    case kPoke:
      return poke(t_s);
    case kGrab:
    case kPinch:
      return carry(t_s, idea == kPinch);
    case kTwoHands:
      return two_hands(t_s);
    case kPull:
    case kTouch:  // goes on as long as he looks
    case kIdeas:
      return pull(t_s);
  }
}

NaiveVisitor::Idea NaiveVisitor::choose(const SeenScreen& seen) {
  const bool zooms = manner_.turned >= kEnough && manner_.zoomed < kEnough;
  std::array<double, kIdeas> weight = belief_;
  if (zooms) {
    for (const Idea idea : {kWave, kSweep, kPush, kPoke, kGrab, kPinch}) weight[idea] = 0.0;
    weight[kTwoHands] += 0.6;
    weight[kPull] += 0.6;
  }
  if (manner_.turned >= kEnough && manner_.zoomed >= kEnough && manner_.opened < kEnough)
    for (double& w : weight) w = std::min(w, kKnownByNow);  // what has worked often draws less than what is new
  if (!zooms) weight[kTouch] = belief_[kTouch];
  if (!seen.sign) weight[kTouch] = 0.0;
  if (manner_.opened >= kEnough) weight[kTouch] = std::min(weight[kTouch], 0.5);
  double total = 0.0;
  for (const double w : weight) total += w;
  double drawn = random_.uniform(0.0, total);
  for (int i = 0; i < kIdeas; ++i)
    if ((drawn -= weight[static_cast<std::size_t>(i)]) <= 0.0) return static_cast<Idea>(i);
  return kGrab;
}

void NaiveVisitor::judge(const SeenScreen& seen) {
  if (trial_.intention == Intention::kNone || trial_.idea == kIdeas) return;
  manner_.lost = !trial_.shown;
  if (trial_.arrow) follow_arrow();
  if (trial_.idea == kTouch) {
    const bool worked = seen.opened != trial_.opened;
    belief_[kTouch] = worked ? std::min(40.0, std::max(belief_[kTouch], 0.5) * kHelped) : belief_[kTouch] * kDidNothing;
    if (worked) ++manner_.opened;
    aim_.left = 0;
    trial_.idea = kIdeas;
    return;
  }
  const glm::dvec3 turn = vector_of(seen.view.rotation * glm::conjugate(trial_.before.rotation));
  const double zoom = std::log(seen.view.zoom / trial_.before.zoom);
  const bool zooms = trial_.intention == Intention::kZoom;
  const double along = zooms ? zoom * sense_.x : glm::dot(glm::dvec2(turn.y, -turn.x), sense_);
  const bool any = glm::length(turn) > kNoticed_rad || std::abs(zoom) > kNoticedZoom;
  double& belief = belief_[trial_.idea];
  if (trial_.intention == Intention::kProbe) {
    belief *= any ? kOddly : kDidNothing;
    if (!trial_.shown) manner_.stretch = std::min(0.85, manner_.stretch + 0.15);
    if (any && trial_.idea == kWave) belief_[kSweep] += kHelped;  // so it is the way of the hand
  } else if (along > (zooms ? kNoticedZoom : kNoticed_rad)) {
    belief = std::min(40.0, std::max(belief, 0.5) * kHelped);
    ++(zooms ? manner_.zoomed : manner_.turned);
  } else {
    belief *= any ? kOddly : kDidNothing;
    manner_.effort =
        std::min(1.15, manner_.effort + 0.08);  // what does not help is done again, harder, faster and nearer
    manner_.hurry = std::min(1.8, manner_.hurry * 1.12);
    const double nearer = trial_.shown ? 0.04 : 0.15;  // further to where something may see it
    manner_.stretch = std::min(0.85, manner_.stretch + nearer);
    manner_.wants = std::min(0.9, manner_.wants + nearer);
  }
  trial_.idea = kIdeas;
}

/// How often a picture is understood.
double NaiveVisitor::wit() const noexcept {
  return kind_ == NaiveKind::kImitates ? 0.85 : kind_ == NaiveKind::kWaves ? 0.5 : 0.4;
}

/// The next attempt is higher, by half a hand to a hand. Of those who pass by a display 56 % do what a picture shows
/// (Walter, Bailly, Mueller, CHI 2013); a shown place is found to 51 to 80 mm in 3.7 s (Freeman et al., CHI 2016).
void NaiveVisitor::follow_arrow() {
  if (random_.uniform(0.0, 1.0) > std::min(wit(), kFollowArrows)) return;
  manner_.higher_m = std::min(kHighest_m, manner_.higher_m + body_.size * random_.uniform(0.04, 0.12));
  manner_.lost = true;
}

void NaiveVisitor::study(SeenLesson lesson) {
  if (lesson == SeenLesson::kNone || random_.uniform(0.0, 1.0) > wit()) return;
  if (lesson == SeenLesson::kShowHand) {  // the picture's hand reaches out for the panel
    manner_.stretch = std::min(0.85, manner_.stretch + 0.15);
    manner_.wants = std::min(0.9, manner_.wants + 0.15);
  }
  if (lesson == SeenLesson::kGrabAndMove) belief_[kGrab] = std::max(belief_[kGrab], 0.5) + kUnderstood;
  if (lesson == SeenLesson::kSwipe) belief_[kSweep] = std::max(belief_[kSweep], 0.5) + kUnderstood;
  if (lesson == SeenLesson::kRestOnSign) belief_[kTouch] += kUnderstood;
  if (lesson == SeenLesson::kNearer) belief_[random_.uniform(0.0, 1.0) < 0.5 ? kTwoHands : kPull] += kUnderstood;
}

void NaiveVisitor::act(double t_s, const SeenScreen& seen) {
  if (manner_.turned + manner_.zoomed > 0 ? random_.uniform(0.0, 1.0) < 0.35 : random_.uniform(0.0, 1.0) < 0.12) {
    begin(Intention::kNone, t_s, seen);
    return idle(t_s);
  }
  const Idea idea = choose(seen);
  if (idea == kTouch) {
    begin(Intention::kOpen, t_s, seen);
    trial_.idea = kTouch;
    aim_ = {{}, glm::dvec3(0.0), random_.uniform(0.7, 2.5), 7};
    return touch(t_s, seen);
  }
  const bool zooms = idea == kTwoHands || idea == kPull, probes = idea == kWave || idea == kPoke;
  begin(probes ? Intention::kProbe : zooms ? Intention::kZoom : Intention::kTurn, t_s, seen);
  attempt(idea, t_s);
  wakes_s_ = trial_.end_s + kAfter_s + body_.reaction_s * random_.uniform(0.8, 2.0);
}

void NaiveVisitor::look(double t_s, const SeenScreen& seen) {
  if (left_) return;
  trial_.shown = trial_.shown || seen.my_mark.has_value();
  trial_.arrow = trial_.arrow || (seen.arrow_up && arms_[0].is_up() && trial_.intention != Intention::kNone);
  if (t_s >= studies_s_) {
    study(seen.lesson);
    studies_s_ = t_s + random_.uniform(1.5, 4.0);
  }
  const double busy = std::max(arms_[0].busy_until_s(), arms_[1].busy_until_s());
  if (t_s < busy) return;
  if (aim_.left > 0 && seen.opened == trial_.opened) return touch(t_s, seen);
  if (t_s < wakes_s_ || t_s < trial_.end_s + kAfter_s) return;
  judge(seen);
  if (t_s > leaves_s_) {
    left_ = true;
    for (Arm& arm : arms_)
      if (arm.is_up()) arm.lower(t_s);
    return begin(Intention::kNone, t_s, seen);
  }
  act(t_s, seen);
}

}  // namespace dubsar
