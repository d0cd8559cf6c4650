#include "app/commands/editor.h"

#include <algorithm>

namespace dubsar::app {

void Editor::change(Document next, std::string_view words, Way way) {
  next.now.zoom = std::clamp(next.now.zoom, steps_.zoom_min, steps_.zoom_max);
  way_ = way;
  history_.change(std::move(next), std::string(words), merge_);
}

bool Editor::has_work() const {
  const auto holds = [](const Document& d) {
    return !d.measures.empty() || !d.notes.empty() || !d.keyframes.empty() || !d.clips.empty();
  };
  return holds(document()) || holds(opened_);
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
