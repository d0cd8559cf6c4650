#pragma once
// Which movement does what, and how strongly: data that a museum can change without a compiler.

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "input/gestures/gesture_options.h"
#include "input/input_event.h"

namespace dubsar {

/// What a movement does; what keys do are commands, which the mapping knows by their names only.
enum class Action {
  kNone,
  kRotate,      ///< drags and SpaceMice: the object follows the hand
  kRotateFine,  ///< a quarter as fast
  kPan,
  kZoom,
  kZoomAndRoll,  ///< two hands
  kLight,
  kNextSide,  ///< quarter turn to the next axis-parallel view
  kSelect,
  kReset,
};
std::string_view action_name(Action action) noexcept;

/// Who can steer the view.
enum class Control { kNone, kMouse, kKeyboard, kSpaceMouse, kHands };

struct HandMapping {
  Action grab{}, pull{}, two_hands{}, pinch{}, swipe{}, dwell{};
  double turn_deg_per_mm = 0, light_deg_per_mm = 0;
  double inertia_s = 0;               ///< decay time of the turn after a throw; 0: none
  double fastest_turn_deg_per_s = 0;  ///< the view never turns faster under a hand, whatever the tracker says
  double fastest_zoom_per_s = 0;      ///< factor per second
  glm::dvec3 zone_min_mm{0.0}, zone_max_mm{0.0};  ///< where hands act, screen frame
  glm::dvec3 entry_margin_mm{0.0};                ///< so far outside of it a hand may show itself first
  glm::dvec3 enter_min_mm() const { return zone_min_mm - entry_margin_mm; }
  glm::dvec3 enter_max_mm() const { return zone_max_mm + entry_margin_mm; }
};

struct MouseMapping {
  std::map<std::string, Action> chords;  ///< "left", "shift+left", "ctrl+left", "middle", "right", "wheel" ...
  double turn_deg_per_px = 0, light_deg_per_px = 0, zoom_per_100_px = 0, zoom_per_notch = 0;
};

struct SpaceMouseMapping {
  double turn_deg_per_s = 0, pan_per_s = 0, zoom_per_s = 0, dead_zone = 0;
  bool one_axis = false;  ///< only the strongest of the six counts
};

struct Mapping {
  HandMapping hands;
  GestureOptions gestures;
  MouseMapping mouse;
  std::map<std::string, std::string> keys;  ///< changes: commands by key; "none" takes a key's own command away
  double key_step_deg = 0, key_zoom = 0;
  SpaceMouseMapping space_mouse;
  double zoom_min = 0, zoom_max = 0;
  std::vector<Control> priority;  ///< first wins
  TimestampNs handover_ns = 0;    ///< a lower control gets the view this long after a higher one rests
};

/// The mapping of the program (input/navigation/mappings/default.json).
Result<Mapping> default_mapping();

/// That for places where nobody was told (input/navigation/mappings/gallery.json).
Result<Mapping> gallery_mapping();

/// The default with the changes that the JSON text makes: only what differs needs to be said, null removes a key or a
/// mouse chord. kConfig, by name and range, for unknown names, wrong types and figures out of range; whether commands
/// exist is for their table to say.
Result<Mapping> parse_mapping(std::string_view json_text, std::string_view source);

/// The action of a mouse chord ("ctrl+left"), or kNone.
Action chord_action(const MouseMapping& mapping, std::uint8_t modifiers, std::string_view what);

}  // namespace dubsar
