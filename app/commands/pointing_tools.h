#pragma once
// What a click on the surface does: with each tool it takes so many places and does something with them. Without one,
// "turn", clicks are nobody's.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "app/commands/editor.h"

namespace dubsar::app {

struct PointingTool {
  std::string_view name;  ///< "tool.NAME" of the table of texts says it, "hint.NAME" what to click
  std::string_view key;
  std::size_t places;  ///< that it waits for
  /// Does it. kUsage where that cannot be done with these places.
  Result<void> (*use)(Editor& editor, const std::vector<SurfacePin>& pins);
};

/// In the order of their buttons.
std::span<const PointingTool> pointing_tools() noexcept;
/// Null: there is none of this name.
const PointingTool* pointing_tool(std::string_view name) noexcept;

}  // namespace dubsar::app
