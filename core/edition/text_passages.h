#pragma once
// A transliteration as the lines that are read on a tablet, and a file of ATF that is changed by them: what nobody
// changed keeps its bytes.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/edition/atf.h"
#include "core/edition/tablet_record.h"

namespace dubsar {

/// Where a line stands, in ATF's words.
struct TextSpot {
  std::string object = "tablet";    ///< or envelope ...
  std::string surface = "obverse";  ///< reverse, left, right, top, bottom, "edge b", "seal 1"
  int column = 0;                   ///< 0: the side has none
  std::string number;               ///< "3'"
  friend bool operator==(const TextSpot&, const TextSpot&) = default;
};

/// Order in which a tablet is read: object, side (obverse, bottom, reverse, top, left, right, others), column, line.
bool is_read_before(const TextSpot& a, const TextSpot& b);

struct TextPassage {
  TextSpot spot;
  std::string text;         ///< transliteration; continued lines with a blank between
  std::string translation;  ///< of the record's language of translation
  friend bool operator==(const TextPassage&, const TextPassage&) = default;
};

/// The numbered lines of the first text of a file, in its order. Translations are those of "#tr.XX:" lines; empty: of
/// English.
std::vector<TextPassage> passages_of(const AtfFile& file, std::string_view translated_into = "en");

/// One text of a file that may hold many: the one of this P-number, else of this name, else the only one. kBadData: no
/// text, or several of which none is meant.
Result<AtfFile> text_of_atf(const AtfFile& file, const TabletRecord& record, std::string_view source);

/// What the first lines of a text say: P-number, name, project and language; the rest of the record is empty.
TabletRecord record_of(const AtfFile& text);

/// `base` with the record and the passages: a line that has the same text in it keeps its bytes, one that has another
/// is written anew, one that is missing is put behind the lines that are read before it, with its object, side and
/// column where they are missing. Lines of `base` that no passage has stay. An empty base becomes a text of its own.
/// Texts are written as they are, in UTF-8.
AtfFile with_passages(const AtfFile& base, const TabletRecord& record, std::span<const TextPassage> passages);

}  // namespace dubsar
