#pragma once
// Panels are data: what a display is made of, read from JSON. Bad figures are refused by name and range.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "display/optics/lens.h"
#include "display/optics/weave.h"

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

/// What a panel is known by when it is plugged in.
struct PanelMarks {
  std::string serial_prefix, hardware;  ///< of a Looking Glass, as its calibration and its monitor call it
  std::vector<EdidId> edids;            ///< of a tracked panel
};

/// From where a panel is looked at.
struct ViewingZone {
  double cone_deg = 0.0;            ///< horizontal cone over all views (not of kTracked)
  double design_distance_mm = 0.0;  ///< 0: not known
  double ipd_mm = 63.0;
};

/// Where the figures of the lenses come from.
struct LensOrigin {
  std::string calibration;     ///< empty: they are those of the profile
  PanelAdjustment adjustment;  ///< the user's corrections; applied already
};

struct PanelProfile {
  std::string name, title, note;
  PanelKind kind = PanelKind::kLookingGlass;
  int width_px = 0, height_px = 0;
  double width_mm = 0.0;
  double aspect = 0.0;  ///< of the picture, width / height
  int views = 2;
  QuiltLayout quilt;  ///< Looking Glass only
  PanelMarks marks;
  ViewingZone zone;
  std::optional<LookingGlassFigures> sheet;  ///< none: no lens figures are known, quilts only
  std::optional<LensOptics> optics;          ///< kTracked
  LensOrigin lenses;
  double height_mm() const noexcept { return width_mm * height_px / width_px; }
};

/// What a panel may be called: 1 to 64 letters, digits, '.', '-' and '_', no '.' first. Files are named after it.
bool is_panel_name(std::string_view name);

/// Reads one profile. `source` names the text in errors. kConfig when a field is missing, of a wrong type or out of
/// range; the sentence has the field's name, the value found and the range.
Result<PanelProfile> parse_profile(const nlohmann::json& object, std::string_view source);

/// How far away the middle of the viewing zone is: the profile's figure, else 14 degrees of field of view over its
/// height.
double viewing_distance_mm(const PanelProfile& profile) noexcept;

/// The panel as optics: from its own figures (kTracked), or derived from its sheet for an eye `distance_mm` away.
Result<TrackedPanel> panel_optics(const PanelProfile& profile, double distance_mm);

}  // namespace dubsar
