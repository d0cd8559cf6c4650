// dubsar doctor: what this machine has, what is missing, and how to mend it.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/cli/config_folder.h"
#include "app/cli/verb.h"
#include "app/publish/video.h"
#include "core/base/numbers/units.h"
#include "core/base/system/budget.h"
#include "core/volume/formats/import_hdf5.h"
#include "devices/camera/capture.h"
#include "devices/device_list.h"
#include "display/headset/headset.h"
#include "display/render/context/context_egl.h"
#include "display/render/context/context_glfw.h"
#include "input/tracking/vision/model_files.h"

namespace dubsar::app {
namespace {

struct Finding {
  std::string name, state, detail, fix;  ///< state: "ok", "missing" (something does not work), "note"
};

Finding check_gl() {
  auto context = EglContext::create();
  if (!context) return {"OpenGL", "missing", context.error().message, "apt install libegl1 libgl1-mesa-dri"};
  return {"OpenGL", "ok", describe_gl(), ""};
}

Finding check_memory_size() {
  const double gib = gib_of(available_memory_bytes());
  const std::string detail = fmt::format("{:.1f} GiB available", gib);
  if (gib < 4.0) return {"memory", "note", detail, "large scans need more: use --crop or --stride"};
  return {"memory", "ok", detail, ""};
}

Finding check_disk() {
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  if (error) return {"disk", "note", "free space unknown: " + error.message(), ""};
  return {"disk", "ok", fmt::format("{:.1f} GiB free here", gib_of(space.available)), ""};
}

std::vector<Finding> check_hdf5_filters() {
  std::vector<Finding> findings;
  for (const Hdf5FilterState& filter : hdf5_filter_states())
    findings.push_back({fmt::format("HDF5 {}", filter.name), filter.available ? "ok" : "note",
                        filter.available ? "can be read" : "compressed data cannot be read",
                        filter.available ? "" : filter.remedy});
  return findings;
}

std::vector<Finding> check_models() {
  std::vector<Finding> findings;
  const std::filesystem::path folder = model_folder();
  for (const ModelFile& file : model_files()) {
    const bool here = model_is_here(folder, file);
    findings.push_back({"network", here ? "ok" : "note",
                        fmt::format("{} ({}{})", file.name, file.what, here ? "" : ": not here"),
                        here ? "" : fmt::format("{} fetches it from {}", kModelCommand, file.package)});
  }
  return findings;
}

Finding check_cameras() {
  if (auto module = load_capture(); !module)
    return {"webcam", "note", module.error().message, "apt install libopencv-videoio406"};
  return {"webcam", "ok", "OpenCV's capture code can be loaded; cameras: dubsar devices list", ""};
}

Finding check_windows() {
  const auto monitors = list_monitors();
  if (!monitors) return {"windows", "note", monitors.error().message, "pictures, films and --offscreen work without"};
  return {"windows", "ok", fmt::format("{} monitor{}", monitors->size(), monitors->size() == 1 ? "" : "s"), ""};
}

std::vector<Finding> check_devices() {
  std::vector<Finding> findings;
  for (const DeviceInfo& device : list_devices())
    findings.push_back({"device", device.state == DeviceState::kUsable ? "ok" : "note",
                        device.reason.empty() ? device.name : device.name + ": " + device.reason, device.remedy});
  if (findings.empty())
    findings.push_back({"devices", "ok", "none connected that a driver knows: dubsar devices list", ""});
  return findings;
}

/// A program on the PATH that films are made with.
Finding check_ffmpeg() {
  if (const auto program = find_ffmpeg()) return {"ffmpeg", "ok", program->string(), ""};
  return {"ffmpeg", "note", "not here: films are written as single pictures", "apt install ffmpeg"};
}

Finding check_headset() {
  const HeadsetFacts facts = headset_facts();
  return {"openxr", facts.present ? "ok" : "note", facts.words, ""};
}

Result<VerbResult> run() {
  std::vector<Finding> findings{
      check_gl(),
      check_memory_size(),
      check_disk(),
      {"processor", "ok", fmt::format("{} threads", std::thread::hardware_concurrency()), ""}};
  for (Finding& finding : check_hdf5_filters()) findings.push_back(std::move(finding));
  for (Finding& finding : check_models()) findings.push_back(std::move(finding));
  findings.push_back(check_cameras());
  for (Finding& finding : check_devices()) findings.push_back(std::move(finding));
  findings.push_back(check_windows());
  findings.push_back(check_ffmpeg());
  findings.push_back(check_headset());
  VerbResult result;
  result.json["findings"] = nlohmann::json::array();
  std::string missing;
  for (const Finding& f : findings) {
    result.json["findings"].push_back({{"name", f.name}, {"state", f.state}, {"detail", f.detail}, {"fix", f.fix}});
    result.text += fmt::format("{:<8} {:<16} {}{}{}\n", f.state, f.name, f.detail, f.fix.empty() ? "" : "; ", f.fix);
    if (f.state == "missing") missing += (missing.empty() ? "" : ", ") + f.name;
  }
  if (!missing.empty()) result.failure = Error{ErrorKind::kUnavailable, "doctor: missing here: " + missing};
  return result;
}
}  // namespace

Verb add_doctor_verb(Arguments program) {
  Arguments command = program.command("doctor", "check this machine: graphics, memory, disk, file filters");
  command.footer("Examples:\n  dubsar doctor\n  dubsar doctor --json -");
  return {command, [](const CommonOptions&, Progress&) { return run(); }};
}

}  // namespace dubsar::app
