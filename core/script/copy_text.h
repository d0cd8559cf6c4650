#pragma once
// The text of a tablet beside its hand copy.

#include <span>
#include <string>
#include <vector>

#include "core/script/copy_sheet.h"
#include "core/script/wedge.h"

namespace dubsar {

/// A line of a transliteration, in the order of reading.
struct CopyTextLine {
  TextSide side = TextSide::kObverse;
  std::string number;  ///< "3'"
  std::string text;    ///< UTF-8
};

/// Makes room at the right of a sheet of hand_copy() and sets the lines there, side by side with their names, as a
/// layer "text". Where a side has as many lines as were found on it, the numbers beside its drawing are those of the
/// text. Returns the sides on which the counts differ.
std::vector<TextSide> add_text(CopySheet& sheet, std::span<const CopyTextLine> lines);

}  // namespace dubsar
