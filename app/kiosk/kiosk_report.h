#pragma once
// What a kiosk's journal says, in sentences that can be read from home.

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace dubsar::app {

struct KioskReport {
  std::string text;  ///< a paragraph a day, the newest last
  int days = 0, visits = 0, troubles = 0;
  int killed = 0;  ///< times it began without having ended before
};

/// Of the last `days` days that have a file in the journal's folder. Lines that are none, as after a power failure, are
/// counted and left out. kNoInput: there is no such folder, or no day in it.
Result<KioskReport> kiosk_report(const std::filesystem::path& journal, int days);

}  // namespace dubsar::app
