#pragma once
// What stands in the room of who wears a headset beside the object: both hands, controllers, a floor and a plinth.

#include <vector>

#include "display/headset/headset.h"
#include "display/render/scene.h"

namespace dubsar::app {

/// Lines in the screen frame, mm. `object_radius_mm`: of the sphere about the origin that the plinth ends under.
/// `see_through`: the room has a floor of its own.
std::vector<LinesItem> worn_room(const WearerFrame& wearer, double object_radius_mm, bool see_through);

}  // namespace dubsar::app
