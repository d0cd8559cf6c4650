#pragma once
// The ball on the stage that shows where the light stands, while it moves.

#include "app/document/camera_pose.h"

namespace dubsar::app {

/// Draws it into the current Dear ImGui frame; its lower right corner stands at `right`, `bottom`.
void draw_light_ball(const LightPlace& light, float right, float bottom);

}  // namespace dubsar::app
