#pragma once
// Films: how an object is shown at some times, and smoothly in between. Plain values.

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/camera_pose.h"
#include "core/base/result.h"

namespace dubsar::app {

/// A part of the object at some time. Parts that a keyframe does not name are as the document has them.
struct KeyedPart {
  std::string name;
  double opacity = 1.0;  ///< 0..1; 0: it is not there
  glm::dvec3 offset_mm{0.0};
  friend bool operator==(const KeyedPart&, const KeyedPart&) = default;
};

/// How a style is shaded at some time.
struct KeyedShade {
  std::string other{};    ///< a second style that it is mixed with; empty: none
  double share = 0.0;     ///< of that, 0..1
  double radiance = 0.0;  ///< radiance scaling, 0..2
  double strength = 1.0;  ///< of the style's colours, 0..2
  friend bool operator==(const KeyedShade&, const KeyedShade&) = default;
};

struct Keyframe {
  double time_s = 0.0;
  CameraPose camera;
  LightPlace light;
  double unpack = 0.0;  ///< 0 to 1
  std::string style;    ///< from this time on; empty: as before
  std::vector<KeyedPart> parts;
  std::optional<KeyedShade> shade{};  ///< none: as before; films of version 1 have none
  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

struct Document;

/// How a document looks now, as a keyframe, and a document that looks like one.
Keyframe keyframe_of(const Document& document, double time_s);
void show_keyframe(Document& document, const Keyframe& frame);

/// How things stand at `time_s`: exactly a keyframe at its time, before the first and after the last as those. Cameras,
/// lights, parts, shares of a second style and radiance move without jumps of speed (piecewise cubic, the speed at a
/// key that of its neighbours, and none at the ends), turns the shorter way round; numbers never leave the range
/// between two keys (F. Fritsch, R. Carlson: Monotone piecewise cubic interpolation, 1980). From one second style to
/// another the first fades out until half-way, then the other one in. `keys` are in rising order of time, at least one.
Keyframe moment_at(std::span<const Keyframe> keys, double time_s);

/// From the first key to the last; 0 for fewer than two.
double film_length_s(std::span<const Keyframe> keys);

/// As JSON, exactly: {"format": "dubsar film", "version": 2, "keyframes": [...]}. Version 1, which knew no "shade", is
/// read as well.
std::string format_film(std::span<const Keyframe> keys);
/// kBadData in one sentence for text that is no film, a newer version, no keyframe, times that do not rise, or figures
/// out of range. A document's text is a film as well: that of its keyframes.
Result<std::vector<Keyframe>> parse_film(std::string_view text, std::string_view source);

}  // namespace dubsar::app
