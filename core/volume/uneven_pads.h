#pragma once
// Paddings that are not one value: numbers beside each other (0 to 2, as of pictures that were packed with a loss), and
// several paddings that meet in one slice.

#include <set>
#include <vector>

namespace dubsar {

/// Values at the borders of several slices.
struct BorderValues {
  std::set<float> frequent;  ///< a hundredth of one border has them
  std::set<float> whole;     ///< all, where they are whole numbers
};

/// Sets of values that may be one padding: whole numbers without a gap that hold a frequent one, 32 at most; the
/// smallest value first. A value by itself is one, too.
std::vector<std::vector<float>> pad_runs(const BorderValues& values);

/// Unions that may be one padding: of what was `found` already with one of `runs`, or where nothing was, of two of
/// them; at most 16. None where there are fewer than two runs or more than 6.
std::vector<std::vector<float>> pad_unions(const std::vector<std::vector<float>>& runs, const std::set<float>& found);

}  // namespace dubsar
