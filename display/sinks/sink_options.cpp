#include "display/sinks/sink_options.h"

#include <algorithm>

namespace dubsar {

int take_choice(SinkConfig& config, std::initializer_list<std::string_view> choices) {
  for (auto option = config.options.begin(); option != config.options.end(); ++option) {
    const auto* found = std::find(choices.begin(), choices.end(), option->first);
    if (found == choices.end() || !option->second.empty()) continue;
    config.options.erase(option);
    return static_cast<int>(found - choices.begin());
  }
  return 0;
}

Result<std::optional<PanelProfile>> take_panel(SinkConfig& config) {
  std::string name, file;
  std::erase_if(config.options, [&](const auto& option) {
    const auto& [key, value] = option;
    std::string* const place = key == "calibration" ? &file : key == "panel" || value.empty() ? &name : nullptr;
    if (place == nullptr || !place->empty() || (key == "calibration" && value.empty())) return false;
    *place = value.empty() ? key : value;
    return true;
  });
  if (name.empty() && file.empty()) return std::nullopt;
  DUBSAR_ASSIGN(PanelProfile profile, choose_panel(config.profile_folder, name, file));
  return profile;
}

Result<void> expect_no_more(const SinkConfig& config, std::string_view sink, std::string_view known) {
  if (config.options.empty()) return {};
  const auto& [key, value] = config.options.front();
  return fail(ErrorKind::kUsage, "display {}: option \"{}{}{}\" is not known or given twice, expected {}", sink, key,
              value.empty() ? "" : "=", value, known);
}

std::array<View, 2> stereo_views(const Screen& screen, const Viewer& viewer) {
  const WindowRect window = screen.window_rect();
  const CameraPair cameras = camera_pair(viewer);
  return {viewer_view(window, viewer, cameras.left_mm), viewer_view(window, viewer, cameras.right_mm)};
}

}  // namespace dubsar
