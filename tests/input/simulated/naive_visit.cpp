#include "tests/input/simulated/naive_visit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "input/navigation/navigation.h"
#include "input/people/person_keeper.h"

namespace dubsar::test {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kTurn_rad = 8.0 * kRad, kZoom = 0.1;         // what counts as done
constexpr double kMoved_rad = 2.0 * kRad, kMovedZoom = 0.02;  // what is seen as a movement
constexpr double kInTime_s = 20.0, kFrame_s = 1.0 / 60.0;

/// The pictures beside the object: how to turn it until somebody can, then how to bring it nearer.
Lesson lesson_for(const NaiveVisit& so_far, double here_s) {
  if (here_s < 0.5) return Lesson::kNone;
  if (!so_far.turned_s) return std::fmod(here_s, 8.0) < 5.5 ? Lesson::kGrabAndMove : Lesson::kSwipe;
  return so_far.zoomed_s ? Lesson::kNone : Lesson::kNearer;
}

glm::dvec3 turned_from(const ViewState& before, const ViewState& now) {
  return vector_of(now.rotation * glm::conjugate(before.rotation));
}

bool steers(const GestureRecognizer& hand) {
  return hand.grabbing() || hand.pinching() ||
         std::any_of(hand.events().begin(), hand.events().end(), [](const GestureEvent& event) {
           return event.kind != GestureKind::kDwell && event.phase != GesturePhase::kCancel;
         });
}

}  // namespace

NaiveVisit visit(const GalleryOptions& room) {
  static const Mapping kMapping = default_mapping().value();
  NaiveVisit out;
  Gallery gallery(room);
  Navigator navigator(kMapping);
  PersonKeeper people({1e-3 * kMapping.hands.zone_min_mm, 1e-3 * kMapping.hands.zone_max_mm});
  InputFrame frame;
  ViewState at_trial, at_movement;
  Intention before = Intention::kNone;
  std::uint64_t movement = 0;
  bool suspect = false, hand_shown = false;
  for (double t = 0.0; t < room.leaves_s + 4.0; t += kFrame_s) {
    const double here_s = t - room.arrives_s;
    static_cast<void>(gallery.step(t, navigator.view(), lesson_for(out, here_s), hand_shown, frame));
    const auto now = static_cast<TimestampNs>(1e9 * t);
    const KeptPerson person = people.update(now, frame);
    hand_shown = std::any_of(person.hands.begin(), person.hands.end(), [](const HandFrame* hand) {
      return hand != nullptr && Gallery::is_the_visitors(hand->id);
    });
    const ViewState was = navigator.view();
    navigator.update(now, frame, person.hands);
    const ViewState& view = navigator.view();
    const NaiveVisitor& visitor = gallery.visitor();
    const Intention wants = gallery.visitor_is_here(t) ? visitor.intention(here_s) : Intention::kNone;
    if (wants != before) at_trial = was;
    before = wants;
    if (wants == Intention::kTurn && !out.turned_s) {
      const glm::dvec3 turn = turned_from(at_trial, view);
      if (glm::dot(glm::dvec2(turn.y, -turn.x), visitor.sense()) > kTurn_rad) out.turned_s = here_s;
    }
    if (wants == Intention::kZoom && !out.zoomed_s &&
        std::log(view.zoom / at_trial.zoom) * visitor.sense().x > std::log1p(kZoom))
      out.zoomed_s = here_s;
    if (navigator.movement() != movement) {
      movement = navigator.movement();
      at_movement = was;
      suspect = wants == Intention::kNone && gallery.visitor_is_here(t);
      for (std::size_t h = 0; h < 2; ++h)
        if (gallery.visitor_is_here(t) && person.hands[h] != nullptr && steers(navigator.hands()[h]) &&
            !Gallery::is_the_visitors(person.hands[h]->id))
          ++out.takeovers;
    }
    if (suspect && (glm::length(turned_from(at_movement, view)) > kMoved_rad ||
                    std::abs(std::log(view.zoom / at_movement.zoom)) > kMovedZoom)) {
      ++out.unwanted;
      suspect = false;
    }
  }
  out.minutes = (room.leaves_s - room.arrives_s) / 60.0;
  return out;
}

void NaiveFigures::add(const NaiveVisit& visit) {
  ++visitors;
  turned += visit.turned_s && *visit.turned_s <= kInTime_s ? 1 : 0;
  zoomed += visit.zoomed_s ? 1 : 0;
  unwanted += visit.unwanted;
  takeovers += visit.takeovers;
  minutes += visit.minutes;
}

}  // namespace dubsar::test
