#include "app/calibration/adjust_window.h"

#include "display/panels/panel_adjust.h"
#include "display/panels/panel_calibration.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr double kCentreStep = 0.01;  // of a lens
constexpr double kPitchStep = 5e-5;   // of the pitch: about a tenth of a view over a panel
constexpr double kSlopeStep = 2e-3;   // of the slope

}  // namespace

Result<LensTuner> LensTuner::create(std::shared_ptr<SinkCatalog> catalog, const fs::path& folder,
                                    const std::string& panel, const fs::path& calibration) {
  LensTuner out;
  DUBSAR_ASSIGN(out.panel_, choose_panel(catalog->panels(), panel, calibration));
  out.catalog_ = std::move(catalog);
  out.folder_ = folder;
  const PanelProfile& profile = out.panel_;
  if (profile.optics) {
    out.first_ = {profile.optics->pitch_mm, profile.optics->tan_slant, profile.optics->phase0};
  } else if (profile.sheet) {
    out.first_ = {profile.sheet->pitch, profile.sheet->slope, profile.sheet->center};
  } else {
    return fail(ErrorKind::kConfig, "adjustment of panel {}: it has no lens figures to start from", panel);
  }
  out.now_ = out.first_;
  DUBSAR_TRY(out.use());
  return out;
}

SinkSpec LensTuner::display() const { return {"lenticular", {{"panel", panel_.name}}}; }

std::string LensTuner::text() const {
  return fmt::format("pitch={:.7g},slope={:.6g},center={:.4f}", now_.pitch, now_.slope, now_.center);
}

Result<void> LensTuner::use() {
  PanelProfile changed = panel_;
  DUBSAR_TRY(apply_adjustment({now_.pitch, now_.slope, now_.center}, changed));
  catalog_->put(std::move(changed));
  return {};
}

Command LensTuner::step(std::string name, std::string key, std::function<void(Figures&)> change) {
  Command out{std::move(name), "group.panel", {{std::move(key)}}};
  out.repeats = true;
  out.run = [this, change = std::move(change)](Editor& editor, const std::string&) -> Result<void> {
    const Figures before = now_;
    change(now_);
    if (auto done = use(); !done) {
      now_ = before;
      return done;
    }
    DUBSAR_TRY(editor.place().switch_display(0));
    editor.place().say(text());
    return {};
  };
  return out;
}

Command LensTuner::save() {
  Command out{"panel_save", "group.panel", {{"s"}}};
  out.run = [this](Editor& editor, const std::string&) -> Result<void> {
    DUBSAR_ASSIGN(file_, save_adjustment(folder_, panel_, {now_.pitch, now_.slope, now_.center}));
    saved_ = true;
    editor.place().say(tr("say.saved", text()));
    return {};
  };
  return out;
}

std::vector<Command> LensTuner::commands() {
  return {step("panel_left", "left", [](Figures& f) { f.center -= kCentreStep; }),
          step("panel_right", "right", [](Figures& f) { f.center += kCentreStep; }),
          step("pitch_more", "up", [](Figures& f) { f.pitch *= 1.0 + kPitchStep; }),
          step("pitch_less", "down", [](Figures& f) { f.pitch *= 1.0 - kPitchStep; }),
          step("slope_more", "page_up", [](Figures& f) { f.slope *= 1.0 + kSlopeStep; }),
          step("slope_less", "page_down", [](Figures& f) { f.slope *= 1.0 - kSlopeStep; }),
          step("panel_reset", "0", [this](Figures& f) { f = first_; }),
          save()};
}

}  // namespace dubsar::app
