#include <array>

#include "devices/real/real_devices.h"
#include "input/input_recording.h"
#include "input/input_source.h"
#include "input/plugins/source_plugin.h"
#include "input/simulated/scripted_source.h"
#include "input/source_spec.h"
#include "input/sources/head_source.h"
#include "input/sources/leap_source.h"
#include "input/sources/leapc_source.h"
#include "input/sources/puck_sources.h"
#include "input/sources/webcam_source.h"
#include "input/window_events.h"

namespace dubsar {
namespace {

constexpr std::array<InputBackend, 11> kSources{{
    {"mouse", "turn, shift or middle: move, ctrl or wheel: zoom, right: light", true, make_mouse_source},
    {"keyboard", "arrows turn, + and - zoom, home resets, backspace undoes", true, make_keyboard_source},
    {"spacemouse", "a 3Dconnexion puck turns, moves and zooms", true, make_spacemouse_source},
    {"spacenav", "the same through spacenavd: spacenav:socket=PATH", true, make_spacenav_source},
    {"leap", "hands over a Leap Motion Controller: leap:at=X/Y/Z,turn=X/Y/Z", true, make_leap_source},
    {"leapc", "hands from Ultraleap's tracking service: leapc[:library=FILE,mode=desktop,at=X/Y/Z,turn=X/Y/Z]", false,
     make_leapc_source},
    {"head", "a tracked head: head:opentrack, head:vrpn, head:rift, head:xreal", true, make_head_source},
    {"webcam",
     "the head from a face, with :hands hands too: webcam[:hands,device=/dev/video0,hfov=60,ipd=63,at=X/Y/Z,tilt=0]",
     false, make_webcam_source},
    {"scripted", "simulated people: scripted:FILE.json", false, make_scripted_source},
    {"plugin", "a shared library: plugin:FILE.so[,at=X/Y/Z,turn=X/Y/Z,...]", false, make_plugin_source},
    {"replay", "a recording of any input: replay:FILE.jsonl", false, make_replay_source},
}};

}  // namespace

std::span<const InputBackend> input_sources() { return kSources; }

std::vector<std::string> present_inputs() { return present_inputs(list_real_devices()); }

std::vector<std::string> present_inputs(const std::vector<DeviceInfo>& present) {
  std::vector<std::string> out;
  const auto add = [&](std::string_view driver, std::string_view spec) {
    for (const DeviceInfo& device : present)
      if (device.driver == driver && device.state == DeviceState::kUsable) return out.emplace_back(spec), true;
    return false;
  };
  if (!add("spacenav", "spacenav")) add("spacemouse", "spacemouse");  // the daemon holds the puck
  add("leap", "leap");
  add("rift", "head:rift");
  add("xreal", "head:xreal");
  return out;
}

Result<std::unique_ptr<InputSource>> make_input(std::string_view text, const InputConfig& base) {
  DUBSAR_ASSIGN(const SourceSpec spec, parse_source(text));
  DUBSAR_ASSIGN(const InputBackend* backend, find_backend(input_sources(), spec.name, "input"));
  InputConfig config = base;
  for (const Option& option : spec.options) config.options.emplace_back(option.key, option.value.value_or(""));
  DUBSAR_ASSIGN(auto source, backend->create(config));
  DUBSAR_TRY(source->start());
  return source;
}

}  // namespace dubsar
