#pragma once
// What can be done, in words, from the mapping in use: nothing here is typed twice.

#include <string>
#include <vector>

#include "app/commands/key_table.h"
#include "input/navigation/mapping.h"

namespace dubsar::app {

struct HelpRow {
  std::string what, does;
  friend bool operator==(const HelpRow&, const HelpRow&) = default;
};
struct HelpSection {
  std::string title;
  std::vector<HelpRow> rows;
  friend bool operator==(const HelpSection&, const HelpSection&) = default;
};

/// What there is to steer with, and to look at, besides mouse, keyboard and a plain monitor.
struct HelpDevices {
  bool more = true;      ///< devices that follow hands or heads, or have a SpaceMouse
  bool two_eyes = true;  ///< the display has a view for each eye
  bool touch = false;    ///< a touch panel
};

/// Sections for the mouse, hands and SpaceMouse of a mapping, and for all commands that have keys. Sections without a
/// row are left out, and what needs a device that is not there.
std::vector<HelpSection> help_page(const Mapping& mapping, const KeyTable& keys, const HelpDevices& there = {});

}  // namespace dubsar::app
