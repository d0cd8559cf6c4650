#pragma once
// How a line is called in print: "o. 3", "r. ii 4'", "le.e. 1".

#include <optional>
#include <string>
#include <string_view>

#include "core/edition/text_passages.h"

namespace dubsar {

/// "o." of obverse, lo.e. bottom, r. reverse, u.e. top, le.e. left, r.e. right; others as they are, with a colon.
std::string side_abbreviation(std::string_view surface);

/// The object is not told.
std::string line_label(const TextSpot& spot);

/// The way back; also o, obv., rev., b.e., t.e., l.e. and a number alone, which is on the obverse. None: it is no label
/// of a line. The object is the tablet.
std::optional<TextSpot> spot_of_label(std::string_view label);

}  // namespace dubsar
