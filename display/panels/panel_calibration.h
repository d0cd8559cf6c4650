#pragma once
// A Looking Glass unit's own calibration, `visual.json`: its lens figures as the maker measured them.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "display/panels/panel_set.h"

namespace dubsar {

struct PanelCalibration {
  LookingGlassFigures figures;
  double view_cone_deg = 40.0;
  std::string serial, source;
};

/// Reads a calibration (at most 64 KiB): numbers may be bare or wrapped as {"value": x}. Refused (kConfig) by name and
/// range: pitch 5..500, slope not 0, screen 1..16384, DPI 10..2000, viewCone 1..170, at most 10 subpixel cells, all
/// finite.
Result<PanelCalibration> parse_calibration(std::string_view json_text, std::string_view source);

/// parse_calibration of a file; kNoInput when it is not there.
Result<PanelCalibration> read_calibration(const std::filesystem::path& file);

/// The profile with the calibration's lens figures and size, then the profile's adjustment; picks the model by name if
/// one is given, else by serial, else by size.
Result<PanelProfile> calibrated_profile(const PanelSet& panels, const PanelCalibration& calibration,
                                        std::string_view model = {});

/// The panel that options name: a profile's name, a calibration file, or both (both empty: kUsage).
Result<PanelProfile> choose_panel(const PanelSet& panels, std::string_view name,
                                  const std::filesystem::path& calibration_file);

/// Calibration files on mounted units: <root>/*/LKG_calibration/visual.json under each root, e.g. /media/$USER.
std::vector<std::filesystem::path> find_calibration_files(std::span<const std::filesystem::path> roots);

}  // namespace dubsar
