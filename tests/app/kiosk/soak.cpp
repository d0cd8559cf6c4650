// soak [HOURS [MINUTES [SURFACE]]]: simulated hours of visitors before the kiosk without drawing, then minutes of real
// drawing in a window; a fault every minute. Prints figures and whether they hold.

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "app/viewer/run_view.h"
#include "core/base/progress.h"
#include "core/mesh_io/mesh_io.h"
#include "tests/app/kiosk/gallery_session.h"
#include "tests/app/kiosk/gallery_visit.h"
#include "tests/app/kiosk/service_manager.h"
#include "tests/app/kiosk/soak_day.h"
#include "tests/app/kiosk/soak_figures.h"
#include "tests/display/test_meshes.h"
#include "tests/display/xvfb_server.h"

namespace dubsar::app::test {
namespace {

constexpr TimestampNs kSecond = 1'000'000'000;
/// The tracker of the drawn kiosk: the same people, in real time; a fault takes it away.
struct Tracker {
  std::mutex mutex;
  bool silent = false, gone = false;
};

class PeopleSource final : public InputSource {
 public:
  PeopleSource(Tracker& tracker, const InputConfig& config) : tracker_(tracker), seen_(config.seen_view) {}
  std::string_view name() const noexcept override { return "people"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    const std::lock_guard lock(tracker_.mutex);
    if (tracker_.silent || tracker_.gone) return Freshness::kLost;
    if (began_ < 0) began_ = now;
    SeenScreen screen;
    if (seen_) screen.view = seen_();
    people_.step(1e-9 * static_cast<double>(now - began_), screen, newest);
    newest.time += began_;
    for (HandFrame& hand : newest.hands) hand.time = newest.time;
    for (HeadFrame& head : newest.heads) head.time = newest.time;
    const bool fresh = newest.time != last_;
    last_ = newest.time;
    return fresh ? Freshness::kNew : Freshness::kUnchanged;
  }

 private:
  Tracker& tracker_;
  std::function<ViewState()> seen_;
  People people_;
  TimestampNs began_ = -1, last_ = 0;
};

/// The kiosk's guide, watched.
class WatchedGuide final : public SessionController {
 public:
  WatchedGuide(KioskParts parts, SoakFigures& figures) : guide_(std::move(parts)), figures_(figures) {}
  bool takes(const InputEvent& event, TimestampNs now) override { return guide_.takes(event, now); }
  Guidance lead(const SessionMoment& moment) override {
    begun_ = moment.now;
    present_ = !moment.sources.empty() && moment.sources[0].health == SourceHealth::kPresent;
    const bool hands = !moment.steered.hands.empty();
    if (hands && !hands_) appeared_ = moment.now - moment.steered.input_age.value_or(0);
    hands_ = hands;
    Guidance out = guide_.lead(moment);
    for (std::string& command : std::exchange(commands_, {})) out.commands.push_back(std::move(command));
    return out;
  }
  void say(std::string command) { commands_.push_back(std::move(command)); }
  void presented(TimestampNs now) override {
    guide_.presented(now);
    ++figures_.pictures;
    if (figures_.pictures > 1 && !stopped_)
      figures_.longest_ms = std::max(figures_.longest_ms, 1e-6 * static_cast<double>(now - begun_));
    if (appeared_ >= 0 && !stopped_) figures_.hand_ms.add(1e-6 * static_cast<double>(now - appeared_));
    appeared_ = -1;
    stopped_ = false;
    if (fault_end_ && now > *fault_end_ && present_) {
      figures_.recovery_s[kind_].push_back(1e-9 * static_cast<double>(now - *fault_end_));
      fault_end_.reset();
    }
  }
  void fault_begins() {
    figures_.never_back += fault_end_.has_value();
    fault_end_.reset();
  }
  void fault_ends(std::string_view kind, TimestampNs now) {
    kind_ = kind;
    fault_end_ = now;
  }
  void was_stopped() { stopped_ = true; }  ///< this picture's time is not its own
  const Visit& visit() const { return guide_.visit(); }

 private:
  KioskController guide_;
  SoakFigures& figures_;
  TimestampNs begun_ = 0, appeared_ = -1;
  bool hands_ = false;
  std::optional<TimestampNs> fault_end_;
  std::string kind_;
  std::vector<std::string> commands_;
  bool present_ = false, stopped_ = false;
};

/// As a laptop that is closed and opened: nothing of this process runs meanwhile.
void suspend(int seconds) {
  const pid_t me = ::getpid(), child = ::fork();
  if (child == 0) {
    ::sleep(static_cast<unsigned>(seconds));
    ::kill(me, SIGCONT);
    ::_exit(0);
  }
  if (child < 0) return;
  ::raise(SIGSTOP);
  ::waitpid(child, nullptr, 0);
}

Result<SoakFigures> draw(double minutes, const TriMesh& mesh) {
  SoakFigures out;
  const testing::XvfbServer server(960, 540);
  if (!server.problem().empty()) return fail(ErrorKind::kUnavailable, "{}", server.problem());
  Tracker tracker;
  ViewOptions options;
  DUBSAR_ASSIGN(options.mapping, gallery_mapping());
  DUBSAR_ASSIGN(options.stage.shading, shading_preset("relief"));
  options.stage.quality = Quality::kAdaptive;
  options.window = WindowOptions();
  options.fullscreen = true;
  options.inputs = {"people"};
  options.sources.make = [&](std::string_view, const InputConfig& config) -> Result<std::unique_ptr<InputSource>> {
    const std::lock_guard lock(tracker.mutex);
    if (tracker.gone) return fail(ErrorKind::kUnavailable, "the service is not there");
    return std::make_unique<PeopleSource>(tracker, config);
  };
  options.around.notices = false;
  options.time.longest_s = 60.0 * minutes;
  std::int64_t wall_jump = 0;
  ServiceManager manager;
  KioskParts parts;
  parts.notify_socket = manager.path();
  parts.watchdog_us = kWatchdogUs;
  parts.profile.objects = {{.file = "surface"}};
  parts.profile.pin = "90210735";
  parts.zone = {1e-3 * options.mapping.hands.zone_min_mm, 1e-3 * options.mapping.hands.zone_max_mm};
  parts.wall = [&] { return WallTime{1'790'000'000 + wall_jump, 12 * 60}; };
  WatchedGuide guide(std::move(parts), out);
  options.guide = &guide;
  const SteadyClock clock;
  const TimestampNs began = clock.now();
  TimestampNs sampled = 0;
  bool broken = false;
  const auto look = [&](const ViewMoment& moment) {
    const TimestampNs now = clock.now();
    while (glGetError() != GL_NO_ERROR) ++out.gl_errors;
    const double t = 1e-9 * static_cast<double>(now - began), in_minute = std::fmod(t, kFaultEveryS);
    manager.watch(t, kWatchdogS);
    if (now - sampled >= 10 * kSecond) {
      out.memory.push_back({t / 3600.0, resident_mib()});
      sampled = now;
    }
    const auto fault = static_cast<Fault>(static_cast<std::int64_t>(t / kFaultEveryS) % kDrawnFaults);
    const bool breaks = in_minute >= kFaultAtS && in_minute < kFaultAtS + kFaultS;
    if (breaks == broken) return;
    broken = breaks;
    if (broken) guide.fault_begins();
    GlfwWindow& window = *moment.presenter.window();
    const std::lock_guard lock(tracker.mutex);
    switch (fault) {
      case Fault::kUnplugged:
        tracker.silent = broken;
        break;
      case Fault::kServiceDies:
        tracker.gone = broken;
        if (broken) {  // what was made with it is given up; it is looked for every two seconds
          for (const char* command : {"help", "toggle_source 1", "toggle_source 1", "help"}) guide.say(command);
        }
        break;
      case Fault::kMonitorLost:  // the window falls onto what is left, and covers the monitor again
        if (broken)
          window.set_windowed();
        else if (const auto done = window.set_fullscreen(); !done)
          fmt::print(stderr, "soak: {}\n", done.error().message);
        break;
      case Fault::kClockJumps:
        wall_jump += broken ? 86'400 : -172'800;
        break;
      case Fault::kSuspended:
        if (broken) suspend(static_cast<int>(kFaultS));
        guide.was_stopped();
        break;
      default:  // those that are simulated only
        break;
    }
    if (!broken) guide.fault_ends(kFaultNames[static_cast<std::size_t>(fault)], clock.now());
  };
  SilentProgress progress;
  DUBSAR_TRY(run_view(mesh, options, progress, look));
  out.visits = guide.visit().counts().visits;
  out.restarts = manager.restarts();
  out.silence_s = manager.longest_silence_s();
  return out;
}

Result<TriMesh> surface_of(const std::string& path) {
  if (path.empty()) return testing::lettered_box();
  SilentProgress progress;
  return read_mesh(path, progress);
}

}  // namespace
}  // namespace dubsar::app::test

int main(int argc, char** argv) {
  using namespace dubsar;
  using namespace dubsar::app::test;
  const double hours = argc > 1 ? std::atof(argv[1]) : 8.0, minutes = argc > 2 ? std::atof(argv[2]) : 30.0;
  bool good = true;
  if (hours > 0) {
    const SoakFigures simulated = simulate_day(hours);
    good = holds(simulated, false);
    fmt::print("{} simulated hours without drawing\n{}\n", hours, describe(simulated, false));
  }
  if (minutes > 0) {
    const auto mesh = surface_of(argc > 3 ? argv[3] : "");
    if (!mesh) {
      fmt::print(stderr, "soak: {}\n", mesh.error().message);
      return exit_code(mesh.error().kind);
    }
    const auto drawn = draw(minutes, *mesh);
    if (!drawn) {
      fmt::print(stderr, "soak: {}\n", drawn.error().message);
      return exit_code(drawn.error().kind);
    }
    good = good && holds(*drawn, true);
    fmt::print("{} minutes of drawing\n{}", minutes, describe(*drawn, true));
  }
  return good ? 0 : 1;
}
