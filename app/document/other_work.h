#pragma once
// Work that was found but is not that of the surface that is shown: of one that was made of the same scan before it, or
// that had its name.

#include <string>
#include <vector>

#include "app/document/document_file.h"

namespace dubsar::app {

struct OtherWork {
  Work work;
  std::string file;                   ///< where it lies
  bool same_scan = false;             ///< places in mm of the scan are the same places; else nobody knows
  std::vector<std::string> copies{};  ///< files of the same work, or of what it was before
  friend bool operator==(const OtherWork&, const OtherWork&) = default;
};

}  // namespace dubsar::app
