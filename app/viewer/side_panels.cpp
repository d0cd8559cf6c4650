#include "app/viewer/side_panels.h"

#include <algorithm>
#include <utility>

#include "app/panels/overlay.h"
#include "app/panels/panel_font.h"
#include "app/tools/window_input.h"
#include "app/viewer/presenter/window_presenter.h"
#include "app/viewer/viewer.h"
#include "app/words/text.h"
#include "core/base/system/log.h"
#include "core/base/system/second.h"
#include "core/image_io/png_file.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kTryEveryNs = 2 * kSecondNs;

}  // namespace

Shown shown_on(const Shown& main, const PanelPlane& of_main, const PanelPlane& here) {
  Shown out = main;
  const auto least = [](const glm::dvec2& size) { return std::min(size.x, size.y); };
  const double scale = least(here.window_mm) / least(of_main.window_mm);  // as the object, which fits both ways
  const double letters = static_cast<double>(here.view_height_px) / of_main.view_height_px;
  const auto place = [&](glm::dvec3& p) {
    p = glm::dvec3(here.middle_mm + scale * (glm::dvec2(p) - of_main.middle_mm), scale * p.z);
  };
  for (LinesItem& lines : out.before) {
    for (glm::dvec3& p : lines.points_mm) place(p);
    lines.width_px = std::max(1.0, lines.width_px * letters);
  }
  place(out.glow.at_mm);
  out.glow.radius_mm *= scale;
  for (LabelItem& label : out.marks.labels) {
    label.font = here.font;
    label.height_px *= letters;
    label.shift_px *= letters;
  }
  return out;
}

GalleryPicture gallery_on(const GalleryPicture& main, double aspect) {
  GalleryPicture out = main;
  out.buttons = buttons_on(main.buttons, aspect);
  out.menu.clear();
  return out;
}

/// Goes from the bottom up: what is made of a surface, the stage, what lies over it, then the window with its context.
struct SidePanels::Panel {
  Panel(const SidePanelOptions& given, const ViewOptions& session, std::size_t number) : options(session) {
    options.also.clear();
    options.guide = nullptr;
    options.stage.display = given.display;
    options.stage.catalog = given.catalog;
    options.stage.screen = given.screen;
    if (options.window) options.window = given.window;
    options.fullscreen = given.fullscreen;
    out = given.problem;
    name = fmt::format("panel {} ({}{}{})", number, given.name, given.window.monitor.empty() ? "" : " on ",
                       given.window.monitor);
    state.display = given.name;
  }
  ViewOptions options;
  std::string name, out;  ///< out: why it can never be shown
  std::unique_ptr<Presenter> presenter;
  std::unique_ptr<OutputSink> sink;  // until there is a stage
  std::unique_ptr<LabelFont> font;
  std::unique_ptr<Overlay> words;
  std::unique_ptr<Stage> stage;
  PanelOutcome state;
  TimestampNs tried = -1, painted = -1;
  bool closed = false;  ///< by whoever sat before it
  bool damaged = false;

  void take_down() {
    if (presenter) static_cast<void>(presenter->make_current());
    stage.reset();
    words.reset();
    font.reset();
    sink.reset();
    presenter.reset();
  }
  ~Panel() { take_down(); }
};

SidePanels::SidePanels(const ViewOptions& session, Presenter& main)
    : session_{session.window.has_value(), session.time.fps > 0, session.guide != nullptr}, main_(main) {
  std::size_t number = 2;
  for (const SidePanelOptions& given : session.also) {
    panels_.push_back(std::make_unique<Panel>(given, session, number++));
    panels_.back()->state.trouble = given.problem;
  }
}

void SidePanels::begin(const ViewOptions& session) {
  session_ = {session.window.has_value(), session.time.fps > 0, session.guide != nullptr};
  for (const auto& panel : panels_) {
    const StageOptions had = std::exchange(panel->options.stage, session.stage);
    StageOptions& now = panel->options.stage;
    now.display = had.display;
    now.catalog = had.catalog;
    now.screen = had.screen;
    now.stereo_window = had.stereo_window;
  }
}

SidePanels::~SidePanels() {
  panels_.clear();
  static_cast<void>(main_.make_current());
}

void SidePanels::fails(Panel& panel, const Error& error, TimestampNs now) {
  panel.take_down();
  panel.tried = now;
  if (panel.state.trouble != error.message) log_warning("{}: {}; the session goes on", panel.name, error.message);
  panel.state.trouble = error.message;
}

/// Its window; the surface comes with the first picture.
void SidePanels::open(Panel& panel) {
  const TimestampNs now = panel.tried;
  const auto opened = [&]() -> Result<void> {
    if (!panel.options.window) {
      DUBSAR_ASSIGN(panel.presenter, FilePresenter::create());
      return {};
    }
    ViewOptions options = panel.options;  // of which the window says more
    std::string note;
    DUBSAR_ASSIGN(panel.presenter, WindowPresenter::create(options, panel.sink, note));
    panel.options.stage = options.stage;
    if (!note.empty()) log_warning("{}: {}", panel.name, note);
    hear(panel);
    return {};
  }();
  if (!opened) return fails(panel, opened.error(), now);
  if (!panel.state.trouble.empty()) log_info("{} is there", panel.name);
  panel.state.trouble.clear();
}

/// Who types is heard, whichever window has the keys.
void SidePanels::hear(Panel& panel) {
  GlfwWindow* const window = panel.presenter->window();
  window->on_event([this, window](const WindowEvent& event) {
    if (event.kind == WindowEvent::Kind::kKey && viewer_ != nullptr)
      viewer_->handle(to_input_event(event, window->size()));
  });
}

Result<void> SidePanels::place(Panel& panel) {
  DUBSAR_TRY(panel.stage->set_screen(panel.presenter->screen(panel.options.stage.screen)));
  DUBSAR_TRY(panel.presenter->fit(panel.stage->traits()));
  if (GlfwWindow* const window = panel.presenter->window()) window->wait_for_monitor(false);  // the main one paces
  return {};
}

Result<void> SidePanels::make_stage(Panel& panel, const Viewer& viewer) {
  if (!panel.font) {
    DUBSAR_ASSIGN(panel.font, LabelFont::create(panel_font()));
  }
  DUBSAR_ASSIGN(panel.stage, Stage::create(viewer.mesh(), panel.options.stage, std::move(panel.sink)));
  return place(panel);
}

/// Monitors that went and came, windows that were closed.
void SidePanels::look_after(Panel& panel, TimestampNs now) {
  const bool real = session_.windows && !session_.simulated;
  if (panel.presenter && panel.presenter->ended()) {
    panel.presenter->keep_open();
    if (!session_.led) {
      panel.closed = true;
      panel.take_down();
    }
  }
  const std::string& monitor = panel.options.window ? panel.options.window->monitor : std::string();
  if (panel.presenter && real && !monitor.empty() && looked_ == now) {
    const auto monitors = list_monitors();
    if (!monitors || std::none_of(monitors->begin(), monitors->end(),
                                  [&](const Monitor& one) { return one.name.find(monitor) != std::string::npos; }))
      fails(panel, {ErrorKind::kUnavailable, fmt::format("its monitor \"{}\" is gone", monitor)}, now);
  }
  if (panel.presenter || panel.closed || !panel.out.empty()) return;
  if (panel.tried >= 0 && (!real || now - panel.tried < kTryEveryNs)) return;
  panel.tried = now;
  open(panel);
}

Result<void> SidePanels::paint(Panel& panel, const std::string& file) {
  DUBSAR_TRY(panel.presenter->make_current());
  DUBSAR_TRY(panel.stage->paint(panel.presenter->surface(), panel.presenter->turn()));
  ++panel.state.frames;
  panel.damaged = false;
  if (!file.empty()) {
    DUBSAR_ASSIGN(const Image picture, panel.presenter->picture());
    DUBSAR_TRY(write_png(file + std::string(panel.stage->traits().file_suffix) + ".png", picture));
  }
  return panel.presenter->present();
}

Result<void> SidePanels::follow(Viewer& viewer, TimestampNs now, const std::string& frame) {
  if (panels_.empty()) return {};
  viewer_ = &viewer;
  auto done = follow_all(viewer, now, frame);
  DUBSAR_TRY(main_.make_current());
  return done;
}

/// Sentences and buttons of whoever leads the session, as large as the reader needs them here.
Result<void> SidePanels::say(Panel& panel, const Viewer& viewer) {
  if (!viewer.guidance().picture) return {};
  if (!panel.words) {
    DUBSAR_ASSIGN(panel.words, Overlay::create(viewer.keys()));
  }
  const glm::dvec2 window = panel.stage->window_mm();
  OverlayText text;
  text.gallery = gallery_on(*viewer.guidance().picture, window.x / window.y);
  if (text == panel.words->text()) return {};
  panel.words->set(std::move(text));
  panel.stage->set_overlay(panel.words.get());
  return {};
}

/// Whether it has something to paint.
Result<bool> SidePanels::show(Panel& panel, const Viewer& viewer, TimestampNs now) {
  DUBSAR_TRY(panel.presenter->make_current());
  if (!panel.stage) DUBSAR_TRY(make_stage(panel, viewer));
  if (panel.presenter->take_place_changed()) DUBSAR_TRY(place(panel));
  panel.damaged = panel.presenter->take_damaged() || panel.damaged;
  const Stage &main = viewer.stage(), &stage = *panel.stage;
  const auto plane = [&](const Stage& of) {
    return PanelPlane{of.window_mm(), of.middle_mm(), of.traits().view.height, panel.font.get()};
  };
  panel.stage->show(shown_on(main.shown(), plane(main), plane(stage)), FollowedEyes(), now);
  DUBSAR_TRY(say(panel, viewer));
  return panel.damaged || stage.needs_paint();
}

Result<void> SidePanels::follow_all(Viewer& viewer, TimestampNs now, const std::string& frame) {
  if (looked_ < 0 || now - looked_ >= kTryEveryNs) looked_ = now;
  const bool all = session_.simulated || !frame.empty();
  Panel* next = nullptr;
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    Panel& panel = *panels_[i];
    look_after(panel, now);
    if (!panel.presenter || !viewer.has_surface()) continue;
    const auto due = show(panel, viewer, now);
    if (!due) {
      fails(panel, due.error(), now);
    } else if (!panel.presenter->visible() || (!*due && frame.empty())) {
      continue;
    } else if (!all) {
      if (next == nullptr || panel.painted < next->painted) next = &panel;
    } else if (auto done = paint(panel, frame.empty() ? frame : fmt::format("{}-{}", frame, i + 2)); !done) {
      if (!frame.empty()) return done;
      fails(panel, done.error(), now);
    }
  }
  if (next == nullptr) return {};
  next->painted = now;
  if (const auto done = paint(*next, {}); !done) fails(*next, done.error(), now);
  return {};
}

void SidePanels::drop_surface() {
  viewer_ = nullptr;
  for (const auto& panel : panels_) {
    if (!panel->stage) continue;
    static_cast<void>(panel->presenter->make_current());
    panel->stage.reset();
    panel->words.reset();  // it knows the session's keys
  }
  if (!panels_.empty()) static_cast<void>(main_.make_current());
}

void SidePanels::look_after() {
  for (const auto& panel : panels_)
    if (panel->presenter) panel->presenter->look_after(false);
}

bool SidePanels::focused() const {
  return std::any_of(panels_.begin(), panels_.end(), [](const auto& panel) {
    return panel->options.window && panel->presenter && panel->presenter->focused();
  });
}

bool SidePanels::need_paint() const {
  return std::any_of(panels_.begin(), panels_.end(), [](const auto& panel) {
    return panel->stage && (panel->damaged || panel->stage->needs_paint()) && panel->presenter->visible();
  });
}

std::vector<PanelOutcome> SidePanels::states() const {
  std::vector<PanelOutcome> out;
  for (const auto& panel : panels_) out.push_back(panel->state);
  return out;
}

std::string SidePanels::trouble() const {
  std::string out;
  for (const auto& panel : panels_)
    if (!panel->state.trouble.empty())
      out += (out.empty() ? "" : "; ") + tr("say.panel_trouble", panel->name, panel->state.trouble);
  return out;
}

}  // namespace dubsar::app
