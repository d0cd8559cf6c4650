#include "app/kiosk/kiosk_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/document/document.h"
#include "app/stage/right_to_left.h"
#include "app/words/text.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

constexpr double kSwayDeg = 12.0, kSwayPeriodS = 22.0;  // at most 4 degrees a second
constexpr double kSwayRiseS = 4.0, kSwayFallS = 2.0, kUnpackS = 2.0, kDarkS = 3.0;
constexpr double kAsleepDark = 0.97, kBrightnessStep = 0.1;
constexpr double kHandTurnDeg = 0.05;  // less is noise

/// A step towards a goal at an even pace.
double towards(double from, double to, double step) { return std::clamp(to, from - step, from + step); }

bool is_touched(const SourceRow& row) { return row.health == SourceHealth::kPresent && is_touch_panel(row); }

bool sees_hands(const SourceRow& row) {
  return row.health == SourceHealth::kPresent && row.spec != "mouse" && row.spec != "keyboard" &&
         !is_touch_panel(row) && !row.spec.starts_with("head:");
}

}  // namespace

KioskController::KioskController(KioskParts parts)
    : parts_(std::move(parts)),
      visit_({parts_.profile.idle_reset_s, parts_.profile.attract_after_s}),
      menu_(parts_.profile.pin),
      diary_(parts_.profile.journal, parts_.wall),
      notify_(parts_.notify_socket, parts_.watchdog_us) {
  diary_.look_at_day(0);
  diary_.write("start", parts_.version.empty() ? std::string() : Journal::words("version", parts_.version));
  set_trouble(std::exchange(parts_.trouble, {}), parts_.flat);
}

void KioskController::set_trouble(std::string trouble, bool flat) {
  parts_.flat = flat;
  if (trouble == parts_.trouble) return;
  parts_.trouble = std::move(trouble);
  if (parts_.trouble.empty()) return;
  log_warning("{}", parts_.trouble);
  diary_.trouble(parts_.trouble);
}

KioskController::~KioskController() {
  diary_.write("end", fmt::format("\"visits\": {}, \"resets\": {}", visit_.counts().visits, visit_.counts().resets));
  notify_.stopping();
}

void KioskController::begin_object() {
  told_.ended = false;
  motion_ = {};
  tour_.begin({}, {});
  view_.reset();
}

void KioskController::leave_out(std::size_t object, std::string_view why) {
  diary_.trouble(why);
  std::vector<KioskObject>& objects = parts_.profile.objects;
  objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(object));
  if (object < parts_.tours.size()) parts_.tours.erase(parts_.tours.begin() + static_cast<std::ptrdiff_t>(object));
  object_ = objects.empty() ? 0 : object_ % objects.size();
}

bool KioskController::takes(const InputEvent& event, TimestampNs now) {
  if (event.kind == EventKind::kButton && event.down && event.at) {
    const glm::dvec2 at = *event.at * glm::dvec2(1.0 / asked_.aspect, 1.0);
    asked_.press = at;
    if (button_at(at, buttons_, asked_.aspect)) return true;  // two taps on a button are none on the object
  }
  if (event.kind != EventKind::kKey) return false;  // a finger or a mouse may turn the object as a hand does
  const bool plain = (event.modifiers & (kControl | kAlt)) == 0;
  if (event.down && !event.repeat && plain)
    if (const auto wish = menu_.key(event.key, now)) asked_.wishes.push_back(*wish);
  return true;
}

VisitMoment KioskController::notice(const SessionMoment& moment) {
  const Steered& steered = moment.steered;
  VisitMoment out;
  out.tracker = std::any_of(moment.sources.begin(), moment.sources.end(), sees_hands);
  out.touch = std::any_of(moment.sources.begin(), moment.sources.end(), is_touched);
  out.asleep = is_quiet(parts_.profile.quiet, diary_.wall().minute_of_day);
  out.head = steered.eyes.presence == Presence::kTracked;
  out.hands = static_cast<int>(steered.hands.size());
  if (!steered.hands.empty()) {
    out.hand = steered.hands.front().state;
    out.hand_y_m = steered.hands.front().place_m.y;
  }
  out.two_hold = steered.hands.size() > 1 && steered.hands[0].state == HandState::kHolding &&
                 steered.hands[1].state == HandState::kHolding;
  if (view_ && steered.control == Control::kHands) {
    const double turned = turn_between_deg(view_->rotation, steered.view.rotation);
    const bool held = !steered.hands.empty() && steered.hands.front().state == HandState::kHolding;
    if (held && turned > kHandTurnDeg) out.turned_deg = turned;  // who only wipes has not learnt to take hold
    if (!held)
      motion_.held_from.reset();
    else if (motion_.held_from)
      out.held_deg = turn_between_deg(*motion_.held_from, steered.view.rotation);
    else
      motion_.held_from = steered.view.rotation;
    if (out.two_hold) out.zoomed = std::abs(std::log(steered.view.zoom / view_->zoom));
  }
  // A mouse or a finger on the glass is a visitor's hand as well.
  if (steered.control == Control::kMouse) {
    out.hands = std::max(out.hands, 1);
    out.hand = HandState::kHolding;
    if (view_) out.turned_deg = turn_between_deg(view_->rotation, steered.view.rotation);
    if (view_) out.zoomed = std::abs(std::log(steered.view.zoom / view_->zoom));
  }
  if (asked_.press) out.hands = std::max(out.hands, 1);  // on a button
  out.swiped = steered.swiped;
  out.can_open = can_unpack(moment.document);
  out.toured = tour_.walks();
  out.can_tour = tour_.any() && !tour_.settling();
  view_ = steered.view;
  return out;
}

void KioskController::obey(OperatorWish wish, Guidance& out) {
  switch (wish) {
    case OperatorWish::kClose:
      break;
    case OperatorWish::kNextObject:
      object_ = (object_ + 1) % parts_.profile.objects.size();
      out.end = true;
      break;
    case OperatorWish::kNextLanguage:
      language_ = (language_ + 1) % parts_.profile.languages.size();
      break;
    case OperatorWish::kReset:
      motion_.unpack_goal = 0.0;
      tour_.leave();
      tour_.forget();
      out.commands.emplace_back("reset");
      break;
    case OperatorWish::kRetryDevices:
      out.commands.emplace_back("retry_sources");
      break;
    case OperatorWish::kNextDisplay:
      out.commands.emplace_back("next_display");
      break;
    case OperatorWish::kBrighter:
    case OperatorWish::kDarker:
      parts_.profile.brightness = std::clamp(
          parts_.profile.brightness + (wish == OperatorWish::kBrighter ? kBrightnessStep : -kBrightnessStep), 0.1, 1.0);
      break;
    case OperatorWish::kEnd:
      object_ = parts_.profile.objects.size();
      out.end = true;
      break;
  }
  for (const OperatorRow& row : OperatorMenu::rows())
    if (row.wish == wish)
      diary_.write("operator",
                   Journal::words("key", std::string_view(&row.key, 1)) + ", " + Journal::words("does", row.words));
}

/// Buttons that hands may rest on, and what they chose.
std::optional<DwellButton> KioskController::choose(const SessionMoment& moment) {
  std::vector<DwellButton> shown;
  const bool there = phase_ == VisitPhase::kFree || phase_ == VisitPhase::kArrived;
  if (tour_.walks()) {
    shown = {DwellButton::kNext, DwellButton::kLeave};
  } else if (tour_.settling()) {  // not while things move
  } else if (phase_ == VisitPhase::kFree || (phase_ == VisitPhase::kArrived && motion_.unpack_goal > 0.5)) {
    if (can_unpack(moment.document) && motion_.unpack == motion_.unpack_goal)  // not while it moves
      shown.push_back(motion_.unpack_goal > 0.5 ? DwellButton::kClose : DwellButton::kOpen);
  }
  if (there && tour_.any() && !tour_.walks() && !tour_.settling() && motion_.unpack == motion_.unpack_goal)
    shown.push_back(DwellButton::kTour);
  const double aspect = asked_.aspect = moment.window_mm.x / moment.window_mm.y;
  buttons_ = place_buttons(shown, aspect);
  std::vector<DwellHand> hands;
  const CursorScene stage{parts_.zone, moment.window_mm, moment.middle_mm};
  for (const HandMark& hand : moment.steered.hands)
    if (hand.state <= HandState::kFist)
      hands.push_back({(glm::dvec2(cursor_place_mm(stage, hand.place_m)) - moment.middle_mm) / moment.window_mm,
                       hand.state == HandState::kReady});
  auto chosen = rest_.update(moment.now, hands, buttons_, aspect);
  for (DwellButtonPicture& button : buttons_) button.filled = rest_.filled(button.button);
  if (const auto press = std::exchange(asked_.press, {}); press && !chosen)
    chosen = button_at(*press, buttons_, aspect);
  if (chosen) take_button(*chosen, moment);
  return chosen;
}

void KioskController::take_button(DwellButton button, const SessionMoment& moment) {
  switch (button) {
    case DwellButton::kOpen:
    case DwellButton::kClose:
      motion_.unpack_goal = button == DwellButton::kOpen ? 1.0 : 0.0;
      break;
    case DwellButton::kTour: {
      Keyframe now = keyframe_of(moment.document, 0.0);
      now.camera = {moment.steered.view.rotation, moment.steered.view.zoom, moment.steered.view.pan};
      now.light = {moment.steered.view.light_azimuth_deg, moment.steered.view.light_elevation_deg};
      tour_.go(now);
      ++told_.tours;
      diary_.write("tour", fmt::format("\"step\": {}", tour_.at() + 1));
      break;
    }
    case DwellButton::kNext:
      tour_.next();
      break;
    case DwellButton::kLeave:
      tour_.leave();
      break;
  }
}

/// What a tour shows now. A hand that takes hold leaves it where it is.
void KioskController::walk(const SessionMoment& moment, Guidance& out) {
  const std::vector<HandMark>& hands = moment.steered.hands;
  const bool held =
      moment.steered.control == Control::kMouse ||
      std::any_of(hands.begin(), hands.end(), [](const HandMark& hand) { return hand.state == HandState::kHolding; });
  if (held) tour_.leave();
  if (moment.steered.swiped) tour_.next();
  const auto now = tour_.update(moment.now);
  if (!now) return;
  GuidedScene scene{now->frame, now->camera, now->settles};
  if (const TourStep* const step = tour_.step())
    for (const TourLabel& label : step->labels)
      scene.notes.push_back({label.part,
                             {},
                             as_seen(text_in(label.text, language()), Words::right_to_left(language())),
                             label.at_mm,
                             label.normal,
                             {},
                             {}});
  out.scene = std::move(scene);
  if (!now->settles) return;
  view_.reset();  // what the tour turned no hand has turned
  motion_.unpack = motion_.unpack_goal = now->frame.unpack > 0.5 ? 1.0 : 0.0;
}

/// The tour of the object that is shown from now on.
void KioskController::begin_tour(const SessionMoment& moment) {
  const Document& document = moment.document;
  Keyframe home = keyframe_of(document, 0.0);
  home.camera = document.home;
  home.light = document.home_light;
  motion_.begun = true;
  if (object_ < parts_.profile.objects.size() && !parts_.profile.objects[object_].toured) return tour_.begin({}, home);
  const bool own = object_ < parts_.tours.size() && !parts_.tours[object_].steps.empty();
  tour_.begin(own ? parts_.tours[object_] : default_tour(document, parts_.words), home);
}

/// What goes on by itself: the sway of an object that nobody holds, the envelope, the light of the room.
void KioskController::move_on(const SessionMoment& moment, const VisitPicture& visit, Guidance& out) {
  const double dt =
      motion_.last < 0 ? 0.0 : std::clamp(1e-9 * static_cast<double>(moment.now - motion_.last), 0.0, 0.2);
  const bool takes = visit.phase != VisitPhase::kAsleep;
  out.glow = motion_.glow.update(
      takes ? object_glow({parts_.zone, moment.window_mm, moment.middle_mm}, moment.steered.hands, moment.objects)
            : Glow(),
      dt);
  motion_.last = moment.now;
  const bool sways = visit.phase == VisitPhase::kAttract && moment.surface;  // who reads wants the processor
  if (sways && motion_.sway == 0.0) motion_.sway_since = moment.now;
  motion_.sway = towards(motion_.sway, sways ? 1.0 : 0.0, dt / (sways ? kSwayRiseS : kSwayFallS));
  const double eased = motion_.sway * motion_.sway * (3.0 - 2.0 * motion_.sway);
  const double phase = 2e-9 * std::numbers::pi * static_cast<double>(moment.now - motion_.sway_since) / kSwayPeriodS;
  const double angle = eased * kSwayDeg * std::numbers::pi / 180.0 * std::sin(phase);
  if (angle != 0.0) out.turn = turn_of({0.0, angle, 0.0});

  if (visit.reset) {
    motion_.unpack_goal = 0.0;
    tour_.forget();
    out.commands.emplace_back("reset");
    if (parts_.profile.objects.size() > 1) {  // the next visitor has the next object
      object_ = (object_ + 1) % parts_.profile.objects.size();
      out.end = true;
    }
  }
  const bool toured = tour_.walks() || tour_.settling();  // the envelope is the tour's
  const double unpack = toured ? motion_.unpack : towards(motion_.unpack, motion_.unpack_goal, dt / kUnpackS);
  if (unpack != motion_.unpack && can_unpack(moment.document)) {
    const double smooth = unpack * unpack * (3.0 - 2.0 * unpack);
    out.commands.push_back(fmt::format("unpack {:.3f}", 100.0 * smooth));
  }
  motion_.unpack = unpack;
  const double dark = visit.phase == VisitPhase::kAsleep ? kAsleepDark : 1.0 - parts_.profile.brightness;
  motion_.dark = motion_.shown ? towards(motion_.dark, dark, dt / kDarkS) : dark;
  motion_.shown = true;
}

GalleryPicture KioskController::picture(const VisitPicture& visit) const {
  GalleryPicture out;
  const std::string& spoken = language();
  if (visit.line) out.line = parts_.words.say(*visit.line, spoken);
  if (visit.phase == VisitPhase::kAttract && (parts_.flat || !told_.panel.empty()))
    out.line = parts_.words.say(Line::kNoPanel, spoken);
  out.right_to_left = Words::right_to_left(spoken);
  out.tutorial = visit.tutorial;
  out.tutorial_s = visit.tutorial_s;
  if (const TourStep* const step = tour_.step()) {
    out.title = text_in(step->title, spoken);
    out.line = tour_.in_step_s() >= step->says_s ? text_in(step->text, spoken) : std::string();
    out.tutorial.reset();
    out.step = tour_.at() + 1;
    out.steps = tour_.steps();
  }
  if (visit.phase == VisitPhase::kAttract && object_ < parts_.profile.objects.size())
    out.title = text_in(parts_.profile.objects[object_].title, spoken);
  out.letter_mm = letter_height_mm(parts_.profile.eyes.reading_distance_m);
  out.dark = motion_.dark;
  out.buttons = buttons_;
  if (menu_.open()) out.menu = operators_page();
  return out;
}

/// What can be chosen, and how things stand.
std::vector<std::string> KioskController::operators_page() const {
  std::vector<std::string> out;
  for (const OperatorRow& row : OperatorMenu::rows())
    out.push_back(fmt::format("{}  {}", row.key, tr_name("operator", row.words)));
  const KioskProfile& profile = parts_.profile;
  std::string hours;
  for (const QuietHours& quiet : profile.quiet)
    hours += fmt::format("{}{:02}:{:02}-{:02}:{:02}", hours.empty() ? "" : ", ", quiet.from_min / 60,
                         quiet.from_min % 60, quiet.to_min / 60, quiet.to_min % 60);
  out.push_back(tr("operator.object_at", object_ + 1, profile.objects.size(), language(),
                   fmt::format("{:.0f}", 100.0 * profile.brightness)));
  out.push_back(
      tr("operator.visits", diary_.visits_today(visit_.counts().visits), hours.empty() ? tr("operator.never") : hours));
  for (std::string& row : diary_.state()) out.push_back(std::move(row));
  if (!parts_.version.empty()) out.push_back("dubsar " + parts_.version);
  return out;
}

Guidance KioskController::lead(const SessionMoment& moment) {
  Guidance out;
  if (told_.ready && moment.on_screen) notify_.alive(moment.now);  // dark or at rest it draws nothing, and lives
  menu_.tick(moment.now);
  const WallTime wall = diary_.wall();
  if (!parts_.profile.key_file.empty() && wall.unix_s != told_.looked) {  // once a second
    std::error_code error;
    menu_.file_present(std::filesystem::exists(parts_.profile.key_file, error), moment.now);
  }
  told_.looked = wall.unix_s;
  diary_.look_at_day(visit_.counts().visits);
  diary_.look_at_devices(moment.sources);
  for (const OperatorWish wish : std::exchange(asked_.wishes, {})) obey(wish, out);
  if (!motion_.begun && moment.surface) begin_tour(moment);
  VisitMoment noticed = notice(moment);
  const auto chosen = choose(moment);
  noticed.chose_open = chosen == DwellButton::kOpen || chosen == DwellButton::kClose;
  const VisitPicture visit = visit_.update(moment.now, noticed);
  phase_ = visit.phase;
  if (visit.arrived) diary_.write("visit");
  if (visit.reset) diary_.write("reset");
  if (moment.trouble != told_.panel) {
    told_.panel = moment.trouble;
    if (!told_.panel.empty()) diary_.trouble(told_.panel);
  }
  if (const std::int64_t hour = wall.unix_s / 3600; hour != told_.hour) {
    if (told_.hour >= 0) {
      const Visit::Counts& counts = visit_.counts();
      diary_.write(
          "hour",
          fmt::format("\"visits\": {}, \"resets\": {}, \"turned\": {}, \"zoomed\": {}, \"opened\": {}, \"tours\": {}",
                      counts.visits, counts.resets, counts.done[static_cast<std::size_t>(Tutorial::kTurn)],
                      counts.done[static_cast<std::size_t>(Tutorial::kTwoHands)],
                      counts.done[static_cast<std::size_t>(Tutorial::kRest)], told_.tours));
      notify_.status(fmt::format("{} visits", counts.visits));
    }
    told_.hour = hour;
  }
  walk(moment, out);
  move_on(moment, visit, out);
  told_.ended = out.end;
  const CursorScene stage{parts_.zone, moment.window_mm, moment.middle_mm};
  const std::vector<HandMark>& hands = moment.steered.hands;
  if (visit.phase != VisitPhase::kAsleep) out.lines = hand_cursors(stage, hands);
  if (!hands.empty() && hands.front().state <= HandState::kFist) motion_.hand_m = hands.front().place_m;
  motion_.wants_higher = visit.higher_s.has_value();
  if (visit.higher_s)
    for (LinesItem& item : higher_arrow(stage, motion_.hand_m, *visit.higher_s)) out.lines.push_back(std::move(item));
  out.gestures.signs_above =
      std::any_of(buttons_.begin(), buttons_.end(), [](const DwellButtonPicture& button) { return button.at.y > 0.0; });
  out.gestures.beginner = visit.phase == VisitPhase::kArrived;
  out.picture = picture(visit);
  return out;
}

void KioskController::presented(TimestampNs) {
  if (!told_.ready) notify_.ready();
  told_.ready = true;
}

}  // namespace dubsar::app
