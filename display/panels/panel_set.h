#pragma once
// The panels that are known: those of the program and those of the user's folder. A file that is not understood loses
// itself, with its reason, not its neighbours.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "display/panels/edid.h"
#include "display/panels/panel_profile.h"

namespace dubsar {

/// A file, or one profile of it, that was left out.
struct PanelProblem {
  std::filesystem::path file;
  std::string panel;   ///< the panel it speaks of; empty when that could not be read either
  std::string reason;  ///< a sentence with the field, what was found and what was expected
};

struct PanelSet {
  std::vector<PanelProfile> profiles;
  std::vector<PanelProblem> problems;

  /// kConfig, with the reason, when the user's own file about this panel was left out: its figures are not guessed.
  /// kUsage, with the names there are, when there is none.
  Result<PanelProfile> find(std::string_view name) const;
  /// Adds a profile, or replaces the one of the same name and what was wrong with it.
  void put(PanelProfile profile);
};

/// The panels of the program.
const PanelSet& built_in_panels();

/// The panels of the program and those of *.json in `user_folder` (may be missing), in the order of the files' names; a
/// profile replaces one of the same name. Adjustments (display/panels/panel_adjust.h) are applied last. A file holds
/// one profile or an array of them, at most 1 MiB.
PanelSet load_panels(const std::filesystem::path& user_folder);

/// The panels that a monitor with this EDID can be, by the profile's own pixels and, where the EDID tells it, the
/// picture's width to 15 %: Looking Glasses when its name starts with "LKG" (only those whose serials start like its
/// name or serial, if there are any), tracked panels by manufacturer and product.
std::vector<const PanelProfile*> panels_of_edid(const PanelSet& panels, const Edid& edid);

}  // namespace dubsar
