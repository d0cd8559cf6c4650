#pragma once
// What a session begins with, besides the surface.

#include <filesystem>
#include <optional>
#include <string>

#include "app/document/document.h"
#include "core/volume/formats/import_options.h"

namespace dubsar::app {

struct SessionWork {
  Document document{};              ///< its view and home are the stage's, and its parts the mesh's where it has none
  bool upright = false;             ///< the obverse stands upright at home, as its writing says
  std::string doubt{};              ///< what is not sure of how it stands; empty: nothing
  bool restored = false;            ///< the document is that of an earlier session
  std::filesystem::path surface{};  ///< the file of the surface; beside it its scan is looked for
  std::optional<ImportOptions> scan{};  ///< the scan it was made of; none: looked for
};

}  // namespace dubsar::app
