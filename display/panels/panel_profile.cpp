#include "display/panels/panel_profile.h"

#include <algorithm>
#include <numbers>

#include "core/base/atomic_file.h"
#include "core/base/json_fields.h"
#include "core/base/json_text.h"
#include "core/base/log.h"
#include "display/optics/optics.h"
#include "display/panels/embedded_profiles.h"
#include "display/panels/panel_adjust.h"

namespace dubsar {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int kMaxSide = 16384;
constexpr double kMmPerInch = 25.4;
constexpr double kFieldOfViewDeg = 14.0;  // a Looking Glass Portrait at 36 inches
constexpr std::int64_t kMaxCalibrationBytes = 64 << 10;
constexpr std::size_t kMaxCells = 10;  // the vendor's shaders hold 60 floats

/// A wrong profile or calibration is a wrong configuration, whatever is wrong with it.
Result<json> parse_config(std::string_view text, std::string_view source) {
  auto parsed = parse_json(text, source);
  if (!parsed) return fail(ErrorKind::kConfig, "{}", parsed.error().message);
  return parsed;
}

/// The fields that sheets have in profiles and in calibrations, under their respective names.
void read_sheet(JsonFields& fields, LookingGlassFigures& sheet, const char* invert_name, const char* pattern_name) {
  sheet.pitch = fields.number("pitch", kLeastPitch, kMostPitch);
  sheet.slope = fields.number("slope", -kMostSlope, kMostSlope);
  if (std::abs(sheet.slope) < kLeastSlope)
    fields.complain(fmt::format("slope is {}, expected {} or more, of either sign", sheet.slope, kLeastSlope));
  const double zero = 0.0;
  sheet.center = fields.number("center", -kMostCentre, kMostCentre, &zero);
  sheet.invert_views = fields.flag(invert_name, true);
  const int uniform = 0;
  sheet.pattern = static_cast<CellPattern>(fields.integer(pattern_name, 0, 4, &uniform));
}

void read_cells(const json& cells, JsonFields& fields, LookingGlassFigures& sheet) {
  if (!cells.is_array() || cells.size() > kMaxCells) {
    fields.complain(fmt::format("subpixel cells: expected an array of at most {}", kMaxCells));
    return;
  }
  for (const json& entry : cells) {
    SubpixelCell cell;
    JsonFields cell_fields(entry, "subpixel cell");
    static constexpr const char* kNames[3][2] = {
        {"ROffsetX", "ROffsetY"}, {"GOffsetX", "GOffsetY"}, {"BOffsetX", "BOffsetY"}};
    static constexpr const char* kShort[3] = {"R", "G", "B"};
    for (std::size_t k = 0; k < 3; ++k) {
      if (entry.is_object() && entry.contains(kShort[k]) && entry[kShort[k]].is_array() &&
          entry[kShort[k]].size() == 2 && entry[kShort[k]][0].is_number() && entry[kShort[k]][1].is_number()) {
        cell.offset_px[k] = {entry[kShort[k]][0].get<double>(), entry[kShort[k]][1].get<double>()};
      } else {
        cell.offset_px[k] = {cell_fields.number(kNames[k][0], -2.0, 2.0), cell_fields.number(kNames[k][1], -2.0, 2.0)};
      }
    }
    if (auto ok = cell_fields.finish(); !ok) fields.complain(ok.error().message);
    sheet.cells.push_back(cell);
  }
}

void read_edids(const json& list, JsonFields& fields, PanelProfile& profile) {
  constexpr int kMostProduct = 65535;
  for (const json& entry : list) {
    if (!list.is_array() || !entry.is_array() || entry.size() != 2 || !entry[0].is_string() ||
        entry[0].get_ref<const std::string&>().size() != 3 || !entry[1].is_number_integer() || entry[1] < 0 ||
        entry[1] > kMostProduct)
      return fields.complain(
          fmt::format("edid: expected pairs of a manufacturer's three letters and a product of 0 to {}", kMostProduct));
    profile.edids.push_back({entry[0].get<std::string>(), entry[1].get<int>()});
  }
}

Result<PanelProfile> parse_profile(const json& object, std::string_view source) {
  PanelProfile profile;
  JsonFields fields(object, fmt::format("panel profile in {}", source));
  if (!object.is_object()) fields.complain("expected an object");
  profile.name = fields.text("name", nullptr);
  if (!profile.name.empty()) fields = JsonFields(object, fmt::format("panel profile {} in {}", profile.name, source));
  profile.title = fields.text("title", profile.name.c_str());
  profile.note = fields.text("note", "");
  const std::string kind = fields.text("kind", nullptr);
  if (kind == "looking_glass")
    profile.kind = PanelKind::kLookingGlass;
  else if (kind == "lens_sheet")
    profile.kind = PanelKind::kLensSheet;
  else if (kind == "tracked")
    profile.kind = PanelKind::kTracked;
  else
    fields.complain(fmt::format("kind is \"{}\", expected looking_glass, lens_sheet or tracked", kind));
  profile.width_px = fields.integer("width_px", 1, kMaxSide);
  profile.height_px = fields.integer("height_px", 1, kMaxSide);
  const double no_dpi = 0.0;
  const double dpi = fields.number("dpi", 10.0, 2000.0, &no_dpi);
  const double from_dpi = dpi > 0.0 ? profile.width_px / dpi * kMmPerInch : 0.0;
  profile.width_mm = fields.number("width_mm", 10.0, 10000.0, dpi > 0.0 ? &from_dpi : nullptr);
  const double square_pixels = static_cast<double>(profile.width_px) / std::max(1, profile.height_px);
  profile.aspect = fields.number("aspect", 0.1, 10.0, &square_pixels);

  if (profile.kind != PanelKind::kTracked) {
    profile.view_cone_deg = fields.number("view_cone_deg", 1.0, 170.0);
    if (fields.has("lens")) {
      LookingGlassFigures sheet;
      JsonFields lens(object.at("lens"), fmt::format("panel profile {} in {}: lens", profile.name, source));
      read_sheet(lens, sheet, "invert_views", "cell_pattern");
      sheet.flip_image_x = lens.flag("flip_image_x", false);
      sheet.flip_subpixels = lens.flag("flip_subpixels", false);
      if (lens.has("cells")) read_cells(object.at("lens").at("cells"), lens, sheet);
      DUBSAR_TRY(lens.finish());
      sheet.dpi = dpi > 0.0 ? dpi : profile.width_px / profile.width_mm * kMmPerInch;
      sheet.screen_width = profile.width_px;
      sheet.screen_height = profile.height_px;
      profile.sheet = sheet;
    }
  }
  if (profile.kind == PanelKind::kLookingGlass) {
    const json quilt_object = object.value("quilt", json::object());
    JsonFields quilt(quilt_object, fmt::format("panel profile {} in {}: quilt", profile.name, source));
    profile.quilt = {quilt.integer("columns", 1, 32), quilt.integer("rows", 1, 32),
                     quilt.integer("width_px", 1, kMaxSide), quilt.integer("height_px", 1, kMaxSide)};
    DUBSAR_TRY(quilt.finish());
    profile.views = profile.quilt.views();
  } else if (profile.kind == PanelKind::kLensSheet) {
    profile.views = fields.integer("views", 2, 512);
  } else {
    const json optics_object = object.value("optics", json::object());
    JsonFields optics(optics_object, fmt::format("panel profile {} in {}: optics", profile.name, source));
    LensOptics lens;
    lens.pitch_mm = optics.number("pitch_mm", 0.01, 10.0);
    lens.tan_slant = optics.number("tan_slant", -10.0, 10.0);
    lens.reduced_gap_mm = optics.number("reduced_gap_mm", 0.01, 50.0);
    lens.refractive_index = optics.number("refractive_index", 1.0, 3.0);
    lens.phase0 = optics.number("phase0", -1e4, 1e4);
    lens.spot_sigma_periods = optics.number("spot_sigma_periods", 0.0, 1.0);
    DUBSAR_TRY(optics.finish());
    lens.pixel_mm = glm::dvec2(profile.width_mm / profile.width_px);
    profile.optics = lens;
    profile.design_distance_mm = fields.number("design_distance_mm", 50.0, 10000.0);
    profile.ipd_mm = fields.number("ipd_mm", 40.0, 80.0);
  }
  if (fields.has("edid")) read_edids(object.at("edid"), fields, profile);
  profile.serial_prefix = fields.text("serial_prefix", "");
  profile.hardware = fields.text("hardware", "");
  DUBSAR_TRY(fields.finish());
  return profile;
}

}  // namespace

Result<std::vector<PanelProfile>> parse_profiles(std::string_view json_text, std::string_view source) {
  DUBSAR_ASSIGN(const json parsed, parse_config(json_text, source));
  std::vector<PanelProfile> profiles;
  if (!parsed.is_array()) {
    DUBSAR_ASSIGN(profiles.emplace_back(), parse_profile(parsed, source));
    return profiles;
  }
  for (const json& object : parsed) {
    DUBSAR_ASSIGN(profiles.emplace_back(), parse_profile(object, source));
  }
  return profiles;
}

Result<std::vector<PanelProfile>> load_profiles(const fs::path& user_folder) {
  std::vector<PanelProfile> profiles;
  const auto add = [&](std::string_view text, std::string_view source) -> Result<void> {
    DUBSAR_ASSIGN(auto more, parse_profiles(text, source));
    for (PanelProfile& profile : more) {
      const auto same =
          std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.name == profile.name; });
      if (same == profiles.end())
        profiles.push_back(std::move(profile));
      else
        *same = std::move(profile);
    }
    return {};
  };
  for (const auto& [name, text] : embedded_profiles()) DUBSAR_TRY(add(text, name));
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(user_folder, ignored))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (is_adjustment_file(file)) continue;
    DUBSAR_ASSIGN(const std::string text, read_text_file(file, 1 << 20));
    DUBSAR_TRY(add(text, file.string()));
  }
  for (const fs::path& file : files)
    if (is_adjustment_file(file)) DUBSAR_TRY(load_adjustment(file, profiles));
  return profiles;
}

Result<PanelProfile> find_profile(std::span<const PanelProfile> profiles, std::string_view name) {
  std::string names;
  for (const PanelProfile& profile : profiles) {
    if (profile.name == name) return profile;
    names += (names.empty() ? "" : ", ") + profile.name;
  }
  return fail(ErrorKind::kUsage, "no panel profile is called \"{}\", expected one of: {}", name, names);
}

Result<Calibration> parse_calibration(std::string_view json_text, std::string_view source) {
  if (json_text.size() > (std::size_t{1} << 16))
    return fail(ErrorKind::kConfig, "calibration {}: {} bytes, expected at most 64 KiB", source, json_text.size());
  DUBSAR_ASSIGN(const json object, parse_config(json_text, fmt::format("calibration {}", source)));
  Calibration calibration;
  calibration.source = source;
  JsonFields fields(object, fmt::format("calibration {}", source));
  if (!object.is_object()) fields.complain("expected an object");
  LookingGlassFigures& sheet = calibration.figures;
  read_sheet(fields, sheet, "invView", fields.has("cellPatternMode") ? "cellPatternMode" : "CellPatternMode");
  sheet.dpi = fields.number("DPI", 10.0, 2000.0);
  sheet.screen_width = fields.integer("screenW", 1, kMaxSide);
  sheet.screen_height = fields.integer("screenH", 1, kMaxSide);
  sheet.flip_image_x = fields.flag("flipImageX", false);
  sheet.flip_subpixels = fields.flag("flipSubp", false);
  const double forty = 40.0, zero = 0.0;
  calibration.view_cone_deg = fields.number("viewCone", 1.0, 170.0, &forty);
  calibration.fringe = fields.number("fringe", -1.0, 1.0, &zero);
  if (fields.has("subpixelCells")) read_cells(object.at("subpixelCells"), fields, sheet);
  calibration.serial = fields.text("serial", "");
  calibration.config_version = fields.text("configVersion", "");
  DUBSAR_TRY(fields.finish());
  return calibration;
}

Result<PanelProfile> calibrated_profile(std::span<const PanelProfile> profiles, const Calibration& calibration,
                                        std::string_view model) {
  const LookingGlassFigures& figures = calibration.figures;
  const PanelProfile* best = nullptr;
  PanelProfile named;
  if (!model.empty()) {
    DUBSAR_ASSIGN(named, find_profile(profiles, model));
    if (named.kind == PanelKind::kTracked)
      return fail(ErrorKind::kConfig, "calibration {}: panel {} is a tracked panel, expected one with many views",
                  calibration.source, model);
    best = &named;
  }
  for (const PanelProfile& profile : profiles)
    if (model.empty() && !profile.serial_prefix.empty() && calibration.serial.rfind(profile.serial_prefix, 0) == 0 &&
        (best == nullptr || profile.serial_prefix.size() > best->serial_prefix.size()))
      best = &profile;
  for (const PanelProfile& profile : profiles)
    if (best == nullptr && profile.kind == PanelKind::kLookingGlass && profile.width_px == figures.screen_width &&
        profile.height_px == figures.screen_height)
      best = &profile;
  if (best == nullptr)
    return fail(ErrorKind::kConfig,
                "calibration {}: serial \"{}\" and {}x{} pixels match no known model; name one with panel=",
                calibration.source, calibration.serial, figures.screen_width, figures.screen_height);
  PanelProfile profile = *best;
  profile.sheet = figures;
  profile.width_px = figures.screen_width;
  profile.height_px = figures.screen_height;
  profile.width_mm = figures.screen_width / figures.dpi * kMmPerInch;
  profile.view_cone_deg = calibration.view_cone_deg;
  profile.calibration = calibration.source;
  DUBSAR_TRY(apply_adjustment(profile.adjustment, profile));
  return profile;
}

Result<PanelProfile> choose_panel(const fs::path& user_folder, std::string_view name,
                                  const fs::path& calibration_file) {
  DUBSAR_ASSIGN(const auto profiles, load_profiles(user_folder));
  if (calibration_file.empty()) return find_profile(profiles, name);
  DUBSAR_ASSIGN(const std::string text, read_text_file(calibration_file, kMaxCalibrationBytes));
  DUBSAR_ASSIGN(const Calibration calibration, parse_calibration(text, calibration_file.string()));
  return calibrated_profile(profiles, calibration, name);
}

std::vector<const PanelProfile*> panels_of_edid(std::span<const PanelProfile> profiles, const Edid& edid) {
  constexpr double kWidthTolerance = 0.15;
  const auto same_size = [&](const PanelProfile& p) {
    return p.width_px == edid.width_px && p.height_px == edid.height_px &&
           (edid.width_mm == 0 || std::abs(p.width_mm / edid.width_mm - 1.0) < kWidthTolerance);
  };
  const auto starts_like = [](const std::string& text, const std::string& prefix) {
    return !prefix.empty() && text.starts_with(prefix);
  };
  std::vector<const PanelProfile*> by_serial, by_size, tracked;
  for (const PanelProfile& p : profiles) {
    if (!same_size(p)) continue;
    if (p.kind == PanelKind::kLookingGlass && edid.name.starts_with("LKG")) {
      by_size.push_back(&p);
      if (starts_like(edid.name, p.serial_prefix) || starts_like(edid.serial, p.serial_prefix)) by_serial.push_back(&p);
    }
    if (std::any_of(p.edids.begin(), p.edids.end(), [&](const EdidId& id) {
          return id.manufacturer == edid.manufacturer && id.product == edid.product;
        }))
      tracked.push_back(&p);
  }
  if (!by_serial.empty()) return by_serial;
  return by_size.empty() ? tracked : by_size;
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

double viewing_distance_mm(const PanelProfile& profile) noexcept {
  if (profile.design_distance_mm > 0) return profile.design_distance_mm;
  return profile.height_mm() / 2 / std::tan(kFieldOfViewDeg * std::numbers::pi / 360);
}

Result<TrackedPanel> panel_optics(const PanelProfile& profile, double distance_mm) {
  if (profile.optics) {
    TrackedPanel panel;
    panel.lens = *profile.optics;
    panel.width_px = profile.width_px;
    panel.height_px = profile.height_px;
    return panel;
  }
  if (!profile.sheet)
    return fail(ErrorKind::kConfig, "panel profile {}: no lens figures are known, give the unit's calibration file",
                profile.name);
  return optics_of_sheet(lens_sheet(*profile.sheet), profile.width_mm, profile.view_cone_deg * std::numbers::pi / 180.0,
                         distance_mm);
}

}  // namespace dubsar
