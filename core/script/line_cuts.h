#pragma once
// Lines of text on the sides of a tablet, from where its wedges lie.

#include <vector>

namespace dubsar {

/// What a wedge covers of a side: mm along the lines, and from low to high up the side.
struct TextBody {
  double along = 0.0, low = 0.0, high = 0.0;
};

/// The line of each body of each side, from 1 at the top. A side is cut into bands, one a line, none of them empty: the
/// cuts are those that leave least to tell of where bodies stand in their bands and how far they reach beyond them
/// (dynamic programming), in bands of nearly one height, which is one for the whole tablet: 2 to 6 widths of a head.
/// Lines may climb by up to 5 degrees and bend. `width_mm`: of a usual head. Cost: some ms a hundred bodies.
std::vector<std::vector<int>> lines_of(const std::vector<std::vector<TextBody>>& sides, double width_mm);

}  // namespace dubsar
