#include "tests/app/kiosk/gallery_session.h"

#include <algorithm>

namespace dubsar::app::test {
namespace {

constexpr glm::dvec2 kWindowMm{600.0, 340.0};

SeenLesson as_seen(const std::optional<Tutorial>& tutorial) {
  if (!tutorial) return SeenLesson::kNone;
  switch (*tutorial) {
    case Tutorial::kShowHand:
      return SeenLesson::kShowHand;
    case Tutorial::kGrab:
    case Tutorial::kTurn:
      return SeenLesson::kGrabAndMove;
    case Tutorial::kRest:
      return SeenLesson::kRestOnSign;
    case Tutorial::kTwoHands:
      return SeenLesson::kNearer;
    case Tutorial::kSwipe:
      break;
  }
  return SeenLesson::kSwipe;
}

}  // namespace

Mapping GallerySession::mapping_ = gallery_mapping().value();

GallerySession::GallerySession(const std::string& notify_socket, std::int64_t watchdog_us)
    : navigator_(mapping_), people_(entry_zone()), guide_(parts(notify_socket, watchdog_us)) {
  guide_.presented(0);
  document_.parts = {{"tablet", 1}, {"envelope", 2}};
}

HandZone GallerySession::entry_zone() {
  return {1e-3 * mapping_.hands.enter_min_mm(), 1e-3 * mapping_.hands.enter_max_mm()};
}
HandZone GallerySession::zone() { return {1e-3 * mapping_.hands.zone_min_mm, 1e-3 * mapping_.hands.zone_max_mm}; }

KioskParts GallerySession::parts(const std::string& notify_socket, std::int64_t watchdog_us) {
  KioskParts out;
  out.notify_socket = notify_socket;
  out.watchdog_us = watchdog_us;
  out.profile.objects = {{.file = "a.exa"}};
  out.profile.pin = "8302";
  out.zone = zone();
  out.wall = [] { return WallTime{1'790'000'000, 720}; };
  return out;
}

void GallerySession::go_on(TimestampNs now, const InputFrame& frame) {
  person_ = people_.update(now, frame);
  navigator_.update(now, frame, person_.hands, person_.standing);
  Steered steered;
  steered.view = navigator_.view();
  steered.control = navigator_.control();
  steered.hands = hand_marks(frame, person_, navigator_.hands(), entry_zone());
  for (const GestureRecognizer& hand : navigator_.hands())
    for (const GestureEvent& event : hand.events())
      steered.swiped = steered.swiped || event.kind == GestureKind::kSwipe;
  if (person_.head) steered.eyes.presence = Presence::kTracked;
  guidance_ = guide_.lead({now, steered, document_, rows_, kWindowMm, {0, 0}, {}, {}, true, on_screen_});
  navigator_.set_scene(guidance_.gestures);
  for (const std::string& command : guidance_.commands) {
    if (command.rfind("unpack ", 0) == 0) document_.unpack = 0.01 * std::stod(command.substr(7));
    if (command == "reset") navigator_.go_to({}, now, true);
  }
  screen_ = {};
  screen_.view = navigator_.view();
  screen_.opened = document_.unpack > 0.05;  // it is seen to begin
  if (const auto& scene = guidance_.scene) {
    if (scene->keep) show_keyframe(document_, scene->frame);
    if (scene->keep && scene->camera) navigator_.go_to(view_of(document_), now, false);
    if (scene->camera) screen_.view.rotation = scene->frame.camera.rotation;
    screen_.opened = scene->frame.unpack > 0.05;
  }
  screen_.arrow_up = guide_.wants_higher();
  screen_.lesson = as_seen(guidance_.picture->tutorial);
  for (std::size_t h = 0; h < 2; ++h)
    if (person_.hands[h] != nullptr && Gallery::is_the_visitors(person_.hands[h]->id) && !screen_.my_mark)
      screen_.my_mark =
          glm::dvec2(cursor_place_mm({zone(), kWindowMm, {0, 0}}, navigator_.hands()[h].position_m())) / kWindowMm.y;
  for (const DwellButtonPicture& button : guidance_.picture->buttons)
    if (button.button == DwellButton::kOpen || button.button == DwellButton::kClose) {
      screen_.sign = button.at * glm::dvec2(kWindowMm.x / kWindowMm.y, 1.0);
      screen_.sign_radius = button.radius;
      screen_.sign_filled = button.filled;
    }
}

}  // namespace dubsar::app::test
