#include "app/calibration/adjust_window.h"

#include <system_error>

#include "display/panels/panel_adjust.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr double kCentreStep = 0.01;  // of a lens
constexpr double kPitchStep = 5e-5;   // of the pitch: about a tenth of a view over a panel
constexpr double kSlopeStep = 2e-3;   // of the slope

}  // namespace

Result<LensTuner> LensTuner::create(const fs::path& folder, const fs::path& scratch, const std::string& panel,
                                    const fs::path& calibration) {
  LensTuner out;
  out.folder_ = folder;
  out.scratch_ = scratch;
  std::error_code error;
  const bool has_own = fs::is_directory(folder, error);
  error.clear();  // a folder that is not there yet
  if (has_own) fs::copy(folder, scratch, fs::copy_options::overwrite_existing, error);
  if (error) return fail(ErrorKind::kIo, "cannot copy the profiles of {}: {}", folder.string(), error.message());
  DUBSAR_ASSIGN(const PanelProfile profile, choose_panel(folder, panel, calibration.string()));
  out.panel_ = profile.name;
  if (profile.optics) {
    out.first_ = {profile.optics->pitch_mm, profile.optics->tan_slant, profile.optics->phase0};
  } else if (profile.sheet) {
    out.first_ = {profile.sheet->pitch, profile.sheet->slope, profile.sheet->center};
  } else {
    return fail(ErrorKind::kConfig, "adjustment of panel {}: it has no lens figures to start from", panel);
  }
  out.now_ = out.first_;
  return out;
}

std::string LensTuner::text() const {
  return fmt::format("pitch={:.7g},slope={:.6g},center={:.4f}", now_.pitch, now_.slope, now_.center);
}

Result<void> LensTuner::use() {
  DUBSAR_TRY(save_adjustment(scratch_, panel_, {now_.pitch, now_.slope, now_.center}));
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
