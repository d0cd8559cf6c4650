#pragma once
// Lines of text on one side, from where its wedges lie.

#include <vector>

namespace dubsar {

/// What a wedge covers of a side: mm along the lines, and from low to high up the side.
struct TextBody {
  double along = 0.0, low = 0.0, high = 0.0;
};

/// The line of each body, from 1 at the top. Lines may climb up to 5 degrees; the distance between them is that after
/// which the bodies' sum across the side repeats most clearly, at least 2 and at most 8 widths of a head; each cut is
/// then moved to where least is written. Lines without a body have no number.
std::vector<int> lines_of(const std::vector<TextBody>& bodies, double width_mm);

}  // namespace dubsar
