#pragma once
// The lines of a tablet's text in a document: notes that run along the clay, each with the number that it has on its
// side, and a transliteration that was read in and waits to be pinned.

#include <array>
#include <string>
#include <vector>

#include "app/document/document.h"
#include "core/edition/text_passages.h"

namespace dubsar::app {

bool is_text_line(const Note& note);

/// Where a line stands in the text, by its label and part; none: its label is no number of a line.
std::optional<TextSpot> spot_of(const Note& note);

/// Lines that have a number, as they are read.
std::vector<TextPassage> passages_of(const Document& document);

/// Lines of the transliteration that was read in which no note has.
std::vector<TextPassage> waiting_lines(const Document& document);

/// Takes a line in that lies on a side ("obverse" ...): its number follows from its place. Below all others of the side
/// it is the next one, or the next that waits, whose text it takes; between others it gets the number of the one below
/// it, which moves on with those that follow. Which way is down is told by the line itself: it runs to the right.
void put_line(Document& document, Note line, const std::string& side);

/// Where the line below is to be expected, as beginning and end in mm of the scan: as far below as this one is below
/// the one before it, else kUsualInterval. `share` of that way; negative: above.
inline constexpr double kUsualIntervalMm = 5.0;  ///< of Old Babylonian and Old Assyrian letters (docs/edition.md)
std::array<glm::dvec3, 2> place_beside(const Document& document, std::size_t line, double share = 1.0);

/// The transliteration: what was read in, changed by the lines of the document that have a text.
AtfFile atf_of(const Document& document);

/// Takes a text of ATF in: lines that are pinned already get its words, the record what it does not say.
struct AtfTaken {
  std::size_t lines = 0, pinned = 0;  ///< lines of the text, those of them that a note has
};
AtfTaken take_atf(Document& document, const AtfFile& text);

}  // namespace dubsar::app
