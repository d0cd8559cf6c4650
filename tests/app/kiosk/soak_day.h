#pragma once
// Simulated hours of a kiosk without drawing: visitors come, a service manager listens, and every minute something
// breaks.

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "tests/app/kiosk/gallery_session.h"
#include "tests/app/kiosk/gallery_visit.h"
#include "tests/app/kiosk/soak_figures.h"

namespace dubsar::app::test {

inline constexpr double kFaultEveryS = 60.0, kFaultAtS = 20.0, kFaultS = 5.0;
inline constexpr double kWatchdogS = 20.0;  // of the unit
inline constexpr auto kWatchdogUs = static_cast<std::int64_t>(1e6 * kWatchdogS);

/// The first five can be drawn too.
enum class Fault {
  kUnplugged,
  kServiceDies,
  kMonitorLost,
  kClockJumps,
  kSuspended,
  kPanelAway,   ///< its monitor is switched off, and on again
  kHidden,      ///< a window manager's keys show the desktop
  kNoPictures,  ///< the graphics card is reset: nothing is drawn
  kTerminated,  ///< somebody stops and starts the service
};
inline constexpr std::array<std::string_view, 9> kFaultNames{
    "tracker unplugged", "service dies", "monitor lost", "clock jumps", "suspended",
    "panel away",        "hidden",       "no pictures",  "terminated"};
inline constexpr std::size_t kDrawnFaults = 5;

/// One visitor after another, whoever they are, with crowds, sun and reflections; endless.
class People {
 public:
  void step(double t_s, const SeenScreen& seen, InputFrame& frame) {
    if (!room_ || t_s >= until_s_) {
      room_.emplace(draw_gallery(kNaiveKinds[number_ % kNaiveKinds.size()], 4'400'000 + number_));
      gallery_ = std::make_unique<Gallery>(*room_);
      ++number_;
      from_s_ = t_s;
      until_s_ = t_s + room_->leaves_s + 4.0 + (number_ % 8 == 0 ? 120.0 : 5.0);  // at times nobody comes
    }
    const TimestampNs from = static_cast<TimestampNs>(1e9 * from_s_);
    if (!gallery_->step(t_s - from_s_, seen, frame)) return;
    frame.time += from;
    for (HandFrame& hand : frame.hands) hand.time += from;
    for (HeadFrame& head : frame.heads) head.time += from;
  }

 private:
  std::optional<GalleryOptions> room_;
  std::unique_ptr<Gallery> gallery_;
  std::uint64_t number_ = 0;
  double from_s_ = 0.0, until_s_ = 0.0;
};

/// `rate_hz` pictures a second of simulated time. Recoveries are from a fault's end to the ring of a hand that is seen,
/// of a panel's to the new window.
SoakFigures simulate_day(double hours, double rate_hz = 60.0);

}  // namespace dubsar::app::test
