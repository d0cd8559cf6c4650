#include "app/calibration/adjust_window.h"

#include "display/panels/calibration.h"
#include "display/panels/panel_adjust.h"

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

KeyAnswer LensTuner::key(const std::string& name) {
  const Figures before = now_;
  if (name == "left" || name == "right") {
    now_.center += name == "left" ? -kCentreStep : kCentreStep;
  } else if (name == "up" || name == "down") {
    now_.pitch *= name == "up" ? 1.0 + kPitchStep : 1.0 - kPitchStep;
  } else if (name == "page_up" || name == "page_down") {
    now_.slope *= name == "page_up" ? 1.0 + kSlopeStep : 1.0 - kSlopeStep;
  } else if (name == "0") {
    now_ = first_;
  } else if (name == "s") {
    const auto file = save_adjustment(folder_, panel_, {now_.pitch, now_.slope, now_.center});
    if (!file) return {.taken = true, .notice = file.error().message};
    saved_ = true;
    file_ = *file;
    return {.taken = true, .notice = fmt::format("saved: {}", text())};
  } else {
    return {};
  }
  if (const auto done = use(); !done) {
    now_ = before;
    return {.taken = true, .notice = done.error().message};
  }
  return {.taken = true, .display_changed = true, .notice = text()};
}

}  // namespace dubsar::app
