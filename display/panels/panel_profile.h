#pragma once
// Panels are data: what a display is made of, read from JSON in the source tree, in the user's configuration folder or
// from a unit's own calibration file. Bad figures are refused by name and range.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "display/optics/lens.h"
#include "display/optics/weave.h"
#include "display/panels/edid.h"

namespace dubsar {

enum class PanelKind {
  kLookingGlass,  ///< N views over a slanted sheet, calibrated by the maker
  kLensSheet,     ///< the same with a generic sheet
  kTracked,       ///< two views, woven for tracked eyes
};

struct QuiltLayout {
  int columns = 0, rows = 0;
  int width_px = 0, height_px = 0;  ///< of the whole quilt; padding is left when tiles do not divide it
  int views() const noexcept { return columns * rows; }
  int tile_width() const noexcept { return width_px / columns; }
  int tile_height() const noexcept { return height_px / rows; }
};

/// Lens figures that the user found by eye with the numbered-view pattern; they replace those of the profile and those
/// of a calibration. Of a tracked panel pitch is in mm, slope is the tangent of the slant and center its phase.
struct PanelAdjustment {
  std::optional<double> pitch, slope, center;
  bool empty() const noexcept { return !pitch && !slope && !center; }
};

/// How a panel calls itself in its EDID.
struct EdidId {
  std::string manufacturer;  ///< three letters
  int product = 0;
};

struct PanelProfile {
  std::string name, title, note;
  PanelKind kind = PanelKind::kLookingGlass;
  int width_px = 0, height_px = 0;
  double width_mm = 0.0;
  double aspect = 0.0;         ///< of the picture, width / height
  double view_cone_deg = 0.0;  ///< horizontal cone over all views (not of kTracked)
  int views = 2;
  QuiltLayout quilt;  ///< Looking Glass only
  std::string serial_prefix, hardware;
  std::vector<EdidId> edids;                 ///< tracked panels; a Looking Glass is known by its monitor name
  std::optional<LookingGlassFigures> sheet;  ///< none: no lens figures are known, quilts only
  std::optional<LensOptics> optics;          ///< kTracked
  double design_distance_mm = 0.0, ipd_mm = 63.0;
  std::string calibration;     ///< where the lens figures come from; empty: those of the profile
  PanelAdjustment adjustment;  ///< the user's corrections; applied already
  double height_mm() const noexcept { return width_mm * height_px / width_px; }
};

/// Reads one profile or an array of them. `source` names the text in errors. kConfig when a field is missing, of a
/// wrong type or out of range; the sentence has the field's name, the value found and the range.
Result<std::vector<PanelProfile>> parse_profiles(std::string_view json_text, std::string_view source);

/// The profiles of the program (embedded) followed by those of *.json in `user_folder` (may be missing); a user's
/// profile replaces one of the same name. Adjustments (display/panels/panel_adjust.h) are applied last. Errors as
/// parse_profiles.
Result<std::vector<PanelProfile>> load_profiles(const std::filesystem::path& user_folder);

/// kUsage with the names there are.
Result<PanelProfile> find_profile(std::span<const PanelProfile> profiles, std::string_view name);

/// A unit's own calibration (`visual.json` of a Looking Glass, at most 64 KiB).
struct Calibration {
  LookingGlassFigures figures;
  double view_cone_deg = 40.0;
  double fringe = 0.0;
  std::string serial, config_version, source;
};

/// Reads a calibration: numbers may be bare or wrapped as {"value": x}. Refused (kConfig) by name and range: pitch
/// 1..10000, slope not 0, screen 1..16384, DPI 10..2000, viewCone 1..170, at most 10 subpixel cells, all finite.
Result<Calibration> parse_calibration(std::string_view json_text, std::string_view source);

/// The profile with the calibration's lens figures and size, then the profile's adjustment; picks the model by name if
/// one is given, else by serial, else by size.
Result<PanelProfile> calibrated_profile(std::span<const PanelProfile> profiles, const Calibration& calibration,
                                        std::string_view model = {});

/// The panel that options name: a profile's name, a calibration file, or both (both empty: kUsage).
Result<PanelProfile> choose_panel(const std::filesystem::path& user_folder, std::string_view name,
                                  const std::filesystem::path& calibration_file);

/// The panels that a monitor with this EDID can be, by the profile's own pixels and, where the EDID tells it, the
/// picture's width to 15 %: Looking Glasses when its name starts with "LKG" (only those whose serials start like its
/// name or serial, if there are any), tracked panels by manufacturer and product.
std::vector<const PanelProfile*> panels_of_edid(std::span<const PanelProfile> profiles, const Edid& edid);

/// Calibration files on mounted units: <root>/*/LKG_calibration/visual.json under each root, e.g. /media/$USER.
std::vector<std::filesystem::path> find_calibration_files(std::span<const std::filesystem::path> roots);

/// How far away the middle of the viewing zone is: the profile's figure, else 14 degrees of field of view over its
/// height.
double viewing_distance_mm(const PanelProfile& profile) noexcept;

/// The panel as optics: from its own figures (kTracked), or derived from its sheet for an eye `distance_mm` away.
Result<TrackedPanel> panel_optics(const PanelProfile& profile, double distance_mm);

}  // namespace dubsar
