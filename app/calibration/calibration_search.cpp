#include "app/calibration/calibration_search.h"

#include <fmt/format.h>

#include "app/cli/config_folder.h"
#include "core/base/files/atomic_file.h"
#include "devices/device_list.h"
#include "devices/looking_glass/bridge_client.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/transport/hid_transport.h"
#include "display/panels/panel_calibration.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kMaxCalibrationBytes = 64 << 10;

FoundCalibration judge(std::string route, std::string place, Result<std::string> text, const PanelSet& panels) {
  FoundCalibration found{std::move(route), std::move(place), {}, {}, {}, {}};
  if (!text) {
    found.problem = text.error().message;
    return found;
  }
  found.text = *std::move(text);
  const auto read = parse_calibration(found.text, found.place);
  if (read) found.serial = read->serial;
  auto panel = read ? calibrated_profile(panels, *read) : Result<PanelProfile>(tl::unexpect, read.error());
  if (panel)
    found.panel = *std::move(panel);
  else
    found.problem = panel.error().message;
  return found;
}

void search_storage(const CalibrationSearch& search, const PanelSet& panels, CalibrationReport& report) {
  const std::vector<fs::path> files = find_calibration_files(search.mounts);
  for (const fs::path& file : files)
    report.found.push_back(judge("usb_storage", file.string(), read_text_file(file, kMaxCalibrationBytes), panels));
  if (!files.empty()) return;
  std::string places;
  for (const fs::path& root : search.mounts)
    places += (places.empty() ? "" : ", ") + (root / "*/LKG_calibration/visual.json").string();
  report.missing.emplace_back(
      "usb_storage", places.empty() ? "neither USER nor LOGNAME is set, so the folder of USB storage is not known"
                                    : fmt::format("nothing at {}; connect and mount the panel's USB storage", places));
}

void search_hid(const CalibrationSearch& search, const PanelSet& panels, const Clock& clock,
                CalibrationReport& report) {
  for (const CalibrationSearch::HidUnit& unit : search.hid) {
    if (!unit.problem.empty()) {
      report.missing.emplace_back("usb_hid", fmt::format("{}: {}", unit.place, unit.problem));
      continue;
    }
    auto transport = unit.open();
    report.found.push_back(judge("usb_hid", unit.place,
                                 transport ? read_looking_glass_calibration(**transport, clock)
                                           : Result<std::string>(tl::unexpect, transport.error()),
                                 panels));
  }
  if (search.hid.empty())
    report.missing.emplace_back("usb_hid", "no Looking Glass of the first generation (USB 04d8:ef7e) is plugged in");
}

void search_bridge(const CalibrationSearch& search, const PanelSet& panels, const Clock& clock,
                   CalibrationReport& report) {
  if (!search.bridge) {
    report.missing.emplace_back("bridge", "not asked");
    return;
  }
  const auto devices = read_bridge_devices(search.bridge, clock);
  if (!devices) {
    report.missing.emplace_back(
        "bridge",
        fmt::format("Looking Glass Bridge does not answer at {} ({}); it is not needed where another route works",
                    search.bridge_place, devices.error().message));
    return;
  }
  int calibrated = 0;
  for (const BridgeDevice& device : *devices) {
    if (device.calibration.empty()) continue;
    ++calibrated;
    FoundCalibration found =
        judge("bridge", fmt::format("{} {}", search.bridge_place, device.id), device.calibration, panels);
    if (found.serial.empty()) found.serial = device.id;
    report.found.push_back(std::move(found));
  }
  if (calibrated == 0)
    report.missing.emplace_back("bridge",
                                fmt::format("Looking Glass Bridge at {} knows {} displays, none with a calibration",
                                            search.bridge_place, devices->size()));
}

}  // namespace

CalibrationSearch search_this_machine(int bridge_port, const Clock& clock) {
  CalibrationSearch search;
  search.mounts = mount_folders();
  const auto driver = find_driver("looking_glass", "displays", driver_table());
  for (const DeviceInfo& info : list_hid_devices(driver ? DriverTable(*driver, 1) : DriverTable())) {
    CalibrationSearch::HidUnit unit{info.path, [path = info.path, &clock] { return open_hid(path, clock); }, {}};
    if (info.state != DeviceState::kUsable) unit.problem = fmt::format("{}; {}", info.reason, info.remedy);
    search.hid.push_back(std::move(unit));
  }
  if (bridge_port > 0) {
    search.bridge = bridge_opener(static_cast<std::uint16_t>(bridge_port));
    search.bridge_place = fmt::format("127.0.0.1 port {}", bridge_port);
  }
  return search;
}

CalibrationReport find_calibrations(const CalibrationSearch& search, const PanelSet& panels, const Clock& clock) {
  CalibrationReport report;
  if (!search.file.empty())
    report.found.push_back(
        judge("file", search.file.string(), read_text_file(search.file, kMaxCalibrationBytes), panels));
  search_storage(search, panels, report);
  search_hid(search, panels, clock, report);
  search_bridge(search, panels, clock, report);
  return report;
}

}  // namespace dubsar::app
