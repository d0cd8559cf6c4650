#include "app/viewer/run_view.h"

#include <cmath>
#include <deque>
#include <system_error>

#include "app/viewer/presenter/window_presenter.h"
#include "app/viewer/side_panels.h"
#include "core/base/system/large_blocks.h"
#include "core/base/system/log.h"
#include "core/image_io/png_file.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kRecent = 300;  // measurements that the figures on the help page come from
constexpr int kMostFailures = 3;

Result<void> check(const ViewOptions& options) {
  const bool simulated = options.time.fps != 0;
  if (simulated && !(options.time.fps >= 1 && options.time.fps <= 240))
    return fail(ErrorKind::kUsage, "view: {} frames a second found, expected 1 to 240", options.time.fps);
  if (!simulated && !options.window)
    return fail(ErrorKind::kUsage, "view: no frames a second found, expected 1 to 240 without a window");
  if (!(options.time.longest_s >= 0 && options.time.longest_s <= 86400 * 7) || options.files.every < 1 ||
      !(options.time.display_delay_s >= 0 && options.time.display_delay_s <= 0.1))
    return fail(ErrorKind::kUsage,
                "view: {} s with a display delay of {} s found, expected up to a week and 0 to 0.1 s",
                options.time.longest_s, options.time.display_delay_s);
  if (!options.window && options.inputs.empty() && options.steps.empty())
    return fail(ErrorKind::kUsage,
                "view: no input, expected --steps FILE, --script FILE or --input with scripted:FILE or replay:FILE");
  if (options.files.frames.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(options.files.frames, error);
  if (error || !std::filesystem::is_directory(options.files.frames))
    return fail(ErrorKind::kCannotCreate, "view: cannot create the folder {}: {}", options.files.frames.string(),
                error.message());
  return {};
}

class Figures {
 public:
  void took_part(ViewResult& out, const PictureReport& report) {
    if (!report.input_age) return;
    const double ms = 1e-6 * static_cast<double>(*report.input_age);
    out.input_age_ms.add(ms);
    keep(ages_ms_, ms);
  }
  /// A picture was presented at `at` of the real clock.
  void presented(TimestampNs at, bool moving) {
    if (moving && last_ >= 0 && !rested_) {
      const double ms = 1e-6 * static_cast<double>(at - last_);
      intervals_all_ms_.add(ms);
      keep(intervals_ms_, ms);
    }
    last_ = at;
    rested_ = !moving;
  }
  /// A turn of the loop at which there was nothing new to show.
  void rested() { rested_ = true; }
  const Measurements& intervals_ms() const { return intervals_all_ms_; }
  RecentFigures recent() const {
    return {{intervals_ms_.begin(), intervals_ms_.end()}, {ages_ms_.begin(), ages_ms_.end()}};
  }
  double fps() const { return intervals_all_ms_.empty() ? 0.0 : 1e3 / std::max(intervals_all_ms_.quantile(0.5), 1e-3); }

 private:
  static void keep(std::deque<double>& values, double value) {
    values.push_back(value);
    if (values.size() > kRecent) values.pop_front();
  }
  TimestampNs last_ = -1;
  bool rested_ = true;
  std::deque<double> ages_ms_, intervals_ms_;
  Measurements intervals_all_ms_;
};

class Loop {
 public:
  Loop(const ViewOptions& options, Progress& progress) : options_(options), progress_(progress) {}
  Result<ViewResult> run(const TriMesh& mesh, const std::function<void(const ViewMoment&)>& look, FileLoader* loader,
                         KeptPanels* kept);

 private:
  bool simulated() const noexcept { return options_.time.fps > 0; }
  TimestampNs step() const { return static_cast<TimestampNs>(1e9 / options_.time.fps); }
  const Clock& clock() const noexcept { return simulated() ? static_cast<const Clock&>(manual_) : steady_; }
  Result<void> draw(bool& drawn);
  /// Where the next picture becomes a file, without its ending; empty: nowhere.
  std::string frame_file() const;
  Result<void> take(KeptPanels& kept, std::unique_ptr<OutputSink>& sink);
  void give(KeptPanels& kept);
  Result<void> write_picture();
  Result<void> follow(bool due, const std::string& frame);
  void stay_in_front();
  bool ends(TimestampNs start);
  Result<void> turn_until_over(TimestampNs start, const std::function<void(const ViewMoment&)>& look);

  ViewOptions options_;
  Progress& progress_;
  SteadyClock steady_;
  const TimestampNs began_ = steady_.now();
  ManualClock manual_;                    // of simulated time; outlives the sources
  std::unique_ptr<Presenter> presenter_;  // all else has GL objects
  std::unique_ptr<Viewer> viewer_;
  std::unique_ptr<SidePanels> also_;  // what they show is the viewer's
  Figures figures_;
  ViewResult out_;
  std::int64_t steps_ = 0;
  int failures_ = 0;
  bool wearer_ended_ = false;
};

std::string Loop::frame_file() const {
  if (options_.files.frames.empty() || (!simulated() && out_.frames % options_.files.every != 0)) return {};
  return (options_.files.frames / fmt::format("frame-{:05}", simulated() ? steps_ : out_.frames)).string();
}

Result<void> Loop::write_picture() {
  const std::string file = frame_file();
  if (file.empty()) return {};
  DUBSAR_ASSIGN(const Image picture, presenter_->picture());
  DUBSAR_TRY(write_png(fmt::format("{}{}.png", file, viewer_->stage().traits().file_suffix), picture));
  ++out_.written;
  return {};
}

Result<void> Loop::draw(bool& drawn) {
  const double cpu = process_cpu_seconds();
  DUBSAR_TRY(viewer_->paint(presenter_->surface(), presenter_->turn()));
  DUBSAR_TRY(write_picture());
  DUBSAR_TRY(presenter_->present());
  figures_.presented(steady_.now(), viewer_->report().moving);
  viewer_->presented(steady_.now());
  const double since_s = 1e-9 * static_cast<double>(steady_.now() - began_);
  if (!out_.first.window_s) out_.first.window_s = since_s;
  if (!out_.first.surface_s && viewer_->shows_surface()) out_.first.surface_s = since_s;
  out_.frame_cpu_ms.add(1e3 * (process_cpu_seconds() - cpu));
  ++out_.frames;
  drawn = true;
  return {};
}

/// The windows of the session before, with what is on them.
Result<void> Loop::take(KeptPanels& kept, std::unique_ptr<OutputSink>& sink) {
  presenter_ = std::move(kept.main);
  also_ = std::move(kept.also);
  DUBSAR_TRY(presenter_->make_current());
  StageOptions& stage = options_.stage;
  stage.display = kept.display;
  stage.screen = presenter_->screen(stage.screen);
  stage.stereo_window = presenter_->window() != nullptr && presenter_->window()->stereo();
  DUBSAR_ASSIGN(sink, stage.catalog->make(stage.display));
  return {};
}

void Loop::give(KeptPanels& kept) {
  also_->drop_surface();
  kept.display = options_.stage.display;
  if (GlfwWindow* const window = presenter_->window()) {
    window->on_event({});
    window->on_drop({});
  }
  viewer_.reset();
  kept.also = std::move(also_);
  kept.main = std::move(presenter_);
}

/// The other panels.
Result<void> Loop::follow(bool due, const std::string& frame) {
  if (also_->empty() || (simulated() && !due)) return {};
  DUBSAR_TRY(also_->follow(*viewer_, clock().now(), frame));
  viewer_->set_trouble(also_->trouble());
  return {};
}

/// Whoever leads the session does so where nobody could bring a hidden window back.
void Loop::stay_in_front() {
  if (options_.guide == nullptr || simulated()) return;
  presenter_->look_after(!also_->focused());
  also_->look_after();
}

bool Loop::ends(TimestampNs start) {
  const TimestampNs now = clock().now();
  if (options_.guide != nullptr) {
    if (viewer_->guidance().end) return true;
    if (presenter_->ended()) presenter_->keep_open();
  }
  if (presenter_->ended() && !viewer_->may_end()) presenter_->keep_open();
  const bool before = std::exchange(wearer_ended_, viewer_->stage().display_ended());
  if (options_.guide == nullptr && wearer_ended_ && !before && viewer_->may_end()) return true;
  if (presenter_->ended() || viewer_->over(now)) return true;
  if (!simulated() && options_.time.outdated && options_.time.outdated()) return true;
  if (options_.time.longest_s <= 0) return false;
  if (simulated()) return static_cast<double>(steps_ + 1) >= options_.time.longest_s * options_.time.fps;
  return now - start >= static_cast<TimestampNs>(1e9 * options_.time.longest_s);
}

Result<ViewResult> Loop::run(const TriMesh& mesh, const std::function<void(const ViewMoment&)>& look,
                             FileLoader* loader, KeptPanels* kept) {
  DUBSAR_TRY(check(options_));
  return_large_blocks();  // textures, each time the window changes
  std::string note;
  std::unique_ptr<OutputSink> sink;
  if (kept != nullptr && kept->main) {
    DUBSAR_TRY(take(*kept, sink));
  } else if (options_.window) {
    DUBSAR_ASSIGN(presenter_, WindowPresenter::create(options_, sink, note));
  } else {
    DUBSAR_ASSIGN(presenter_, FilePresenter::create());
  }
  if (simulated()) {
    options_.stage.quality = Quality::kExact;
    manual_.set(step());
  }
  const auto surface_goes = [this] {
    if (also_) also_->drop_surface();
  };
  DUBSAR_ASSIGN(viewer_,
                Viewer::create(mesh, options_, {*presenter_, clock(), loader, surface_goes}, std::move(sink), note));
  if (also_)
    also_->begin(options_);
  else
    also_ = std::make_unique<SidePanels>(options_, *presenter_);
  if (!options_.window) progress_.begin("view", 0, "frame");  // a window shows itself how things stand
  const TimestampNs start = clock().now();
  if (auto done = turn_until_over(start, look); !done) {  // what a person made is not lost with the session
    if (const auto left = viewer_->finish(); !left) log_warning("{}", left.error().message);
    return tl::unexpected<Error>(std::move(done).error());
  }
  if (!options_.window) progress_.end();
  out_.seconds = 1e-9 * static_cast<double>(clock().now() - start);
  out_.fps = figures_.fps();
  out_.interval_ms = figures_.intervals_ms();
  out_.also = also_->states();
  viewer_->tell(out_);
  DUBSAR_TRY(viewer_->finish());
  if (kept != nullptr && options_.window) give(*kept);
  return std::move(out_);
}

/// The turns of the loop; its only other way out is an error.
Result<void> Loop::turn_until_over(TimestampNs start, const std::function<void(const ViewMoment&)>& look) {
  const auto delay = static_cast<TimestampNs>(1e9 * options_.time.display_delay_s);
  glm::dquat last_turn = view_of(viewer_->document()).rotation;
  for (bool over = false; !over; ++steps_) {
    if (progress_.cancelled()) return cancelled_error();
    presenter_->take_events();
    stay_in_front();
    const bool damaged = presenter_->take_damaged();
    const TimestampNs at = clock().now();
    viewer_->tick(at, (simulated() ? at : presenter_->light(at)) + delay, figures_.recent());
    if (viewer_->failed()) return tl::unexpected<Error>(*viewer_->failed());
    const PictureReport& report = viewer_->report();
    if (!report.moving) figures_.rested();
    figures_.took_part(out_, report);
    out_.largest_turn_deg = std::max(out_.largest_turn_deg, turn_between_deg(last_turn, report.view.rotation));
    last_turn = report.view.rotation;
    bool drawn = false;
    const auto works = simulated() || !presenter_->visible() ? Result<bool>(false) : viewer_->work();
    const bool due = simulated() ? steps_ % options_.files.every == 0
                                 : damaged || viewer_->stage().needs_paint() || viewer_->stage().traits().fields > 1;
    const std::string frame = due && presenter_->visible() ? frame_file() : std::string();
    if (!works || (due && presenter_->visible())) {
      const auto done = works ? draw(drawn) : Result<void>(tl::unexpect, works.error());
      failures_ = done ? 0 : failures_ + 1;
      if (!done && failures_ == 1) log_warning("{}; the session goes on", done.error().message);
      if (failures_ >= kMostFailures || (!done && !options_.window)) return tl::unexpected<Error>(done.error());
      progress_.advance(1);
    }
    DUBSAR_TRY(follow(due, frame));
    if (look)
      look({.report = report, .drawn = drawn, .frames = out_.frames, .viewer = *viewer_, .presenter = *presenter_});
    over = ends(start);
    if (simulated()) {
      DUBSAR_TRY(viewer_->flush());
      manual_.advance(step());
    } else if (!over && !works.value_or(false)) {
      presenter_->wait(viewer_->stage().needs_paint() || report.moving || also_->need_paint());
    }
  }
  return {};
}

}  // namespace

KeptPanels::KeptPanels() = default;
KeptPanels::~KeptPanels() = default;

Result<ViewResult> run_view(const TriMesh& mesh, const ViewOptions& options, Progress& progress,
                            const std::function<void(const ViewMoment&)>& look, FileLoader* loader, KeptPanels* kept) {
  Loop loop(options, progress);
  return loop.run(mesh, look, loader, kept);
}

}  // namespace dubsar::app
