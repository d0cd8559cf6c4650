#include "display/panels/panel_calibration.h"

#include <algorithm>

#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"
#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"
#include "display/panels/lens_fields.h"
#include "display/panels/panel_adjust.h"

namespace dubsar {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t kMaxCalibrationBytes = 64 << 10;

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

/// The model by the longest serial prefix, else by size; null when none fits.
const PanelProfile* model_of(const PanelSet& panels, const PanelCalibration& calibration) {
  const PanelProfile* best = nullptr;
  for (const PanelProfile& profile : panels.profiles)
    if (!profile.marks.serial_prefix.empty() && calibration.serial.starts_with(profile.marks.serial_prefix) &&
        (best == nullptr || profile.marks.serial_prefix.size() > best->marks.serial_prefix.size()))
      best = &profile;
  if (best != nullptr) return best;
  for (const PanelProfile& profile : panels.profiles)
    if (profile.kind == PanelKind::kLookingGlass && profile.width_px == calibration.figures.screen_width &&
        profile.height_px == calibration.figures.screen_height)
      return &profile;
  return nullptr;
}

}  // namespace

Result<PanelCalibration> parse_calibration(std::string_view json_text, std::string_view source) {
  if (json_text.size() > kMaxCalibrationBytes)
    return fail(ErrorKind::kConfig, "calibration {}: {} bytes, expected at most 64 KiB", source, json_text.size());
  const auto parsed = parse_json(json_text, fmt::format("calibration {}", source));
  if (!parsed) return fail(ErrorKind::kConfig, "{}", parsed.error().message);
  const json& object = *parsed;
  if (!object.is_object())
    return fail(ErrorKind::kConfig, "calibration {}: {} found, expected an object", source, object.type_name());
  PanelCalibration calibration;
  calibration.source = source;
  JsonFields fields(object, fmt::format("calibration {}", source));
  LookingGlassFigures& sheet = calibration.figures;
  read_lens_figures(fields, sheet, "invView", fields.has("cellPatternMode") ? "cellPatternMode" : "CellPatternMode");
  sheet.dpi = fields.number("DPI", 10.0, 2000.0);
  sheet.screen_width = fields.integer("screenW", 1, kMostPanelPx);
  sheet.screen_height = fields.integer("screenH", 1, kMostPanelPx);
  sheet.flip_image_x = fields.flag("flipImageX", false);
  if (fields.flag("flipImageY", false))
    log_warning("calibration {}: flipImageY is 1, which is not followed: the picture may stand on its head", source);
  sheet.flip_subpixels = fields.flag("flipSubp", false);
  const double forty = 40.0;
  calibration.view_cone_deg = fields.number("viewCone", 1.0, 170.0, &forty);
  if (fields.has("subpixelCells")) read_lens_cells(object.at("subpixelCells"), fields, sheet);
  calibration.serial = fields.text("serial", "");
  if (!printable(calibration.serial)) fields.complain("serial has letters that cannot be printed, expected ASCII");
  DUBSAR_TRY(fields.finish());
  return calibration;
}

Result<PanelCalibration> read_calibration(const fs::path& file) {
  const auto text = read_text_file(file, static_cast<std::int64_t>(kMaxCalibrationBytes));
  if (!text && text.error().kind == ErrorKind::kBadData)
    return fail(ErrorKind::kConfig, "calibration {}: {}", file.string(), text.error().message);
  if (!text) return tl::unexpected<Error>(text.error());
  return parse_calibration(*text, file.string());
}

Result<PanelProfile> calibrated_profile(const PanelSet& panels, const PanelCalibration& calibration,
                                        std::string_view model) {
  const LookingGlassFigures& figures = calibration.figures;
  PanelProfile profile;
  if (!model.empty()) {
    DUBSAR_ASSIGN(profile, panels.find(model));
    if (profile.kind == PanelKind::kTracked)
      return fail(ErrorKind::kConfig, "calibration {}: panel {} is a tracked panel, expected one with many views",
                  calibration.source, model);
  } else if (const PanelProfile* const best = model_of(panels, calibration); best != nullptr) {
    profile = *best;
  } else {
    return fail(ErrorKind::kConfig,
                "calibration {}: serial \"{}\" and {}x{} pixels match no known model; name one with panel=",
                calibration.source, calibration.serial, figures.screen_width, figures.screen_height);
  }
  profile.sheet = figures;
  profile.width_px = figures.screen_width;
  profile.height_px = figures.screen_height;
  profile.width_mm = figures.screen_width / figures.dpi * kMmPerInch;
  profile.aspect = static_cast<double>(figures.screen_width) / figures.screen_height;
  profile.zone.cone_deg = calibration.view_cone_deg;
  profile.lenses.calibration = calibration.source;
  DUBSAR_TRY(apply_adjustment(profile.lenses.adjustment, profile));
  return profile;
}

Result<PanelProfile> choose_panel(const PanelSet& panels, std::string_view name, const fs::path& calibration_file) {
  if (calibration_file.empty()) return panels.find(name);
  DUBSAR_ASSIGN(const PanelCalibration calibration, read_calibration(calibration_file));
  return calibrated_profile(panels, calibration, name);
}

std::vector<fs::path> find_calibration_files(std::span<const fs::path> roots) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const fs::path& root : roots)
    for (const auto& mount : fs::directory_iterator(root, fs::directory_options::skip_permission_denied, ignored)) {
      const fs::path file = mount.path() / "LKG_calibration" / "visual.json";
      if (fs::is_regular_file(file, ignored)) found.push_back(file);
    }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace dubsar
