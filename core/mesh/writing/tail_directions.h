#pragma once
// What a script of wedges says of how a text stands: heads are at the left of horizontal wedges and at the top of
// vertical ones, so tails point right and down, seldom obliquely, and up or left by mistake alone.

#include <array>
#include <span>

#include "core/mesh/writing/impressions.h"

namespace dubsar {

/// Logarithms of likelihood ratios against marks without a direction, for text whose right is 0 to 3 quarters of a turn
/// counterclockwise from the right of the map; and for the mirror image of such a text, by where its right would be if
/// it were none (its wedges run to the left then).
struct TextTurns {
  std::array<double, 4> written{}, mirrored{};
};

/// Of the impressions of one side. The share of marks that are no wedges of the text is not known: it is averaged over.
/// No impressions: zeros.
TextTurns text_turns(std::span<const FoundWedge> impressions);

}  // namespace dubsar
