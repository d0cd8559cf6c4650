// dubsar doctor: what this machine has, what is missing, and how to mend it.

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/cli/config_folder.h"
#include "app/cli/verb.h"
#include "app/publish/video.h"
#include "core/base/numbers/units.h"
#include "core/base/system/budget.h"
#include "core/base/system/child_process.h"
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

Finding headset_here() {
  const HeadsetFacts facts = headset_facts();
  return {"openxr", facts.present ? "ok" : "note", facts.words, ""};
}

/// In a process of its own: the runtime is other people's code, which may crash or hang.
Finding check_headset() {
  constexpr auto kLongest = std::chrono::seconds(15);
  std::error_code ignored;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
  const auto note = [](std::string words) { return Finding{"openxr", "note", std::move(words), ""}; };
  auto child = ChildProcess::start({program, "doctor", "--headset", "--json", "-"});
  if (!child) return note(child.error().message);
  std::array<std::string, 2> said;
  for (const auto end = std::chrono::steady_clock::now() + kLongest; child->read(said);)
    if (std::chrono::steady_clock::now() > end) {
      child->kill();
      return note(fmt::format("the runtime does not answer within {} s; start or restart it", kLongest.count()));
    }
  const int code = child->wait();
  const nlohmann::json answer = nlohmann::json::parse(said[0], nullptr, false);
  if (code == 0 && answer.is_object() && answer.contains("findings"))
    for (const nlohmann::json& each : answer["findings"])
      return {"openxr", each.value("state", "note"), each.value("detail", ""), ""};
  return note(code > 128
                  ? fmt::format("the runtime crashes when it is asked (signal {}); mend or replace it", code - 128)
                  : fmt::format("the runtime could not be asked (code {})", code));
}

std::vector<Finding> check_all() {
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
  return findings;
}

Result<VerbResult> run(bool headset) {
  const std::vector<Finding> findings = headset ? std::vector{headset_here()} : check_all();
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
  const auto headset = std::make_shared<bool>(false);
  command.flag("--headset", *headset, "only the headset and its runtime, loaded into this very process");
  command.footer("Examples:\n  dubsar doctor\n  dubsar doctor --json -");
  return {command, [headset](const CommonOptions&, Progress&) { return run(*headset); }};
}

}  // namespace dubsar::app
