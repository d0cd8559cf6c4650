#pragma once
// The box of cuts over the picture: its edges, and a handle in the middle of each side.

#include "app/document/box_picture.h"

namespace dubsar::app {

/// Draws it into the current Dear ImGui frame of this size, behind all panels.
void draw_box(const BoxPicture& box, float width, float height);

}  // namespace dubsar::app
