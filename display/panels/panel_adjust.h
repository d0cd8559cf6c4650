#pragma once
// The user's corrections of a panel's lens figures: one small file PANEL.adjust.json beside the user's profiles.

#include <filesystem>
#include <string_view>

#include "display/panels/panel_set.h"

namespace dubsar {

/// "pitch=52.6,slope=-7.21,center=0.43", any of the three. kUsage for anything else.
Result<PanelAdjustment> parse_adjustment(std::string_view text);

/// Replaces the profile's figures and remembers the adjustment in it. kConfig, by name and range, when a figure cannot
/// be or when the panel has no lens figures to adjust. An empty adjustment changes nothing.
Result<void> apply_adjustment(const PanelAdjustment& adjustment, PanelProfile& profile);

bool is_adjustment_file(const std::filesystem::path& file);

/// Reads the file and applies it to the profile that it names. What is wrong, a panel that is not there included,
/// becomes a problem of `panels`.
void load_adjustment(const std::filesystem::path& file, PanelSet& panels);

/// Adds to what is saved for `panel` (one of load_panels(folder)) and writes it atomically, making the folder.
/// Returns the file. Errors of PanelSet::find, as apply_adjustment, then of writing.
Result<std::filesystem::path> save_adjustment(const std::filesystem::path& folder, std::string_view panel,
                                              const PanelAdjustment& adjustment);

/// The same for a panel whose figures may come from elsewhere, a calibration.
Result<std::filesystem::path> save_adjustment(const std::filesystem::path& folder, PanelProfile panel,
                                              const PanelAdjustment& adjustment);

/// Forgets what is saved for `panel`, whatever it is: the file is not read. Returns false when nothing was; kUsage when
/// there is no such panel either.
Result<bool> remove_adjustment(const std::filesystem::path& folder, std::string_view panel);

}  // namespace dubsar
