#pragma once
// Impressions of a stylus on one side: where they are, and which way their tails point.
//
// A wedge is an imprint of three planes (Cammarosano, The Cuneiform Stylus, 2014): the steep head, and two flanks whose
// valley rises slowly along the tail. So it is deepest near its head, and its tail points from there to where it runs
// out.

#include <vector>

#include "core/mesh/writing/height_map.h"

namespace dubsar {

inline constexpr int kTailDirections = 24;
/// Steps of a height map over the width of a wedge's head, for which it is searched.
inline constexpr int kStepsPerWedge = 8;

struct FoundWedge {
  int tail = 0;            ///< of kTailDirections, counterclockwise from the right of the map
  float x = 0.f, y = 0.f;  ///< place on the map, 0 to 1 each way
};

/// Pits about as wide as kStepsPerWedge steps (a half to twice that), below the surface that a ball of four widths
/// touches from outside, each with the direction of the wedge of unit depth (three widths, three lengths) that fits it
/// best; what is deeper than that wedge counts half, as its neighbours only dig deeper. Places that look more to
/// another side are left out, and so are rims. At most 1500, the deepest. Deterministic. Cost: about .1 ms each.
std::vector<FoundWedge> find_impressions(const HeightMap& map);

}  // namespace dubsar
