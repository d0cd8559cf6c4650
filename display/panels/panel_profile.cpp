#include "display/panels/panel_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text/json_fields.h"
#include "display/optics/optics.h"
#include "display/panels/lens_fields.h"

namespace dubsar {
using nlohmann::json;

namespace {

constexpr double kFieldOfViewDeg = 14.0;  // a Looking Glass Portrait at 36 inches
constexpr int kLeastTilePx = 8;
constexpr std::size_t kMostNameLetters = 64;

/// An object inside of a profile; a null that has no fields where it is missing or something else.
const json& object_of(const json& profile, const char* name, JsonFields& fields) {
  static const json nothing;
  if (!fields.has(name)) {
    fields.complain(fmt::format("{} is missing, expected an object", name));
    return nothing;
  }
  const json& found = profile.at(name);
  if (!found.is_object()) fields.complain(fmt::format("{} is {}, expected an object", name, found.type_name()));
  return found;
}

void read_edids(const json& list, JsonFields& fields, PanelProfile& profile) {
  constexpr int kMostProduct = 65535;
  const auto wrong = [&] {
    fields.complain(
        fmt::format("edid: expected pairs of a manufacturer's three letters and a product of 0 to {}", kMostProduct));
  };
  if (!list.is_array()) return wrong();
  for (const json& entry : list) {
    if (!entry.is_array() || entry.size() != 2 || !entry[0].is_string() ||
        entry[0].get_ref<const std::string&>().size() != 3 || !entry[1].is_number_integer() || entry[1] < 0 ||
        entry[1] > kMostProduct)
      return wrong();
    profile.marks.edids.push_back({entry[0].get<std::string>(), entry[1].get<int>()});
  }
}

PanelKind read_kind(JsonFields& fields) {
  const std::string kind = fields.text("kind", nullptr);
  if (kind == "lens_sheet") return PanelKind::kLensSheet;
  if (kind == "tracked") return PanelKind::kTracked;
  if (kind != "looking_glass")
    fields.complain(fmt::format("kind is {}, expected looking_glass, lens_sheet or tracked",
                                is_panel_name(kind) ? kind : "something else"));
  return PanelKind::kLookingGlass;
}

/// Figures that the maker wrote for the sheet; dots per inch are the panel's where it has none of its own.
Result<void> read_sheet(const json& object, double dpi, JsonFields& fields, PanelProfile& profile) {
  LookingGlassFigures sheet;
  const json& lens_object = object_of(object, "lens", fields);
  DUBSAR_TRY(fields.finish());
  JsonFields lens(lens_object, fields.where() + ": lens");
  read_lens_figures(lens, sheet, "invert_views", "cell_pattern");
  sheet.flip_image_x = lens.flag("flip_image_x", false);
  sheet.flip_subpixels = lens.flag("flip_subpixels", false);
  if (lens.has("cells")) read_lens_cells(lens_object.at("cells"), lens, sheet);
  DUBSAR_TRY(lens.finish());
  sheet.dpi = dpi > 0.0 ? dpi : profile.width_px / profile.width_mm * kMmPerInch;
  sheet.screen_width = profile.width_px;
  sheet.screen_height = profile.height_px;
  profile.sheet = std::move(sheet);
  return {};
}

Result<void> read_quilt(const json& object, JsonFields& fields, PanelProfile& profile) {
  const json& quilt_object = object_of(object, "quilt", fields);
  DUBSAR_TRY(fields.finish());
  JsonFields quilt(quilt_object, fields.where() + ": quilt");
  profile.quilt = {quilt.integer("columns", 1, 32), quilt.integer("rows", 1, 32),
                   quilt.integer("width_px", 1, kMostPanelPx), quilt.integer("height_px", 1, kMostPanelPx)};
  if (profile.quilt.tile_width() < kLeastTilePx || profile.quilt.tile_height() < kLeastTilePx)
    quilt.complain(fmt::format("tiles of {} x {} pixels, expected at least {} a side", profile.quilt.tile_width(),
                               profile.quilt.tile_height(), kLeastTilePx));
  profile.views = profile.quilt.views();
  return quilt.finish();
}

Result<void> read_optics(const json& object, JsonFields& fields, PanelProfile& profile) {
  const json& optics_object = object_of(object, "optics", fields);
  DUBSAR_TRY(fields.finish());
  JsonFields optics(optics_object, fields.where() + ": optics");
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
  profile.zone.design_distance_mm = fields.number("design_distance_mm", 50.0, 10000.0);
  profile.zone.ipd_mm = fields.number("ipd_mm", 40.0, 80.0);
  return {};
}

}  // namespace

bool is_panel_name(std::string_view name) {
  return !name.empty() && name.size() <= kMostNameLetters && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
                  c == '_';
         });
}

Result<PanelProfile> parse_profile(const json& object, std::string_view source) {
  if (!object.is_object())
    return fail(ErrorKind::kConfig, "panel profile in {}: {} found, expected an object", source, object.type_name());
  PanelProfile profile;
  JsonFields fields(object, fmt::format("panel profile in {}", source));
  profile.name = fields.text("name", nullptr);
  if (!is_panel_name(profile.name)) fields.complain("name: expected 1 to 64 letters, digits, '.', '-' and '_'");
  DUBSAR_TRY(fields.finish());
  fields = JsonFields(object, fmt::format("panel profile {} in {}", profile.name, source));
  profile.title = fields.text("title", profile.name.c_str());
  profile.note = fields.text("note", "");
  profile.kind = read_kind(fields);
  profile.width_px = fields.integer("width_px", 1, kMostPanelPx);
  profile.height_px = fields.integer("height_px", 1, kMostPanelPx);
  const double no_dpi = 0.0;
  const double dpi = fields.number("dpi", 10.0, 2000.0, &no_dpi);
  const double from_dpi = dpi > 0.0 ? profile.width_px / dpi * kMmPerInch : 0.0;
  profile.width_mm = fields.number("width_mm", 10.0, 10000.0, dpi > 0.0 ? &from_dpi : nullptr);
  const double square_pixels = static_cast<double>(profile.width_px) / std::max(1, profile.height_px);
  profile.aspect = fields.number("aspect", 0.1, 10.0, &square_pixels);
  DUBSAR_TRY(fields.finish());
  if (profile.kind == PanelKind::kTracked) {
    DUBSAR_TRY(read_optics(object, fields, profile));
  } else {
    profile.zone.cone_deg = fields.number("view_cone_deg", 1.0, 170.0);
    if (fields.has("lens")) DUBSAR_TRY(read_sheet(object, dpi, fields, profile));
  }
  if (profile.kind == PanelKind::kLookingGlass) DUBSAR_TRY(read_quilt(object, fields, profile));
  if (profile.kind == PanelKind::kLensSheet) profile.views = fields.integer("views", 2, 512);
  if (fields.has("edid")) read_edids(object.at("edid"), fields, profile);
  profile.marks.serial_prefix = fields.text("serial_prefix", "");
  profile.marks.hardware = fields.text("hardware", "");
  DUBSAR_TRY(fields.finish());
  return profile;
}

double viewing_distance_mm(const PanelProfile& profile) noexcept {
  if (profile.zone.design_distance_mm > 0) return profile.zone.design_distance_mm;
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
  return optics_of_sheet(lens_sheet(*profile.sheet), profile.width_mm, profile.zone.cone_deg * std::numbers::pi / 180.0,
                         distance_mm);
}

}  // namespace dubsar
