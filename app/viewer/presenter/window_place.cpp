#include "app/viewer/presenter/window_place.h"

#include <algorithm>

namespace dubsar::app {

Result<void> choose_place(const SinkTraits& traits, std::optional<bool> fullscreen, WindowOptions& window) {
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

std::vector<SinkSpec> displays_for_window(const SinkSpec& first, const Screen& screen, bool stereo,
                                          const PanelSet& panels) {
  std::vector<SinkSpec> out{first};
  const auto add = [&](SinkSpec spec) {
    if (std::find(out.begin(), out.end(), spec) == out.end()) out.push_back(std::move(spec));
  };
  for (const char* name : {"mono", "anaglyph", "side_by_side", "top_bottom", "interlaced"}) add({name});
  if (stereo) add({"quad_buffer"});
  for (const PanelProfile& panel : panels.profiles)
    if (panel.width_px == screen.width_px && panel.height_px == screen.height_px && (panel.sheet || panel.optics))
      add({"lenticular", {{panel.name}}});
  return out;
}

}  // namespace dubsar::app
