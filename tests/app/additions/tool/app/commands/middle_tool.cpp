// A tool that the program does not have: what one touches (built_additions_test.cpp).

#include "app/commands/editor.h"
#include "app/words/text.h"

namespace dubsar::app {

/// Says where the middle of two places is.
Result<void> use_middle(Editor& editor, const std::vector<SurfacePin>& pins) {
  const glm::dvec3 at = 0.5 * (pins[0].at_mm + pins[1].at_mm);
  editor.place().say(tr("middle.at", at.x, at.y));
  return {};
}

}  // namespace dubsar::app
