#pragma once
// The wedges of an edition: those that the program found, and what people made of them. Whose each of them is, is kept
// with it for ever.

#include <string>
#include <vector>

#include "core/script/text_sides.h"
#include "core/script/wedge.h"

namespace dubsar::app {

struct Document;

struct MarkedWedge {
  ScriptWedge wedge;     ///< order: from 1 among those that are not deleted, 0 of these
  std::string part{};    ///< that it lies on
  bool deleted = false;  ///< by a person: found again it stays so
  std::string id{};      ///< for life, in all copies of the work
  friend bool operator==(const MarkedWedge&, const MarkedWedge&) = default;
};

/// Those that are not deleted, in the order of reading.
std::vector<ScriptWedge> wedges_of(const Document& document);
/// Where those stand in document.edition.wedges.
std::vector<std::size_t> places_of_wedges(const Document& document);
/// Orders from 1 as they stand.
void number_wedges(Document& document);

/// What the program found on a part takes the place of what it found there before. What a person drew, changed or
/// deleted stays, and what was found within half a width of one of these is left out. `found` is in the order of
/// reading.
void take_found_wedges(Document& document, const std::vector<ScriptWedge>& found, const std::string& part,
                       const TextSides& sides);

/// One more, in the line of the wedge that is nearest on its side, where it stands along that line; the last one where
/// there is none. Returns its number among those that are not deleted, from 1.
std::size_t insert_wedge(Document& document, MarkedWedge wedge, const TextSides& sides);

}  // namespace dubsar::app
