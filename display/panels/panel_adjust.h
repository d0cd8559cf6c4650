#pragma once
// The user's corrections of a panel's lens figures: one small file PANEL.adjust.json beside the user's profiles.

#include <filesystem>
#include <span>
#include <string_view>

#include "display/panels/panel_profile.h"

namespace dubsar {

/// "pitch=52.6,slope=-7.21,center=0.43", any of the three. kUsage for anything else.
Result<PanelAdjustment> parse_adjustment(std::string_view text);

/// Replaces the profile's figures and remembers the adjustment in it. kConfig, by name and range, when a figure cannot
/// be or when the panel has no lens figures to adjust. An empty adjustment changes nothing.
Result<void> apply_adjustment(const PanelAdjustment& adjustment, PanelProfile& profile);

bool is_adjustment_file(const std::filesystem::path& file);

/// Reads the file and applies it to the profile that it names; a panel that is not there is left alone with a warning.
Result<void> load_adjustment(const std::filesystem::path& file, std::span<PanelProfile> profiles);

/// Adds to what is saved for `panel` (a profile of load_profiles(folder)) and writes it atomically, making the folder.
/// Returns the file. Errors as apply_adjustment, then of writing.
Result<std::filesystem::path> save_adjustment(const std::filesystem::path& folder, std::string_view panel,
                                              const PanelAdjustment& adjustment);

/// Forgets what is saved for `panel`. Returns false when nothing was.
Result<bool> remove_adjustment(const std::filesystem::path& folder, std::string_view panel);

}  // namespace dubsar
