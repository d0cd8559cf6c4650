#include "app/commands/editor.h"

#include <algorithm>

namespace dubsar::app {

void Editor::change(Document next, std::string_view words, Way way) {
  next.now.zoom = std::clamp(next.now.zoom, steps_.zoom_min, steps_.zoom_max);
  way_ = way;
  history_.change(std::move(next), std::string(words), merge_);
}

bool Editor::has_work() const {
  const Document& now = document();
  return now.measures != opened_.measures || now.notes != opened_.notes || now.keyframes != opened_.keyframes ||
         now.clips != opened_.clips;
}

bool Editor::undo() {
  way_ = Way::kGlide;
  return history_.undo();
}

bool Editor::redo() {
  way_ = Way::kGlide;
  return history_.redo();
}

}  // namespace dubsar::app
