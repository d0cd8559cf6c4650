#include "tests/app/kiosk/soak_day.h"

#include <cmath>

#include "app/kiosk/wanted_panel.h"
#include "tests/app/kiosk/service_manager.h"

namespace dubsar::app::test {
namespace {

const Monitor kWanted{.name = "HDMI-1", .width_px = 1920, .height_px = 1080};
const Monitor kOther{.name = "DP-1", .width_px = 1280, .height_px = 720, .primary = true};

/// The kiosk's monitor, and what run_kiosk() does when it comes and goes.
struct PanelLink {
  std::vector<Monitor> there{kWanted, kOther};
  MonitorWatch watch{"HDMI-1", [this]() -> Result<std::vector<Monitor>> { return there; }};
  PanelLink() { static_cast<void>(watch.look()); }
  void plug(bool in) { there = in ? std::vector<Monitor>{kWanted, kOther} : std::vector<Monitor>{kOther}; }
  /// The session begins anew on what there is.
  bool begins_anew(TimestampNs now) {
    if (!watch.changed(now)) return false;
    static_cast<void>(watch.look());
    return true;
  }
  bool wanted() const { return choose_panel(there, "HDMI-1", {}).trouble.empty(); }
};

}  // namespace

SoakFigures simulate_day(double hours, double rate_hz) {
  SoakFigures out;
  ServiceManager manager;
  auto session = std::make_unique<GallerySession>(manager.path(), kWatchdogUs);
  std::int64_t visits = 0;
  PanelLink panel;
  People people;
  InputFrame frame;
  const double step_s = 1.0 / rate_hz;
  double away_s = 0.0;  // suspended, in all
  double fault_end = -1.0, hand_since = -1.0;
  std::int64_t minute = -1;
  for (double t = 0.0; t < 3600.0 * hours; t += step_s) {
    const auto fault = static_cast<Fault>(static_cast<std::size_t>(t / kFaultEveryS) % kFaultNames.size());
    const std::string name(kFaultNames[static_cast<std::size_t>(fault)]);
    const double in_minute = std::fmod(t, kFaultEveryS);
    const bool broken = in_minute >= kFaultAtS && in_minute < kFaultAtS + kFaultS;
    const bool begins = broken && in_minute - kFaultAtS < step_s;
    const bool ends = in_minute >= kFaultAtS + kFaultS && in_minute - step_s < kFaultAtS + kFaultS;
    const bool blind = broken && (fault == Fault::kUnplugged || fault == Fault::kServiceDies);
    if (const auto now = static_cast<std::int64_t>(t / kFaultEveryS); now != minute) {
      minute = now;
      out.never_back += hand_since >= 0.0;
      fault_end = hand_since = -1.0;
      out.memory.push_back({t / 3600.0, resident_mib()});
    }
    if (begins && fault == Fault::kSuspended) away_s += 1800.0;
    if (begins && fault == Fault::kClockJumps) away_s -= std::min(away_s, 600.0);
    if (begins && fault == Fault::kTerminated) {
      visits += session->visit().counts().visits;
      session.reset();  // says that it stops
      session = std::make_unique<GallerySession>(manager.path(), kWatchdogUs);
    }
    if (fault == Fault::kPanelAway && (begins || ends)) panel.plug(ends);
    const auto clock = static_cast<TimestampNs>(1e9 * (t + away_s));
    if (panel.begins_anew(static_cast<TimestampNs>(1e9 * t)) && panel.wanted() && fault_end >= 0.0)
      out.recovery_s[name].push_back(t - fault_end);
    session->set_tracker(blind ? SourceHealth::kMissing : SourceHealth::kPresent);
    session->set_on_screen(!broken || fault != Fault::kHidden);
    people.step(t, session->screen(), frame);
    InputFrame seen = frame;
    const auto shift = static_cast<TimestampNs>(1e9 * away_s);
    seen.time += shift;
    for (HandFrame& hand : seen.hands) hand.time += shift;
    if (blind) seen = {};
    if (!broken || fault != Fault::kNoPictures) session->go_on(clock, seen);
    manager.watch(t, kWatchdogS);
    if (ends) fault_end = t;
    if (fault == Fault::kPanelAway) continue;
    if (fault_end >= 0.0 && hand_since < 0.0 && !seen.hands.empty()) hand_since = t;  // nobody may be there
    if (hand_since < 0.0) continue;
    if (session->guidance().lines.size() < seen.hands.size() || seen.hands.empty()) continue;
    out.recovery_s[name].push_back(t - hand_since);
    fault_end = hand_since = -1.0;
  }
  out.visits = visits + session->visit().counts().visits;
  out.restarts = manager.restarts();
  out.silence_s = manager.longest_silence_s();
  return out;
}

}  // namespace dubsar::app::test
