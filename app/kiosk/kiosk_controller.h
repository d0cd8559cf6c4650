#pragma once
// Leads the session of a kiosk: visitors are invited, seen, taught and left alone; what they moved goes back when they
// are gone; an operator has the only keys.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "app/kiosk/dwell_buttons.h"
#include "app/kiosk/hand_cursors.h"
#include "app/kiosk/kiosk_diary.h"
#include "app/kiosk/kiosk_profile.h"
#include "app/kiosk/operator_menu.h"
#include "app/kiosk/service_notify.h"
#include "app/kiosk/tour_walk.h"
#include "app/kiosk/visit.h"
#include "app/tools/session_controller.h"

namespace dubsar::app {

struct KioskParts {
  KioskProfile profile{};
  Words words{};
  std::vector<Tour> tours{};  ///< of the profile's objects, in their order; missing or empty: what any tablet has
  HandZone zone{};
  std::string version{};             ///< of the program, for the operator and the journal
  std::string trouble{};             ///< said at the beginning, as set_trouble()
  bool flat = false;                 ///< what is shown is flat in place of the profile's display
  std::function<WallTime()> wall{};  ///< none: that of this machine
  std::string notify_socket{};       ///< of a service manager
  std::int64_t watchdog_us = 0;
};

class KioskController final : public SessionController {
 public:
  explicit KioskController(KioskParts parts);
  ~KioskController() override;

  bool takes(const InputEvent& event, TimestampNs now) override;
  Guidance lead(const SessionMoment& moment) override;
  void presented(TimestampNs now) override;

  /// Another object, or the same again, is shown from now on.
  void begin_object();
  /// Whether an operator ended the session, or the next object's turn has come: several change at each reset.
  bool ended() const noexcept { return told_.ended; }
  /// Which object the operator wants next, from 0 on; as many as there are: none, the kiosk is over.
  std::size_t object() const noexcept { return object_; }
  const std::vector<KioskObject>& objects() const noexcept { return parts_.profile.objects; }
  /// This object cannot be shown, as `why` says; the next takes its place.
  void leave_out(std::size_t object, std::string_view why);
  /// What of the profile cannot be had now, such as its monitor; empty: all can. What is new is logged and written
  /// down.
  /// `flat`: the display is another one than the profile's, which visitors are told.
  void set_trouble(std::string trouble, bool flat);
  /// Whether an arrow shows that a hand which sank out of sight is wanted higher up.
  bool wants_higher() const noexcept { return motion_.wants_higher; }
  const Visit& visit() const noexcept { return visit_; }
  const std::string& language() const { return parts_.profile.languages[language_]; }

 private:
  struct Motion {  ///< what goes on by itself
    double unpack = 0.0, unpack_goal = 0.0, sway = 0.0, dark = 0.0;
    TimestampNs last = -1, sway_since = 0;
    EasedGlow glow{};
    bool shown = false;
    bool begun = false;      ///< the object's tour is known
    glm::dvec3 hand_m{0.0};  ///< of the visitor, where it was seen last
    bool wants_higher = false;
    std::optional<glm::dquat> held_from{};  ///< where this hold began
  };
  /// What operators and fingers asked for since the last moment.
  struct Asked {
    std::vector<OperatorWish> wishes;
    std::optional<glm::dvec2> press;  ///< shares of the panel, as buttons
    double aspect = 1.0;              ///< of the panel
  };
  /// What was told to others, and when.
  struct Told {
    std::string panel;  ///< that cannot be shown
    std::int64_t hour = -1, looked = -1, tours = 0;
    bool ended = false, ready = false;  ///< ready: to the service manager
  };
  VisitMoment notice(const SessionMoment& moment);
  std::optional<DwellButton> choose(const SessionMoment& moment);
  void obey(OperatorWish wish, Guidance& out);
  void begin_tour(const SessionMoment& moment);
  void take_button(DwellButton button, const SessionMoment& moment);
  void walk(const SessionMoment& moment, Guidance& out);
  void move_on(const SessionMoment& moment, const VisitPicture& visit, Guidance& out);
  GalleryPicture picture(const VisitPicture& visit) const;
  std::vector<std::string> operators_page() const;

  KioskParts parts_;
  Visit visit_;
  OperatorMenu menu_;
  KioskDiary diary_;
  ServiceNotify notify_;
  Asked asked_;
  TourWalk tour_;
  Motion motion_;
  DwellTimer rest_;
  std::vector<DwellButtonPicture> buttons_;
  VisitPhase phase_ = VisitPhase::kAttract;
  std::optional<ViewState> view_;  // of the last moment
  std::size_t object_ = 0, language_ = 0;
  Told told_;
};

}  // namespace dubsar::app
