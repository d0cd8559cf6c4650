#include <algorithm>
#include <array>

#include "devices/device_list.h"
#include "input/input_recording.h"
#include "input/input_source.h"
#include "input/plugins/source_plugin.h"
#include "input/simulated/scripted_source.h"
#include "input/source_spec.h"
#include "input/sources/device_source.h"
#include "input/sources/leapc_source.h"
#include "input/sources/openxr_source.h"
#include "input/sources/webcam_source.h"
#include "input/window_events.h"

namespace dubsar {
namespace {

using MakeSource = Result<std::unique_ptr<InputSource>> (*)(const InputConfig&);

struct NamedSource {
  std::string_view name;
  MakeSource make;
};

constexpr std::array<NamedSource, 2> kOfWindows{{{"mouse", make_mouse_source}, {"keyboard", make_keyboard_source}}};
constexpr std::array<NamedSource, 6> kOthers{{{"leapc", make_leapc_source},
                                              {"openxr", make_openxr_source},
                                              {"webcam", make_webcam_source},
                                              {"scripted", make_scripted_source},
                                              {"plugin", make_plugin_source},
                                              {"replay", make_replay_source}}};

/// "head" of "head:rift".
std::string_view family(const DriverEntry& driver) {
  return driver.input.source.substr(0, driver.input.source.find(':'));
}

/// The row that a spec names: "head:rift" by its first option.
Result<const DriverEntry*> find_device(const SourceSpec& spec) {
  std::string members;
  for (const DriverEntry& driver : driver_table()) {
    if (!can_be_opened(driver) || driver.input.source.empty() || family(driver) != spec.name) continue;
    if (driver.input.source == spec.name) return &driver;
    const std::string_view member = driver.input.source.substr(spec.name.size() + 1);
    if (!spec.options.empty() && !spec.options[0].value && spec.options[0].key == member) return &driver;
    members += (members.empty() ? "" : ", ") + std::string(member);
  }
  if (members.empty()) return nullptr;
  return fail(ErrorKind::kUsage, "input {}: found \"{}\", expected one of: {}; write {}:NAME", spec.name,
              spec.options.empty() ? "" : spec.options[0].key, members, spec.name);
}

}  // namespace

std::vector<std::string_view> input_source_names() {
  std::vector<std::string_view> names;
  const auto add = [&](std::string_view name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const NamedSource& source : kOfWindows) add(source.name);
  for (const DriverEntry& driver : driver_table())
    if (can_be_opened(driver) && !driver.input.source.empty()) add(family(driver));
  for (const NamedSource& source : kOthers) add(source.name);
  return names;
}

std::vector<std::string> present_inputs(const std::vector<DeviceInfo>& present, bool whole_screen) {
  std::vector<std::string> out;
  for (const DriverEntry* const driver : taken_unasked(present))
    if (whole_screen || !driver->input.whole_screen) out.emplace_back(driver->input.source);
  return out;
}

std::vector<std::string> present_inputs(bool whole_screen) { return present_inputs(list_devices(), whole_screen); }

Result<std::unique_ptr<InputSource>> make_input(std::string_view text, const InputConfig& base) {
  DUBSAR_ASSIGN(SourceSpec spec, parse_source(text));
  DUBSAR_ASSIGN(const DriverEntry* device, find_device(spec));
  InputConfig config = base;
  config.options = std::move(spec.options);
  std::unique_ptr<InputSource> source;
  if (device != nullptr) {
    DUBSAR_ASSIGN(source, make_device_source(*device, config));
  } else {
    MakeSource make = nullptr;
    for (const NamedSource& named : kOfWindows)
      if (named.name == spec.name) make = named.make;
    for (const NamedSource& named : kOthers)
      if (named.name == spec.name) make = named.make;
    if (make == nullptr)
      return fail(ErrorKind::kUsage, "no input is called \"{}\", expected one of: {}", spec.name,
                  fmt::join(input_source_names(), ", "));
    DUBSAR_ASSIGN(source, make(config));
  }
  DUBSAR_TRY(source->start());
  return source;
}

}  // namespace dubsar
