#pragma once
// The XMP packet of a published picture: title, rights, institution and how it was made, for libraries and archives.

#include <string>

namespace dubsar::app {

struct Publication {
  std::string title, rights, institution;  ///< UTF-8; empty: not said
  std::string made_by;                     ///< program and version
};

/// Dublin Core and XMP basic properties as RDF; characters that XML cannot hold are left out. Empty when nothing is
/// said.
std::string xmp_packet(const Publication& publication);

}  // namespace dubsar::app
