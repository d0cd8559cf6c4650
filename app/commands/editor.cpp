#include "app/commands/editor.h"

#include <algorithm>

#include "app/document/join.h"

namespace dubsar::app {

void Editor::change(Document next, std::string_view words, Transition transition) {
  next.now.zoom = std::clamp(next.now.zoom, steps_.zoom_min, steps_.zoom_max);
  transition_ = transition;
  history_.change(std::move(next), std::string(words), merge_);
}

void Editor::join(Document next) {
  const Document before = document();
  const Document with = next;
  history_.change_all(std::move(next), [&](const Document& state) { return app::join_marks(&before, state, with); });
  opened_ = app::join_marks(&before, opened_, with);
}

bool Editor::has_work() const {
  Document now = document();
  now.now = opened_.now;
  return now != opened_;
}

bool Editor::undo() {
  transition_ = Transition::kGlide;
  return history_.undo();
}

bool Editor::redo() {
  transition_ = Transition::kGlide;
  return history_.redo();
}

}  // namespace dubsar::app
