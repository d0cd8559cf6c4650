// What stands over the pictures of a session.

#include <algorithm>
#include <glm/geometric.hpp>

#include "app/commands/sides.h"
#include "app/panels/state_page.h"
#include "app/stage/marks.h"
#include "app/viewer/first_document.h"
#include "app/viewer/viewer.h"
#include "core/base/system/second.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kBallNs = kSecondNs;  // after the light has moved
constexpr TimestampNs kNoticeNs = 6 * kSecondNs, kFadeNs = kSecondNs, kHelpRefreshNs = kSecondNs / 2;

}  // namespace

/// What somebody said, else the desktop; 0: neither, what suits the window.
double Viewer::ui_scale() const {
  if (desk().ui_scale > 0) return desk().ui_scale;
  const GlfwWindow* const window = given_.presenter.window();
  const double wanted = window != nullptr ? window->content_scale() : 1.0;
  return wanted > 1.01 ? wanted : 0.0;
}

/// Pixels of the panels' layout.
glm::dvec2 Viewer::layout() const {
  return Overlay::layout(stage_->traits().view.height, stage_->window_mm(), ui_scale());
}

/// Letters on the surface are as large as those of the panels, and never smaller than on a plain monitor.
/// What a gallery writes on the surface is read from where its sentences are read.
double Viewer::letters_scale() const {
  const double height = stage_->traits().view.height, plain = std::max(1.0, height / layout().y);
  if (!at_.guidance.picture) return plain;
  const double size = letters_size(at_.guidance.picture->letter_mm, height, height / stage_->window_mm().y);
  return std::max(plain, size / kMarkLettersPx);
}

std::string Viewer::title() const {
  return title_words(has_surface() ? given_.options.around.title : std::string(),
                     given_.shelf != nullptr ? given_.shelf->opening() : std::nullopt);
}

PanelState Viewer::panel_state(TimestampNs now) {
  PanelState out;
  out.line = {
      title().empty() ? "dubsar" : title(), display(),
      has_surface()
          ? std::string(
                kSideNames[static_cast<std::size_t>(facing_side(report_.view.rotation, document().home.rotation))])
          : std::string(),
      editor_->history().undo_words(), editor_->history().redo_words()};
  out.document = document();
  out.desk = desk();
  out.desk.beside.reset();
  out.desk.pointing.at.reset();  // it moves, and nothing here shows it
  out.evidence = tools_.evidence.of(visible_partitions(document()));
  out.files = files_state(now);
  if (shows_slices()) out.slices = tools_.slices->state();
  out.playing = at_.film_since >= 0;
  const glm::dvec2 window = stage_->window_mm();
  const double scale =
      glm::length(glm::dvec3(stage_->screen_from_model()[0]));  // of the screen for one mm of the object
  out.mm_per_px = window.y / (layout().y * scale);
  out.faint = report_.control == Control::kMouse || report_.control == Control::kHands;
  return out;
}

/// One at a time, while nothing else moves.
void Viewer::add_thumbnails(PanelState& panels) {
  const bool rests = !report_.moving && at_.film_since < 0 && !panels.faint;
  panels.thumbnails = tools_.thumbnails.of(document().keyframes, *stage_, rests, [&](const Keyframe& key) {
    Document seen = document();
    show_keyframe(seen, key);
    return shown_of(seen, view_of(seen), given_.options.stage, stage_->box_mm());
  });
  panels.thumbnail_aspect = stage_->window_mm().x / stage_->window_mm().y;
}

void Viewer::update_overlay(TimestampNs now, const RecentFigures& figures) {
  OverlayText text = overlay_->text();
  if (!desk().help) {
    text.help.clear();
  } else if (at_.help_made < 0 || now - at_.help_made >= kHelpRefreshNs) {
    StateFigures state;
    state.display = display();
    state.traits = stage_->traits();
    state.head = report_.head;
    state.eyes_mm = report_.viewer.centre_mm();
    state.interval_ms = figures.interval_ms;
    state.input_age_ms = figures.input_age_ms;
    state.sources = sources();
    text.help = state_page(state);
    HelpDevices there{false, state.traits.views == 2 || state.traits.fields == 2};
    for (const SourceRow& row : state.sources) {
      if (row.health != SourceHealth::kPresent || row.spec == "mouse" || row.spec == "keyboard") continue;
      (is_touch_panel(row) ? there.touch : there.more) = true;
    }
    for (HelpSection& section : help_page(given_.options.mapping, *said_.keys, there))
      text.help.push_back(std::move(section));
    at_.help_made = now;
  }
  text.gallery = at_.guidance.picture;
  text.panels.reset();
  const bool files = desk().choosing.open || (given_.shelf != nullptr && given_.shelf->busy());
  if ((desk().panels || desk().palette || files) && !desk().help) text.panels = panel_state(now);
  if (text.panels && desk().drawer == "film") add_thumbnails(*text.panels);
  text.legend = desk().legend && has_surface() && !stage_->measuring()
                    ? legend_of(shown_of(document(), report_.view, given_.options.stage, stage_->box_mm()).style)
                    : std::nullopt;
  text.light.reset();
  if (given_.options.around.notices && at_.light_moved >= 0 && now - at_.light_moved < kBallNs)
    text.light = LightPlace{report_.view.light_azimuth_deg, report_.view.light_elevation_deg};
  text.box = box_picture();
  const TimestampNs age = now - notice_.since;
  if (notice_.since < 0 || age >= kNoticeNs) {
    text.notice.clear();
    text.notice_opacity = 1.0;
  } else {
    text.notice = notice_.text;
    text.notice_opacity = std::clamp(static_cast<double>(kNoticeNs - age) / static_cast<double>(kFadeNs), 0.0, 1.0);
  }
  if (const auto share = stage_->measuring()) {
    const std::string measuring = fmt::format("measuring the surface: {:.0f} %", 100.0 * *share);
    text.notice = text.notice.empty() ? measuring : fmt::format("{} ({})", text.notice, measuring);
    text.notice_opacity = 1.0;
  }
  overlay_->set_scale(ui_scale());
  if (text == overlay_->text()) return;
  overlay_->set(std::move(text));
  stage_->set_overlay(overlay_->text().empty() ? nullptr : overlay_.get());
}

}  // namespace dubsar::app
