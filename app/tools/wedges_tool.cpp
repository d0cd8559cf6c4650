#include "app/tools/wedges_tool.h"

#include "app/stage/marks.h"

namespace dubsar::app {

void WedgesTool::contribute(Shown& shown) {
  if (!scene_.ui().pointing.wedges) return;
  for (LinesItem& lines : wedge_lines(*scene_.seen, scene_.ui().pointing.wedge, shown.parts, scene_.window.letters))
    shown.marks.lines.push_back(std::move(lines));
}

}  // namespace dubsar::app
