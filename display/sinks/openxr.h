#pragma once
// A head-mounted display through the machine's OpenXR runtime: the object stands life size before the wearer, or in
// the panel that the runtime shows pictures on, and the window shows what the left eye sees.

#include "display/headset/headset.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Where the middle of the object is put when the wearer says where "before me" is.
struct HeadsetPlace {
  double distance_m = 0.5;     ///< before the wearer's eyes, level
  double height_m = 0.85;      ///< over the floor: a hand's breadth over a table. Without a known floor:
  double below_m = 0.2;        ///< under the eyes
  double steepest_deg = 25.0;  ///< under straight ahead: half of what a headset shows below; a table is lifted to it
  bool see_through = false;    ///< the room is seen where nothing is drawn
};

/// The room's frame from the screen's: origin at the object's middle, +Y up, +Z level towards the wearer, for a head
/// that looks along its -Z. Of a head that looks straight up or down, its +Y says where "before" is.
Pose room_from_screen(const Pose& head, const std::optional<double>& floor_m, const HeadsetPlace& place);

/// Of a runtime whose display is a panel on a desk: the panel's middle and its attitude, +Z towards the wearer. Both
/// eyes' fields then end at the same edges, however far apart the eyes are. None: a headset, which has no such edges.
std::optional<Pose> panel_before(const std::array<HeadsetEye, 2>& eyes);

/// Poses moved from the room's frame to the screen's.
WearerFrame moved_to_screen(const WearerFrame& room, const Pose& room_from_screen);

/// The camera of an eye, whose frame is the screen's: millimetres, near and far planes of 30 mm and 20 m.
View eye_view(const HeadsetEye& eye);

/// Options: distance= (m), height= (m over the floor), blend=opaque|alpha|additive (see-through headsets),
/// graphics=gl|vulkan|any (default: OpenGL, and Vulkan where the runtime takes none). Waits for a runtime and a headset
/// that are not there yet. kUnavailable: a build without OpenXR.
Result<std::unique_ptr<OutputSink>> make_openxr_sink(SinkOptions options);

/// The same with a headset of one's own.
std::unique_ptr<OutputSink> openxr_sink(std::unique_ptr<Headset> headset, const HeadsetPlace& place = {});

}  // namespace dubsar
