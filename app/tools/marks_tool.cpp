#include "app/tools/marks_tool.h"

#include "app/stage/marks.h"
#include "core/base/system/log.h"

namespace dubsar::app {

void MarksTool::contribute(Shown& shown) {
  const auto marks = [&](const Document& document, const PartLooks& parts) {
    return marks_of(document, scene_.ui(), parts, *font_, scene_.window.letters);
  };
  shown.marks = marks(*scene_.seen, shown.parts);
  if (!scene_.ui().compared) return;
  const Document& kept = *scene_.ui().compared;  // the state that was put beside the present one
  auto compared = std::make_shared<Shown>(scene_.shown(kept, scene_.ui().linked ? shown.view : view_of(kept)));
  compared->marks = marks(kept, compared->parts);
  shown.compared = std::move(compared);
}

void MarksTool::point() {
  OverlayMarks marks;
  const Pointing& seen = scene_.ui().pointing;
  if ((seen.magnify > 0 || seen.cursor) && seen.at) {
    const auto place = scene_.stage->place_at(*seen.at);
    if (!place) log_warning("{}", place.error().message);
    if (place && *place) {
      if (seen.magnify > 0) marks.magnifier = Magnifier{**place, seen.magnify};
      if (seen.cursor) marks.cursor_mm = **place;
    }
  }
  scene_.stage->set_overlay_marks(marks);
}

}  // namespace dubsar::app
