#pragma once
// Cursors of hands: rings before the panel, so that people see that they are seen.

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "app/stage/object_places.h"
#include "display/render/scene.h"
#include "input/people/hand_marks.h"

namespace dubsar::app {

/// Where a panel shows the places of a zone: the zone's middle at the panel's middle, its sides a little within the
/// panel's, its depth squeezed into what eyes fuse with ease (0.12 of the height before the panel to 0.05 behind).
struct CursorScene {
  HandZone zone{};
  glm::dvec2 window_mm{1.0}, middle_mm{0.0};
};
glm::dvec3 cursor_place_mm(const CursorScene& scene, const glm::dvec3& place_m) noexcept;

/// One ring a hand that closes as the hand does, amber when it may take hold or holds, grey otherwise; around it the
/// share of a selection by holding still.
std::vector<LinesItem> hand_cursors(const CursorScene& scene, std::span<const HandMark> hands);

/// A ring that stays where a hand sank out of sight, and an arrow that rises from it: `seconds` of it are over. It
/// comes slowly, and never blinks.
std::vector<LinesItem> higher_arrow(const CursorScene& scene, const glm::dvec3& place_m, double seconds);

/// Where the nearest hand that holds or may take hold would take the object: on it, on the side where the hand is, the
/// brighter the nearer the hand's ring is. Strength 0: nobody could.
Glow object_glow(const CursorScene& scene, std::span<const HandMark> hands, std::span<const ScreenRect> objects);

/// Follows a glow without a jump: it comes and goes, and moves on, within a third of a second. One thread.
class EasedGlow {
 public:
  const Glow& update(const Glow& wanted, double dt_s);

 private:
  Glow shown_{};
};

}  // namespace dubsar::app
