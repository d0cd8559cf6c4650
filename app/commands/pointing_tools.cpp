#include "app/commands/pointing_tools.h"

#include <algorithm>
#include <array>

namespace dubsar::app {

/// Name, key, places. Result<void> use_NAME(Editor&, const std::vector<SurfacePin>&) does it, in a file of this room.
#define DUBSAR_TOOLS(X)      \
  X(distance, "d", 2)        \
  X(angle, "a", 3)           \
  X(depth, "w", 1)           \
  X(profile, "f", 2)         \
  X(note, "n", 1)            \
  X(line, "i", 2)            \
  X(slice, "j", 1)           \
  X(wedge, "shift+w", 1)     \
  X(wedge_add, "shift+a", 3) \
  X(wedge_move, "shift+m", 2)

#define DUBSAR_TOOL_USE(name, key, places) Result<void> use_##name(Editor&, const std::vector<SurfacePin>&);
DUBSAR_TOOLS(DUBSAR_TOOL_USE)
#undef DUBSAR_TOOL_USE

std::span<const PointingTool> pointing_tools() noexcept {
  static constexpr auto kTools = std::to_array<PointingTool>({
#define DUBSAR_TOOL_ROW(name, key, places) {#name, key, places, use_##name},
      DUBSAR_TOOLS(DUBSAR_TOOL_ROW)
#undef DUBSAR_TOOL_ROW
  });
  return kTools;
}

const PointingTool* pointing_tool(std::string_view name) noexcept {
  const auto all = pointing_tools();
  const auto at = std::find_if(all.begin(), all.end(), [&](const PointingTool& tool) { return tool.name == name; });
  return at == all.end() ? nullptr : &*at;
}

}  // namespace dubsar::app
