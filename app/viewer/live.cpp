#include "app/viewer/live.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>

#include "app/panels/overlay.h"
#include "app/panels/state_page.h"
#include "app/viewer/display_clock.h"
#include "app/viewer/input_log.h"
#include "app/viewer/session_keys.h"
#include "app/viewer/window_input.h"
#include "core/base/log.h"
#include "core/image_io/png_file.h"
#include "display/render/compose_pass.h"
#include "display/sinks/field_cadence.h"
#include "display/sinks/sink_window.h"
#include "input/window_events.h"

namespace dubsar::app {
namespace {

constexpr double kIdleS = 0.008;                            // how long input may wait while nothing moves
constexpr auto kSteerEvery = std::chrono::milliseconds(8);  // whatever a picture takes
constexpr TimestampNs kSecond = 1'000'000'000;
constexpr TimestampNs kNoticeNs = 6 * kSecond, kFadeNs = kSecond, kHelpRefreshNs = kSecond / 2, kSettleNs = kSecond;
constexpr std::size_t kRecent = 300;  // measurements that the figures on the help page come from
constexpr int kMostFailures = 3;

Result<void> check(const LiveOptions& options) {
  if (options.simulated_fps != 0 && !(options.simulated_fps >= 1 && options.simulated_fps <= 240))
    return fail(ErrorKind::kUsage, "view: {} frames a second found, expected 1 to 240", options.simulated_fps);
  if (!(options.longest_s >= 0 && options.longest_s <= 86400 * 7) || options.every < 1 ||
      !(options.display_delay_s >= 0 && options.display_delay_s <= 0.1))
    return fail(ErrorKind::kUsage,
                "view: {} s with a display delay of {} s found, expected up to a week and 0 to 0.1 s",
                options.longest_s, options.display_delay_s);
  if (options.frames.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(options.frames, error);
  if (error || !std::filesystem::is_directory(options.frames))
    return fail(ErrorKind::kCannotCreate, "view: cannot create the folder {}: {}", options.frames.string(),
                error.message());
  return {};
}

class Live {
 public:
  Live(const LiveOptions& options, Progress& progress) : options_(options), progress_(progress) {}
  Result<LiveResult> run(const TriMesh& mesh, const std::function<void(const LiveMoment&)>& look);

 private:
  Result<void> open(const TriMesh& mesh);
  Result<void> place_changed();
  void use_window_event(const WindowEvent& told);
  void obey(SessionCommand command);
  void use_key(const std::string& key);
  bool ask(const std::string& key);
  void switch_display(int step);
  void toggle_fullscreen();
  void notice(std::string text, TimestampNs now);
  void update_overlay(TimestampNs now);
  std::vector<HelpSection> help() const;
  Field wait_turn();
  Result<void> show(TimestampNs begun);
  bool over(TimestampNs now);
  void wait();
  void steer(const std::stop_token& stop);
  Result<void> end_recording();

  bool simulated() const noexcept { return options_.simulated_fps > 0; }
  int fields() const { return session_->traits().fields; }
  TimestampNs now() const { return simulated() ? manual_.now() : clock_.now(); }

  const LiveOptions& options_;
  Progress& progress_;
  SteadyClock clock_;
  ManualClock manual_;                  // of simulated time; outlives the sources
  std::unique_ptr<GlfwWindow> window_;  // goes last: all else has GL objects
  std::unique_ptr<Session> session_;
  std::unique_ptr<Overlay> overlay_;
  std::optional<OffscreenSurface> whole_;  // the composed picture, where the window has another size
  WindowEvents events_;
  std::unique_ptr<SourceSet> sources_;
  DisplayClock display_clock_;
  FieldCadence cadence_;
  std::vector<SinkSpec> displays_;
  std::size_t display_ = 0;
  Mapping mapping_;
  FrameReport report_;
  LiveResult out_;
  TimestampNs start_ = 0, last_presented_ = -1, all_over_since_ = -1, help_made_ = -1, notice_since_ = -1;
  std::string notice_;
  bool help_open_ = false, drawn_ = false;
  std::deque<double> recent_age_ms_, recent_interval_ms_;
  std::vector<double> intervals_ms_;
  int failures_ = 0;
  InputLog log_;
  std::jthread steering_;  // goes first
};

Result<void> Live::open(const TriMesh& mesh) {
  WindowOptions place = options_.window;
  SessionOptions wanted = options_.session;
  DUBSAR_ASSIGN(auto sink, wanted.catalog->make(wanted.display));
  DUBSAR_TRY(choose_place(sink->traits(), options_.fullscreen, place));
  DUBSAR_ASSIGN(SinkWindow shown, open_sink_window(*wanted.catalog, wanted.display, std::move(sink), place));
  wanted.display = shown.display;
  const std::string note = shown.note;
  window_ = std::move(shown.window);
  wanted.screen = window_->screen(wanted.screen);
  wanted.stereo_window = window_->stereo();
  if (simulated()) wanted.quality = Quality::kExact;
  DUBSAR_ASSIGN(session_, Session::create(mesh, wanted, std::move(shown.sink)));
  DUBSAR_ASSIGN(overlay_, Overlay::create());
  displays_ = {wanted.display};
  if (options_.displays.empty()) {
    displays_ = displays_for_window(wanted.display, wanted.screen, window_->stereo(), wanted.catalog->panels());
  } else {
    displays_.insert(displays_.end(), options_.displays.begin(), options_.displays.end());
  }
  mapping_ = wanted.mapping;
  InputConfig config;
  config.window = &events_;
  config.seen_view = &session_->view();
  if (simulated()) {
    manual_.set(static_cast<TimestampNs>(1e9 / options_.simulated_fps));
    config.clock = &manual_;
    config.simulated_time = true;
  }
  config.hotplug = HotplugBell::of_this_machine();
  config.model_folder = options_.session.model_folder;
  config.panel_m = 1e-3 * glm::dvec2(options_.session.screen.width_mm, options_.session.screen.height_mm);
  if (!options_.record.empty()) {
    DUBSAR_ASSIGN(auto recorder, InputRecorder::create(options_.record));
    log_.record(std::move(recorder));
  }
  session_->on_input([this](TimestampNs at, const InputFrame& frame) { log_.hear(at, frame); });
  sources_ = std::make_unique<SourceSet>(session_->input(), config, options_.make_input);
  std::vector<std::string> inputs = options_.inputs;
  if (inputs.empty()) {
    inputs = {"mouse", "keyboard"};
    for (std::string& spec : present_inputs()) inputs.push_back(std::move(spec));
  }
  DUBSAR_TRY(sources_->start(inputs));
  window_->on_event([this](const WindowEvent& event) { use_window_event(event); });
  DUBSAR_TRY(place_changed());
  if (!note.empty()) {
    log_warning("{}", note);
    notice(note, now());
  } else {
    notice("F1: help    Esc: end", now());
  }
  return {};
}

/// The window is somewhere else, or the display is another one.
Result<void> Live::place_changed() {
  static_cast<void>(window_->take_place_changed());
  const PixelSize size = window_->size();
  if (size.width < 1 || size.height < 1) return {};  // minimised
  DUBSAR_TRY(session_->set_screen(window_->screen(options_.session.screen)));
  display_clock_.set_refresh(window_->refresh_hz());
  cadence_.set_refresh(window_->refresh_hz());
  const SinkTraits traits = session_->traits();
  whole_.reset();
  if (!traits.exact_pixels && traits.output != size && traits.output.width > 0 && traits.output.height > 0) {
    DUBSAR_ASSIGN(whole_, OffscreenSurface::create(traits.output));
  }
  return {};
}

void Live::notice(std::string text, TimestampNs now) {
  if (!options_.notices) return;
  notice_ = std::move(text);
  notice_since_ = now;
}

void Live::switch_display(int step) {
  const std::size_t count = displays_.size();
  for (std::size_t tried = 1; tried <= count; ++tried) {
    const std::size_t next = (display_ + (step > 0 ? tried : tried * (count - 1))) % count;
    auto done = session_->set_display(displays_[next]);
    if (done) done = place_changed();
    if (done) {
      display_ = next;
      notice("display " + displays_[next].text(), now());
      log_info("display {}", displays_[next].text());
      return;
    }
    log_warning("{}", done.error().message);
  }
}

void Live::toggle_fullscreen() {
  if (window_->fullscreen()) {
    window_->set_windowed();
  } else if (auto done = window_->set_fullscreen(); !done) {
    notice(done.error().message, now());
  }
}

void Live::obey(SessionCommand command) {
  switch (command) {
    case SessionCommand::kHelp:
      help_open_ = !help_open_;
      break;
    case SessionCommand::kNextDisplay:
      switch_display(1);
      break;
    case SessionCommand::kPreviousDisplay:
      switch_display(-1);
      break;
    case SessionCommand::kRetrySources:
      sources_->retry_now();
      break;
    case SessionCommand::kFullscreen:
      toggle_fullscreen();
      break;
    case SessionCommand::kEnd:
      if (!help_open_) window_->close();
      help_open_ = false;
      break;
  }
  help_made_ = -1;
}

/// A key that went down, in the window or in a script.
void Live::use_key(const std::string& key) {
  if (const auto command = session_command(key)) return obey(*command);
  if (help_open_ && key.size() == 1 && key[0] >= '1' && key[0] <= '9' &&
      sources_->toggle(static_cast<std::size_t>(key[0] - '1')))
    help_made_ = -1;
}

/// True when the program took the key.
bool Live::ask(const std::string& key) {
  KeyAnswer answer = options_.keys(key);
  if (answer.display_changed) {
    auto done = session_->set_display(displays_[display_]);
    if (done) done = place_changed();
    if (!done) answer.notice = done.error().message;
  }
  if (!answer.notice.empty()) notice(std::move(answer.notice), now());
  return answer.taken;
}

void Live::use_window_event(const WindowEvent& told) {
  InputEvent event = to_input_event(told, window_->size());
  if (simulated()) event.time = now();
  const bool key = event.kind == EventKind::kKey;
  if (key && (session_command(event.key) || help_open_)) {
    if (event.down && !event.repeat) use_key(event.key);
    if (session_command(event.key)) return log_.hear_own(event);
  }
  if (key && event.down && options_.keys && ask(event.key)) return log_.hear_own(event);
  events_.push(event);
}

std::vector<HelpSection> Live::help() const {
  StateFigures state;
  state.display = displays_[display_].text();
  state.traits = session_->traits();
  state.head = report_.head;
  state.eyes_mm = report_.viewer.centre_mm();
  state.interval_ms = {recent_interval_ms_.begin(), recent_interval_ms_.end()};
  state.input_age_ms = {recent_age_ms_.begin(), recent_age_ms_.end()};
  state.sources = sources_->rows();
  std::vector<HelpSection> out = state_page(state);
  for (HelpSection& section : help_page(mapping_)) out.push_back(std::move(section));
  return out;
}

void Live::update_overlay(TimestampNs now) {
  OverlayText text = overlay_->text();
  if (!help_open_) {
    text.help.clear();
  } else if (help_made_ < 0 || now - help_made_ >= kHelpRefreshNs) {
    text.help = help();
    help_made_ = now;
  }
  const TimestampNs age = now - notice_since_;
  if (notice_since_ < 0 || age >= kNoticeNs) {
    text.notice.clear();
    text.notice_opacity = 1.0;
  } else {
    text.notice = notice_;
    text.notice_opacity = std::clamp(static_cast<double>(kNoticeNs - age) / static_cast<double>(kFadeNs), 0.0, 1.0);
  }
  if (text == overlay_->text()) return;
  overlay_->set(std::move(text));
  session_->set_overlay(overlay_->text().empty() ? nullptr : overlay_.get());
}

/// Waits where a beat of the monitor is too near, and says whose turn it is behind it.
Field Live::wait_turn() {
  const TimestampNs turn = cadence_.turn(clock_.now());
  std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<TimestampNs>(0, turn - clock_.now())));
  return cadence_.next(std::max(turn, clock_.now()));
}

/// Draws and presents; figures are kept, files written.
Result<void> Live::show(TimestampNs begun) {
  const double cpu = process_cpu_seconds();
  const Surface target = window_->surface();
  const Field field = fields() > 1 ? wait_turn() : Field::kFirst;
  DUBSAR_TRY(session_->paint(whole_ ? whole_->surface() : target, field));
  if (whole_) DUBSAR_TRY(fit_into(whole_->surface(), target));
  if (!options_.frames.empty() && (simulated() || out_.frames % options_.every == 0)) {
    DUBSAR_ASSIGN(const Image picture, window_->read());
    DUBSAR_TRY(write_png(
        (options_.frames / fmt::format("frame-{:05}{}.png", out_.frames, session_->traits().file_suffix)).string(),
        picture));
    ++out_.written;
  }
  const TimestampNs drawn = clock_.now();
  window_->present();
  if (fields() > 1) glFinish();  // the beat is over when the call is, not when the driver has queued it
  const TimestampNs presented = clock_.now();
  display_clock_.presented(begun, drawn, presented);
  cadence_.presented(presented);
  const auto keep = [](std::deque<double>& values, double value) {
    values.push_back(value);
    if (values.size() > kRecent) values.pop_front();
  };
  if (report_.moving && last_presented_ >= 0 && presented - last_presented_ < kSecond / 4) {
    const double interval = 1e-6 * static_cast<double>(presented - last_presented_);
    intervals_ms_.push_back(interval);
    keep(recent_interval_ms_, interval);
  }
  if (report_.input_age) keep(recent_age_ms_, 1e-6 * static_cast<double>(*report_.input_age));
  last_presented_ = presented;
  ++out_.frames;
  drawn_ = true;
  out_.frame_cpu_ms.push_back(1e3 * (process_cpu_seconds() - cpu));
  return {};
}

/// Scripts and recordings end a session that has no other input.
bool Live::over(TimestampNs now) {
  if (options_.longest_s > 0 && now - start_ >= static_cast<TimestampNs>(1e9 * options_.longest_s)) return true;
  const auto rows = sources_->rows();
  const bool waits_for_people =
      session_->input().endless() ||
      std::any_of(rows.begin(), rows.end(), [](const SourceRow& row) { return row.health == SourceHealth::kMissing; });
  if (waits_for_people || !session_->input().finished()) {
    all_over_since_ = -1;
    return false;
  }
  if (all_over_since_ < 0) all_over_since_ = now;
  return now - all_over_since_ >= kSettleNs;
}

/// Until the next picture is due, or while nothing moves until something happens.
void Live::wait() {
  if (simulated()) return manual_.advance(static_cast<TimestampNs>(1e9 / options_.simulated_fps));
  if (fields() > 1) return;  // the next present waits for the monitor
  if (!session_->needs_paint() && !report_.moving) return window_->wait_events(kIdleS);
  for (TimestampNs now = clock_.now(); now < display_clock_.next_start() && !window_->should_close();
       now = clock_.now())
    window_->wait_events(1e-9 * static_cast<double>(display_clock_.next_start() - now));
}

/// The thread that keeps gestures going while a picture is made.
void Live::steer(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any waiting;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    session_->steer(clock_.now());
    waiting.wait_for(lock, stop, kSteerEvery, [] { return false; });
  }
}

/// Ends the reading of input.
Result<void> Live::end_recording() {
  steering_ = {};  // joined
  return log_.finish();
}

Result<LiveResult> Live::run(const TriMesh& mesh, const std::function<void(const LiveMoment&)>& look) {
  DUBSAR_TRY(check(options_));
  DUBSAR_TRY(open(mesh));
  progress_.begin("view", 0, "frame");
  start_ = now();
  glm::dquat last_turn = session_->view().rotation;
  const auto delay = static_cast<TimestampNs>(1e9 * options_.display_delay_s);
  if (!simulated()) steering_ = std::jthread([this](const std::stop_token& stop) { steer(stop); });
  bool ends = false;
  for (std::int64_t steps = 0; !ends; ++steps) {
    if (progress_.cancelled()) {
      DUBSAR_TRY(end_recording());  // what a person showed is not lost with the session
      return cancelled_error();
    }
    window_->poll_events();
    if (window_->take_place_changed())
      if (auto done = place_changed(); !done) log_warning("{}", done.error().message);
    const TimestampNs at = now();
    sources_->tick(at);
    report_ = session_->poll(at, (simulated() ? at : display_clock_.light(at)) + delay);
    for (const std::string& key : log_.take_keys()) use_key(key);
    if (simulated()) DUBSAR_TRY(log_.flush());
    if (report_.input_age) out_.input_age_ms.push_back(1e-6 * static_cast<double>(*report_.input_age));
    out_.largest_turn_deg = std::max(out_.largest_turn_deg, turn_between_deg(last_turn, report_.view.rotation));
    last_turn = report_.view.rotation;
    update_overlay(at);
    drawn_ = false;
    const PixelSize size = window_->size();
    const bool damaged = window_->take_damaged();
    const bool due = simulated() ? steps % options_.every == 0 : damaged || session_->needs_paint() || fields() > 1;
    if (due && size.width > 0 && size.height > 0) {
      auto shown = show(clock_.now());
      failures_ = shown ? 0 : failures_ + 1;
      if (!shown && failures_ == 1) log_warning("{}; the session goes on", shown.error().message);
      if (failures_ >= kMostFailures) return tl::unexpected<Error>(shown.error());
      if (shown) report_.light = session_->light();
      progress_.advance(1);
    }
    if (look) {
      const std::string name = displays_[display_].text();
      look({.report = report_,
            .drawn = drawn_,
            .frames = out_.frames,
            .help = help_open_,
            .display = name,
            .sources = sources_->rows(),
            .session = *session_,
            .window = *window_});
    }
    ends = window_->should_close() || over(now());
    if (!ends) wait();
  }
  progress_.end();
  out_.seconds = 1e-9 * static_cast<double>(now() - start_);
  out_.fps = intervals_ms_.empty() ? 0.0 : 1e3 / std::max(quantile(intervals_ms_, 0.5), 1e-3);
  out_.view = session_->view();
  out_.display = displays_[display_].text();
  out_.rows = sources_->rows();
  out_.sources = session_->input().states();
  DUBSAR_TRY(end_recording());
  return std::move(out_);
}

}  // namespace

Result<LiveResult> run_live(const TriMesh& mesh, const LiveOptions& options, Progress& progress,
                            const std::function<void(const LiveMoment&)>& look) {
  Live live(options, progress);
  return live.run(mesh, look);
}

}  // namespace dubsar::app
