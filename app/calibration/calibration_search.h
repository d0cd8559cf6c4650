#pragma once
// A Looking Glass unit's own calibration, by every open route: USB storage, USB HID, the maker's service, a
// given file.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"
#include "display/panels/panel_set.h"

namespace dubsar::app {

/// Where to look. Each route can be a real or a simulated one.
struct CalibrationSearch {
  struct HidUnit {
    std::string place;  ///< "/dev/hidraw3"
    OpenTransport open;
    std::string problem;  ///< why it cannot be opened, with the remedy; empty when it can
  };
  std::vector<std::filesystem::path> mounts;  ///< folders of mounted USB storage
  std::vector<HidUnit> hid;
  OpenTransport bridge;  ///< empty: the service is not asked
  std::string bridge_place;
  std::filesystem::path file;  ///< empty: none
};

/// This machine's routes. `bridge_port` 0 leaves the service alone; it is asked on the loopback address only.
CalibrationSearch search_this_machine(int bridge_port, const Clock& clock);

struct FoundCalibration {
  std::string route;  ///< "file", "usb_storage", "usb_hid", "bridge"
  std::string place;  ///< file, device node or address
  std::string text;   ///< the JSON, as found
  std::string serial;
  std::optional<PanelProfile> panel;  ///< with the calibration's figures; none: see problem
  std::string problem;
};

struct CalibrationReport {
  std::vector<FoundCalibration> found;                       ///< readable or not, in the order of the routes
  std::vector<std::pair<std::string, std::string>> missing;  ///< routes that gave nothing, and why
};

/// Tries all routes; bad calibrations are found ones with a problem. Blocks for at most some seconds.
CalibrationReport find_calibrations(const CalibrationSearch& search, const PanelSet& panels, const Clock& clock);

}  // namespace dubsar::app
