// A drawer that the program does not have: what one touches (built_additions_test.cpp).

#include "app/panels/panel_kit.h"

namespace dubsar::app {

void draw_breaks(const PanelContext& context) {
  say_dim(tr("breaks.none"));
  button(context, tr("breaks.find"), "fog 30", false);
}

}  // namespace dubsar::app
