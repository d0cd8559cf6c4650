#pragma once
// Kinds, sides, lines and the order of reading.

#include <vector>

#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar {

/// Kind by the direction of a tail to the line of text (radians, + upwards) and how long it is over its width:
/// horizontal within 22 degrees of the line, vertical of down, oblique between; what is short and points elsewhere, or
/// against the line, is a Winkelhaken; else odd (docs/edition.md).
WedgeKind wedge_kind(double angle, double length_per_width);

/// Gives each wedge its kind and side, and a line by where its body lies (line_cuts.h); then sorts them into the order
/// of reading: obverse, lower edge, reverse, upper edge, left edge, right edge; lines from above; along the line.
void arrange_text(std::vector<ScriptWedge>& wedges, const TextSides& sides);

}  // namespace dubsar
