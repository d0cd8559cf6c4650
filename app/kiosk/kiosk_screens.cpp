#include "app/kiosk/kiosk_screens.h"

#include <utility>

#include "app/viewer/run_view.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr double kStepsASecond = 5.0, kLongestScreensS = 60.0;
constexpr TimestampNs kSettles = 3 * kSecondNs;  // longer than light, glow and tutorials take to come
constexpr const char* kScreensPin = "90210735";  // of a profile that has none

/// Says nothing, and counts as a sensor of hands.
class QuietSensor final : public InputSource {
 public:
  std::string_view name() const noexcept override { return "hands"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs, InputFrame&) noexcept override { return Freshness::kUnchanged; }
};

/// Goes from screen to screen; wants() is the one that the picture of the last moment shows.
class ScreenDirector final : public SessionController {
 public:
  ScreenDirector(KioskController& kiosk, std::string pin, bool words)
      : kiosk_(kiosk), pin_(std::move(pin)), words_(words) {}
  bool takes(const InputEvent& event, TimestampNs now) override { return kiosk_.takes(event, now); }
  void presented(TimestampNs now) override { kiosk_.presented(now); }
  const char* wants() const noexcept { return wants_; }

  Guidance lead(const SessionMoment& moment) override {
    now_ = moment.now;
    aspect_ = moment.window_mm.x / moment.window_mm.y;
    if (since_ < 0) since_ = now_;
    Steered steered = moment.steered;
    show_hand(steered);
    const SessionMoment seen{now_,
                             steered,
                             moment.document,
                             moment.sources,
                             moment.window_mm,
                             moment.middle_mm,
                             moment.objects,
                             moment.trouble,
                             moment.surface,
                             true};
    Guidance out = kiosk_.lead(seen);
    wants_ = nullptr;
    if (out.picture) look_at(*out.picture, out);
    if (out.picture && !words_) {
      out.picture->blank = true;
      if (!out.picture->menu.empty()) out.picture->menu = {" "};
    }
    return out;
  }

 private:
  enum class At { kAttract, kTeaching, kTurns, kObject, kText, kPeel, kOperator, kOver };

  bool settled() const { return now_ - since_ >= kSettles; }
  void next(At at) {
    at_ = at;
    since_ = now_;
  }
  void took(const char* name, At after) {
    wants_ = name;
    next(after);
  }

  /// Before the middle, a little to the right; it turns the object by a third once it has learnt how.
  void show_hand(Steered& steered) {
    if (at_ != At::kTeaching && at_ != At::kTurns) return;
    HandMark hand;
    hand.place_m = {0.06, 0.02, 0.25};
    if (at_ == At::kTurns) {
      hand.state = HandState::kHolding;
      hand.closing = 1.0;
      steered.control = Control::kHands;
      steered.view.rotation = turn_of({0.0, turned_ += 0.2, 0.0}) * steered.view.rotation;
    }
    steered.hands = {hand};
  }

  void press(const GalleryPicture& picture, DwellButton wanted, double aspect) {
    for (const DwellButtonPicture& button : picture.buttons) {
      if (button.button != wanted) continue;
      InputEvent event;
      event.kind = EventKind::kButton;
      event.down = true;
      event.at = button.at * glm::dvec2(aspect, 1.0);
      kiosk_.takes(event, now_);
    }
  }

  void type(std::string_view key) {
    InputEvent event;
    event.kind = EventKind::kKey;
    event.down = true;
    event.key = key;
    kiosk_.takes(event, now_);
  }

  void look_at(const GalleryPicture& picture, Guidance& out) {
    switch (at_) {
      case At::kAttract:
        if (settled()) took("attract", At::kTeaching);
        break;
      case At::kTeaching:
        if (settled() && picture.tutorial) took("teaching", At::kTurns);
        break;
      case At::kTurns:
        if (settled()) next(At::kObject);
        break;
      case At::kObject:
        if (!picture.line.empty() || picture.tutorial) break;
        took("object", At::kText);
        break;
      case At::kText:
        if (picture.steps == 0) press(picture, DwellButton::kTour, aspect_);
        if (picture.steps > 0 && settled()) took("text", At::kPeel);
        if (picture.steps == 0 && now_ - since_ > 2 * kSettles) next(At::kPeel);
        break;
      case At::kPeel:
        look_at_peel(picture, out);
        break;
      case At::kOperator:
        if (picture.menu.empty()) {
          for (const char digit : pin_) type(std::string_view(&digit, 1));
          type("enter");
        } else {
          took("operator", At::kOver);
        }
        break;
      case At::kOver:
        out.end = true;
        break;
    }
  }

  /// Of the tour, else of the button; when the envelope has gone for the most part.
  void look_at_peel(const GalleryPicture& picture, const Guidance& out) {
    const double open = out.scene ? out.scene->frame.unpack : 0.0;
    if (open >= 0.7) return took("peel", At::kOperator);
    if (picture.steps > 0 && picture.step == picture.steps && now_ - since_ > kSettles) return next(At::kOperator);
    if (picture.steps == 0) return next(At::kOperator);
    if (open == 0.0 && now_ - since_ > kSecondNs) {
      press(picture, DwellButton::kNext, aspect_);
      since_ = now_;
    }
  }

  KioskController& kiosk_;
  std::string pin_;
  bool words_;
  At at_ = At::kAttract;
  TimestampNs now_ = 0, since_ = -1;
  double turned_ = 0.0;
  const char* wants_ = nullptr;
  double aspect_ = 1.0;  // of the panel
};

}  // namespace

Result<std::vector<KioskScreen>> kiosk_screens(const TriMesh& mesh, ViewOptions view, KioskParts parts,
                                               Progress& progress, bool words) {
  KioskProfile& profile = parts.profile;
  profile.journal.clear();
  profile.key_file.clear();
  profile.quiet.clear();
  profile.attract_after_s = 1.0;
  if (profile.pin.empty()) profile.pin = kScreensPin;
  const std::string pin = profile.pin;
  KioskController kiosk(std::move(parts));
  ScreenDirector director(kiosk, pin, words);
  view.guide = &director;
  view.stage.room.gallery = true;
  view.window.reset();
  view.inputs = {"hands"};
  view.sources.make = [](std::string_view, const InputConfig&) -> Result<std::unique_ptr<InputSource>> {
    return std::make_unique<QuietSensor>();
  };
  view.around.notices = view.around.panels = false;
  view.time = {};
  view.time.fps = kStepsASecond;
  view.time.longest_s = kLongestScreensS;
  std::vector<KioskScreen> out;
  Result<void> read;
  DUBSAR_TRY(run_view(mesh, view, progress, [&](const ViewMoment& moment) {
    if (!moment.drawn || director.wants() == nullptr) return;
    auto picture = moment.presenter.picture();
    if (picture)
      out.push_back({director.wants(), *std::move(picture)});
    else
      read = tl::unexpected<Error>(picture.error());
  }));
  DUBSAR_TRY(read);
  return out;
}

}  // namespace dubsar::app
