#pragma once
// What a monitor says about itself (VESA E-EDID 1.3 and 1.4, base block), and which monitor is which on this
// machine.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "display/panels/monitor.h"

namespace dubsar {

struct Edid {
  std::string manufacturer;  ///< three letters, "ACR"
  std::uint16_t product = 0;
  std::uint32_t serial_number = 0;  ///< 0: none
  std::string name, serial;         ///< from descriptors; printable ASCII, may be empty
  int width_px = 0, height_px = 0;  ///< of the preferred timing; 0: none
  int width_mm = 0, height_mm = 0;  ///< of the picture; 0: unknown
  int year = 0;                     ///< of manufacture, or of the model
  bool operator==(const Edid&) const = default;
};

/// Reads the first 128 bytes; extension blocks may follow and are not read. kBadData: too short, no EDID
/// header, a checksum that does not fit, a manufacturer that is not three letters.
Result<Edid> parse_edid(std::span<const std::byte> bytes);

/// A connector of a graphics card with a monitor that says something.
struct ConnectedEdid {
  std::string connector;  ///< as the kernel calls it, "DP-1", "HDMI-A-1"
  Result<Edid> edid;      ///< why it cannot be read, where it cannot
};

/// All cardN-CONNECTOR/edid below `folder` that are not empty, by card and connector. Linux; elsewhere there
/// are none.
std::vector<ConnectedEdid> read_connected_edids(const std::filesystem::path& folder = "/sys/class/drm");

/// The EDID of a monitor that the window system tells of: by the connector's name ("HDMI-1" of X is the
/// kernel's "HDMI-A-1"), where drivers that count connectors otherwise must not contradict the size: then by
/// size, if exactly one fits. A monitor in another mode than its preferred one goes by name. Null: nothing
/// fits.
const Edid* edid_of(const Monitor& monitor, std::span<const ConnectedEdid> connected);

}  // namespace dubsar
