#include "tests/app/kiosk/gallery_visit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/app/kiosk/gallery_session.h"

namespace dubsar::app::test {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kTurn_rad = 8.0 * kRad, kZoom = 0.1;         // what counts as done
constexpr double kMoved_rad = 2.0 * kRad, kMovedZoom = 0.02;  // what is seen as a movement
constexpr double kInTime_s = 20.0, kFrame_s = 1.0 / 60.0;

glm::dvec3 turned_from(const ViewState& before, const ViewState& now) {
  return vector_of(now.rotation * glm::conjugate(before.rotation));
}

bool steers(const GestureRecognizer& hand) {
  return hand.grabbing() || hand.pinching() ||
         std::any_of(hand.events().begin(), hand.events().end(), [](const GestureEvent& event) {
           return event.kind != GestureKind::kDwell && event.phase != GesturePhase::kCancel;
         });
}

void note(GalleryAttempt& attempt, const SeenScreen& before, const GallerySession& session, const InputFrame& frame,
          const glm::dvec2& sense) {
  ++attempt.moments;
  const auto his = [](const HandFrame& hand) { return Gallery::is_the_visitors(hand.id); };
  attempt.seen += std::any_of(frame.hands.begin(), frame.hands.end(), his);
  for (const HandFrame& hand : frame.hands) {
    if (!his(hand)) continue;
    attempt.at_m = hand.palm.position_m;
    attempt.closed = std::max(attempt.closed, hand.grab_strength);
  }
  bool kept = false, held = false;
  for (std::size_t h = 0; h < 2; ++h) {
    const HandFrame* const hand = session.person().hands[h];
    const GestureRecognizer& gestures = session.navigator().hands()[h];
    if (hand == nullptr || !his(*hand)) continue;
    kept = true;
    held = held || gestures.grabbing() || gestures.pinching();
    for (const GestureEvent& event : gestures.events()) attempt.swipes += event.kind == GestureKind::kSwipe;
  }
  attempt.kept += kept;
  attempt.held += held;
  const glm::dvec3 turn = turned_from(before.view, session.screen().view);
  attempt.turned_deg = glm::length(turn) / kRad;
  attempt.along_deg = glm::dot(glm::dvec2(turn.y, -turn.x), sense) / kRad;
  attempt.zoomed = std::log(session.screen().view.zoom / before.view.zoom);
}

}  // namespace

GalleryVisit visit(const GalleryOptions& room) {
  GalleryVisit out;
  Gallery gallery(room);
  GallerySession session;
  InputFrame frame;
  SeenScreen at_trial = session.screen(), at_movement = at_trial;
  Intention before = Intention::kNone;
  std::uint64_t movement = 0;
  bool suspect = false;
  std::string steered_by;
  std::map<std::uint32_t, double> kept_since;
  std::int64_t chosen = 0;
  for (double t = 0.0; t < room.leaves_s + 4.0; t += kFrame_s) {
    const double here_s = t - room.arrives_s;
    static_cast<void>(gallery.step(t, session.screen(), frame));
    const SeenScreen was = session.screen();
    session.go_on(static_cast<TimestampNs>(1e9 * t), frame);
    for (const HandFrame* const hand : session.person().hands)
      if (hand != nullptr) kept_since.try_emplace(hand->id, t);
    const SeenScreen& now = session.screen();
    const NaiveVisitor& visitor = gallery.visitor();
    const bool here = gallery.visitor_is_here(t);
    const Intention wants = here ? visitor.intention(here_s) : Intention::kNone;
    if (wants != before) {
      at_trial = was;
      if (wants != Intention::kNone) out.attempts.push_back({here_s, wants, std::string(visitor.tries())});
    }
    before = wants;
    if (wants != Intention::kNone) note(out.attempts.back(), at_trial, session, frame, visitor.sense());
    if (wants == Intention::kTurn && !out.turned_s) {
      const glm::dvec3 turn = turned_from(at_trial.view, now.view);
      if (glm::dot(glm::dvec2(turn.y, -turn.x), visitor.sense()) > kTurn_rad) out.turned_s = here_s;
    }
    if (wants == Intention::kZoom && !out.zoomed_s &&
        std::log(now.view.zoom / at_trial.view.zoom) * visitor.sense().x > std::log1p(kZoom))
      out.zoomed_s = here_s;
    if (now.opened && here && !out.opened_s) out.opened_s = here_s;
    if (session.chosen() != chosen) {
      chosen = session.chosen();
      if (wants == Intention::kNone && here) {
        ++out.unwanted;
        out.causes += fmt::format("  {:.2f} s: opened or closed unasked\n", here_s);
      }
    }
    const Navigator& navigator = session.navigator();
    if (navigator.movement() != movement) {
      movement = navigator.movement();
      at_movement = was;
      suspect = wants == Intention::kNone && here;
      std::string who;
      for (std::size_t h = 0; h < 2; ++h) {
        const HandFrame* const hand = session.person().hands[h];
        if (!here || hand == nullptr || !steers(navigator.hands()[h])) continue;
        who += fmt::format(" {} {} for {:.1f} s ({:.2f} {:.2f} {:.2f}) grab {:.2f} v {:.2f} {}", hand->id,
                           hand->chirality == Chirality::kRight ? "right" : "left", t - kept_since[hand->id],
                           hand->palm.position_m.x, hand->palm.position_m.y, hand->palm.position_m.z,
                           hand->grab_strength, glm::length(navigator.hands()[h].velocity_mps()),
                           navigator.hands()[h].grabbing()   ? "grabs"
                           : navigator.hands()[h].pinching() ? "pinches"
                                                             : "swipes");
        if (Gallery::is_the_visitors(hand->id)) continue;
        ++out.takeovers;
        out.causes +=
            fmt::format("  {:.2f} s: somebody else's, kept is {}:{}\n", here_s,
                        session.person().head ? fmt::format("head {}", session.person().head->id) : "no head", who);
      }
      steered_by = who;
    }
    if (suspect && (glm::length(turned_from(at_movement.view, now.view)) > kMoved_rad ||
                    std::abs(std::log(now.view.zoom / at_movement.view.zoom)) > kMovedZoom)) {
      ++out.unwanted;
      out.causes += fmt::format("  {:.2f} s: unwanted:{}\n", here_s, steered_by);
      suspect = false;
    }
  }
  out.minutes = (room.leaves_s - room.arrives_s) / 60.0;
  return out;
}

void GalleryFigures::add(const GalleryVisit& visit) {
  ++visitors;
  turned += visit.turned_s && *visit.turned_s <= kInTime_s ? 1 : 0;
  zoomed += visit.zoomed_s ? 1 : 0;
  opened += visit.opened_s && *visit.opened_s <= 60.0 ? 1 : 0;
  unwanted += visit.unwanted;
  takeovers += visit.takeovers;
  minutes += visit.minutes;
}

}  // namespace dubsar::app::test
