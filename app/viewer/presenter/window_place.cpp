#include "app/viewer/presenter/window_place.h"

#include <algorithm>

namespace dubsar::app {

Result<void> choose_place(const SinkTraits& traits, std::optional<bool> fullscreen, WindowOptions& window) {
  window.fullscreen = fullscreen.value_or(false);
  if (fullscreen || !traits.exact_pixels) return {};
  if (!traits.own_pixels || !window.monitor.empty()) {
    window.fullscreen = true;
    return {};
  }
  DUBSAR_ASSIGN(const auto monitors, list_monitors());
  for (const Monitor& monitor : monitors) {
    if (PixelSize{monitor.width_px, monitor.height_px} != traits.output) continue;
    if (!window.monitor.empty() && monitor.primary) continue;  // panels are seldom where people work
    window.monitor = monitor.name;
    window.fullscreen = true;
  }
  return {};
}

std::vector<SinkSpec> displays_for_window(const SinkSpec& first, const SinkCatalog& catalog, const WindowKind& window) {
  constexpr double kLeastShutterHz = 100.0;  // fields that take turns more slowly than 50 times a second flicker
  std::vector<SinkSpec> out{first};
  const auto fits = [&](const SinkTraits& traits) {
    const bool pixels =
        !traits.own_pixels || traits.output == PixelSize{window.screen.width_px, window.screen.height_px};
    const bool turns = traits.fields < 2 || window.refresh_hz >= kLeastShutterHz;
    return pixels && turns && (!traits.stereo_visual || window.stereo) && !traits.worn;
  };
  for (const SinkSpec& spec : catalog.offered()) {
    if (std::find(out.begin(), out.end(), spec) != out.end()) continue;
    const auto sink = catalog.make(spec);
    if (sink && fits((*sink)->traits())) out.push_back(spec);
  }
  return out;
}

}  // namespace dubsar::app
