#pragma once
// Cameras that show a whole object: which side is "front", and how far away the eye is. Pure maths.

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "display/optics/view.h"

namespace dubsar {

/// Axis-aligned box in mm.
struct Box {
  glm::dvec3 min{0.0}, max{0.0};
  glm::dvec3 size() const { return max - min; }
  glm::dvec3 centre() const { return 0.5 * (min + max); }
  /// 0..7; bit 0 is set on the side of max.x, bit 1 of max.y, bit 2 of max.z.
  glm::dvec3 corner(int i) const { return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z}; }
};

/// The object's own directions, unit, right-handed: `front` points from the object to the viewer of the front view.
struct ObjectFrame {
  glm::dvec3 right, up, front;
};

/// The front view looks along the thinnest axis of the box, so that it shows a tablet's broad face; "up" is +z, the
/// rotation axis of most scanners, or +y when the box is thinnest in z. So (right, up, front) is (x, y, z) for z,
/// (x, z, -y) for y and (y, z, x) for x. Of equally thin axes the later one wins. Obverse and reverse cannot be known.
ObjectFrame object_frame(const Box& box);

/// Where the camera stands, seen from the object. Degrees. Azimuth turns it from the front towards the object's right,
/// elevation lifts it; roll turns the picture clockwise.
struct ViewDirection {
  double azimuth_deg = 0.0, elevation_deg = 0.0, roll_deg = 0.0;
};

/// Directions of the picture in world coordinates: to its right, up, and from the object to the camera.
ObjectFrame picture_frame(const ObjectFrame& object, const ViewDirection& direction);

/// "front" "back" (azimuth 180) "left" (-90) "right" (90) "top" (elevation 90, front side down) "bottom" (-90, front
/// side up), or "orbit:AZIMUTH,ELEVATION[,ROLL]". kUsage for anything else.
Result<ViewDirection> parse_view_direction(std::string_view text);

struct CameraOptions {
  ViewDirection direction{};
  std::optional<ObjectFrame> object{};  ///< which way the object's front is; none: object_frame() of its box
  bool perspective = false;
  double field_of_view_deg = 20.0;  ///< perspective: of the longer picture side, 1..120
  double margin = 0.05;             ///< free border, as a fraction of the picture side, 0..0.45
  double mm_per_pixel = 0.0;        ///< orthographic: exact scale; 0: fit the object to the picture
  int width = 1200, height = 1200;  ///< pixels; both 0 with mm_per_pixel: as large as the object needs
  bool whole = false;               ///< kUsage where the scale does not leave room for all of the object
};

struct Camera {
  View view;                  ///< world = mm of the scan
  int width = 0, height = 0;  ///< pixels
  double mm_per_pixel = 0.0;  ///< orthographic: everywhere; perspective: in the plane through the object's centre
};

/// The camera that shows `box` whole and centred. kUsage when the options contradict each other or the box is empty
/// or not finite.
Result<Camera> fit_camera(const Box& box, const CameraOptions& options);

}  // namespace dubsar
