#pragma once
// Transliterations in ATF, the ASCII Transliteration Format of CDLI, ORACC and eBL, as lines that know what they are
// (docs/edition.md names the grammars). A file that is read and written again is the same, byte for byte.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text/enum_names.h"

namespace dubsar {

enum class AtfKind : std::uint8_t {
  kBlank,
  kText,              ///< "&P123456 = AO 8295": key P123456, value AO 8295
  kProtocol,          ///< "#project: akkadica": key project; also atf, key, link, bib, version ...
  kObject,            ///< "@tablet", "@envelope'": key, value of fragment and object, flags
  kSurface,           ///< "@obverse?": key, value of edge, face and surface, flags
  kColumn,            ///< "@column 2'": value 2
  kSeal,              ///< "@seal 1"
  kPart,              ///< "@colophon", "@h1 ...", "@m=locator ...": where in the text
  kState,             ///< "$ rest of obverse broken": value rest of obverse broken
  kLine,              ///< "3'. a-na": key 3', value a-na
  kContinued,         ///< begins with a blank: goes on with the line above
  kManuscript,        ///< "A o 3: a-na" of a score: key A o 3
  kLemmas,            ///< "#lem: ..."
  kTranslation,       ///< "#tr.en: ...": key en
  kNote,              ///< "#note: ..."
  kComment,           ///< "# ...": for those who edit the file
  kLink,              ///< ">>A 3", "<<...", "||...": key of two letters
  kBilingual,         ///< "== ...": the line above in another language
  kGloss,             ///< "={...}": glosses beside the line above
  kTranslationBlock,  ///< "@translation labeled en project"
  kTranslationLabel,  ///< "@label o 3", "@(o 3) ..."
  kTranslationText,   ///< a line of such a block
  kUnknown,
};

inline constexpr EnumName<AtfKind> kAtfKinds[] = {{AtfKind::kBlank, "blank"},
                                                  {AtfKind::kText, "text"},
                                                  {AtfKind::kProtocol, "protocol"},
                                                  {AtfKind::kObject, "object"},
                                                  {AtfKind::kSurface, "surface"},
                                                  {AtfKind::kColumn, "column"},
                                                  {AtfKind::kSeal, "seal"},
                                                  {AtfKind::kPart, "part"},
                                                  {AtfKind::kState, "state"},
                                                  {AtfKind::kLine, "line"},
                                                  {AtfKind::kContinued, "continued"},
                                                  {AtfKind::kManuscript, "manuscript"},
                                                  {AtfKind::kLemmas, "lemmas"},
                                                  {AtfKind::kTranslation, "translation"},
                                                  {AtfKind::kNote, "note"},
                                                  {AtfKind::kComment, "comment"},
                                                  {AtfKind::kLink, "link"},
                                                  {AtfKind::kBilingual, "bilingual"},
                                                  {AtfKind::kGloss, "gloss"},
                                                  {AtfKind::kTranslationBlock, "translation-block"},
                                                  {AtfKind::kTranslationLabel, "translation-label"},
                                                  {AtfKind::kTranslationText, "translation-text"},
                                                  {AtfKind::kUnknown, "unknown"}};
static_assert(names_all(kAtfKinds, static_cast<std::size_t>(AtfKind::kUnknown) + 1));

struct AtfLine {
  AtfKind kind = AtfKind::kBlank;
  std::string bytes{};         ///< the line as it stands, without its end
  std::string end{"\n"};       ///< "\n", "\r\n", or empty at the end of a file
  std::string key{}, value{};  ///< by kind; blanks around them are left out
  std::string flags{};         ///< of objects, surfaces and columns: of ' ? ! * and the like
  friend bool operator==(const AtfLine&, const AtfLine&) = default;
};

struct AtfFile {
  std::vector<AtfLine> lines;
  friend bool operator==(const AtfFile&, const AtfFile&) = default;
};

/// Never fails: what is no ATF is kUnknown. UTF-8 with or without a mark of byte order.
AtfFile read_atf(std::string_view text);
/// The bytes that read_atf() was given.
std::string write_atf(const AtfFile& file);

/// One line alone, outside a score or a block of translation; `bytes` without an end.
AtfLine atf_line(std::string_view bytes);

/// Where something stands in a file: both from 1, columns in characters.
struct AtfFault {
  std::size_t line = 0, column = 0;
  std::string message;        ///< what was found and what is expected
  bool only_warning = false;  ///< programs differ: some read it
  friend bool operator==(const AtfFault&, const AtfFault&) = default;
};

/// What is against the grammar, in the order of lines.
std::vector<AtfFault> check_atf(const AtfFile& file);

/// Whether "$ " and this is a state, ruling, image or seal of the strict grammar, or free text in parentheses.
enum class AtfStateForm : std::uint8_t { kStrict, kFree, kWrong };
AtfStateForm atf_state_form(std::string_view value);

}  // namespace dubsar
