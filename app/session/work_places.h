#pragma once
// Where the work on a surface lies, and which of the files there belong to it.

#include <filesystem>
#include <string>
#include <vector>

#include "app/document/other_work.h"

namespace dubsar::app {

/// The two places that work is kept in: NAME.dubsar.json beside the surface NAME, which goes with it wherever it is
/// taken, and a file in the user's state folder that is named by what is in the surface (and in its scan), by which a
/// surface finds its work that was renamed, copied or moved without it. Each is enough. Empty: there is none.
struct WorkPlaces {
  std::filesystem::path beside, state;
};
WorkPlaces places_of(const SourceFile& source, const std::filesystem::path& state_folder);

/// Where sessions of version 4 and before kept the work of a surface: by its path alone.
std::filesystem::path old_place_of(const SourceFile& source, const std::filesystem::path& state_folder);

enum class Belonging {
  kThisSurface,
  kSameScan,  ///< to another surface of the scan
  kSameName,  ///< to another surface that had its name
  kNobody,    ///< to another one
};
/// Whose work a file holds. `had_its_place`: it lies where this surface's work would.
Belonging belonging(const SourceFile& found, const SourceFile& surface, bool had_its_place);

/// Files besides places_of() where work of the surface may lie, or of one that it took the place of: those that were
/// set aside there, those of other surfaces in its folder, of the same scan in the state folder, and old_place_of(). At
/// most some hundred.
struct OtherPlace {
  std::filesystem::path file;
  bool had_its_place = false;
};
std::vector<OtherPlace> other_places(const SourceFile& source, const std::filesystem::path& state_folder);

/// Work of one surface from two files: the later one where one followed from the other, else both (join.h).
Work join_copies(const Work& a, const Work& b);

}  // namespace dubsar::app
