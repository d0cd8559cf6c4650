#include "app/viewer/window_place.h"

#include <algorithm>

#include "display/panels/panel_profile.h"
#include "display/sinks/output_sink.h"

namespace dubsar::app {

Result<void> choose_place(const SessionOptions& session, std::optional<bool> fullscreen, WindowOptions& window) {
  DUBSAR_ASSIGN(const auto sink, make_sink(session.display, session.profile_folder, session.plugins));
  const SinkTraits traits = sink->traits();
  window.fullscreen = fullscreen.value_or(false);
  if (fullscreen || !traits.exact_pixels) return {};
  if (traits.name != "lenticular" || !window.monitor.empty()) {
    window.fullscreen = true;
    return {};
  }
  DUBSAR_ASSIGN(const auto monitors, list_monitors());
  for (const Monitor& monitor : monitors)
    if (monitor.width_px == traits.output.width && monitor.height_px == traits.output.height &&
        (window.monitor.empty() || !monitor.primary)) {
      window.monitor = monitor.name;
      window.fullscreen = true;
    }
  return {};
}

std::vector<std::string> displays_for_window(const std::string& first, const Screen& screen, bool stereo,
                                             const std::filesystem::path& profile_folder) {
  std::vector<std::string> out{first};
  const auto add = [&](std::string name) {
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(std::move(name));
  };
  for (const char* name : {"mono", "anaglyph", "side_by_side", "top_bottom", "interlaced"}) add(name);
  if (stereo) add("quad_buffer");
  if (const auto profiles = load_profiles(profile_folder))
    for (const PanelProfile& panel : *profiles)
      if (panel.width_px == screen.width_px && panel.height_px == screen.height_px && (panel.sheet || panel.optics))
        add("lenticular:" + panel.name);
  return out;
}

}  // namespace dubsar::app
