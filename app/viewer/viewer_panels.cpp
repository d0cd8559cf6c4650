// What stands over the pictures of a session.

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "app/commands/sides.h"
#include "app/document/join.h"
#include "app/panels/slice_panel.h"
#include "app/panels/state_page.h"
#include "app/stage/marks.h"
#include "app/viewer/viewer.h"
#include "app/words/language.h"
#include "core/base/files/kept_file.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kBallNs = kSecondNs;  // after the light has moved
constexpr TimestampNs kNoticeNs = 6 * kSecondNs, kFadeNs = kSecondNs, kHelpRefreshNs = kSecondNs / 2;

OtherWorkRow row_of(const OtherWork& other, const Document& mine) {
  const Document& theirs = other.work.document;
  return {set_aside_day(other.file), std::filesystem::path(theirs.source.path).filename().string(),
          marks_more(Document(), add_marks(Document(), theirs)), marks_more(mine, add_marks(mine, theirs)).empty()};
}

/// What somebody said, else the desktop; 0: neither, what suits the window.
double ui_scale(const UiState& ui, const GlfwWindow* window) {
  if (ui.ui_scale > 0) return ui.ui_scale;
  const double wanted = window != nullptr ? window->content_scale() : 1.0;
  return wanted > 1.01 ? wanted : 0.0;
}

}  // namespace

void Viewer::say(std::string text) {
  if (!options_.around.notices) return;
  present_.words.notice = std::move(text);
  present_.words.since = given_.clock.now();
}

/// Pixels of the panels' layout, and how large letters on the surface are: as those of the panels, and never smaller
/// than on a plain monitor; what a gallery writes on the surface is read from where its sentences are read.
void Viewer::measure_window() {
  const double height = stage_->traits().view.height, scale = ui_scale(ui(), given_.presenter.window());
  const glm::dvec2 mm = stage_->window_mm();
  ToolWindow& window = scene_.window;
  window.layout = Overlay::layout(stage_->traits().view.height, mm, scale);
  window.letters = std::max(1.0, height / window.layout.y);
  if (present_.led.guidance.picture)
    window.letters = std::max(
        window.letters, letters_size(present_.led.guidance.picture->letter_mm, height, height / mm.y) / kMarkLettersPx);
  window.slices =
      slice_rects(static_cast<float>(window.layout.x), static_cast<float>(window.layout.y), document().scan.large);
  overlay_->set_scale(scale);
}

PanelState Viewer::panel_state(TimestampNs now) {
  PanelState out;
  out.line.title = title().empty() ? "dubsar" : title();
  out.line.display = display();
  out.line.language = language().code();
  if (has_surface())
    out.line.side =
        kSideNames[static_cast<std::size_t>(facing_side(present_.report.view.rotation, document().home.rotation))];
  out.line.undo = editor_->history().undo_words();
  out.line.redo = editor_->history().redo_words();
  out.document = document();
  out.ui = ui();
  out.ui.compared.reset();
  out.ui.pointing.at.reset();  // it moves, and nothing here shows it
  out.evidence = known_.evidence.of(visible_partitions(document()));
  out.files = files_.list.state(ui().choosing, has_surface(), now);
  if (!out.files.opening) out.files.opening = tools_->companion.opening();
  if (tools_->slices.shown()) out.slices = slices();
  out.finding = known_.wedges.state();
  out.exporting = known_.exporter.state();
  out.playing = known_.film.playing();
  const glm::dvec2 window = stage_->window_mm();
  const double scale =
      glm::length(glm::dvec3(stage_->screen_from_model()[0]));  // of the screen for one mm of the object
  out.mm_per_px = window.y / (scene_.window.layout.y * scale);
  out.faint = present_.report.control == Control::kMouse || present_.report.control == Control::kHands;
  if (ui().drawer == "files")
    for (const OtherWork& other : editor_->others()) out.others.push_back(row_of(other, document()));
  if (ui().drawer != "film") return out;
  // One at a time, while nothing else moves.
  const bool rests = !present_.report.moving && !out.playing && !out.faint;
  out.thumbnails = known_.thumbnails.of(document().keyframes, *stage_, rests, [&](const Keyframe& key) {
    Document seen = document();
    show_keyframe(seen, key);
    return scene_.shown(seen, view_of(seen));
  });
  out.thumbnail_aspect = window.x / window.y;
  return out;
}

/// The pages of help, twice a second.
void Viewer::tell_help(OverlayText& text, TimestampNs now) {
  if (!ui().help) return text.help.clear();
  if (present_.words.help_made >= 0 && now - present_.words.help_made < kHelpRefreshNs) return;
  StateFigures state;
  state.display = display();
  state.traits = stage_->traits();
  state.head = present_.report.head;
  state.eyes_mm = present_.report.viewer.centre_mm();
  state.interval_ms = present_.words.figures.interval_ms;
  state.input_age_ms = present_.words.figures.input_age_ms;
  state.sources = sources();
  text.help = state_page(state);
  HelpDevices there{false, state.traits.views == 2 || state.traits.fields == 2};
  for (const SourceRow& row : state.sources) {
    if (row.health != SourceHealth::kPresent || row.spec == "mouse" || row.spec == "keyboard") continue;
    (is_touch_panel(row) ? there.touch : there.more) = true;
  }
  for (HelpSection& section : help_page(options_.mapping, keys(), there)) text.help.push_back(std::move(section));
  present_.words.help_made = now;
}

void Viewer::update_overlay(TimestampNs now) {
  present_.words.behind = false;
  OverlayText text = overlay_->text();
  tell_help(text, now);
  text.gallery = present_.led.guidance.picture;
  text.panels.reset();
  const bool files = ui().choosing.open || opening();
  if ((ui().panels || ui().palette || files) && !ui().help) text.panels = panel_state(now);
  text.legend = ui().legend && has_surface() && !stage_->measuring()
                    ? legend_of(stage_->shown().style, stage_->difference())
                    : std::nullopt;
  text.light.reset();
  const TimestampNs moved = tools_->light.moved();
  if (options_.around.notices && moved >= 0 && now - moved < kBallNs)
    text.light = LightPlace{present_.report.view.light_azimuth_deg, present_.report.view.light_elevation_deg};
  text.box = tools_->box.picture();
  const TimestampNs age = now - present_.words.since;
  const bool over = present_.words.since < 0 || age >= kNoticeNs;
  text.notice = over ? std::string() : present_.words.notice;
  text.notice_opacity =
      over ? 1.0 : std::clamp(static_cast<double>(kNoticeNs - age) / static_cast<double>(kFadeNs), 0.0, 1.0);
  if (const auto share = stage_->measuring()) {
    const std::string measuring = tr("say.measuring", fmt::format("{:.0f}", 100.0 * *share));
    text.notice = text.notice.empty() ? measuring : fmt::format("{} ({})", text.notice, measuring);
    text.notice_opacity = 1.0;
  }
  if (text == overlay_->text()) return;
  overlay_->set(std::move(text));
  stage_->set_overlay(overlay_->text().empty() ? nullptr : overlay_.get());
}

}  // namespace dubsar::app
