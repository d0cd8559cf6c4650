#pragma once
// What catalogues and publications say of a tablet, once for all that is written of it.

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

/// UTF-8; empty: not said.
struct TabletRecord {
  std::string museum_number;  ///< "AO 8295"
  std::string p_number;       ///< of CDLI: "P293386"
  std::string title;          ///< of publications; empty: the museum number
  std::string institution;
  std::string rights;      ///< who may do what
  std::string creator;     ///< who made the edition
  std::string language;    ///< of the text, BCP 47: "akk-Latn", "akk-Latn-x-oldass", "sux-Latn"
  std::string translated;  ///< language of translations: "en"
  friend bool operator==(const TabletRecord&, const TabletRecord&) = default;
};

/// Title, else museum number, else P-number.
std::string name_of(const TabletRecord& record);

/// "P293386" of "p293386", "293386" or "P293386"; X and Q as well. kUsage: what is none.
Result<std::string> catalogue_number(std::string_view text);

/// A tag of BCP 47 as it is written: "akk-latn" is "akk-Latn"; "akk", "akkadian", "old assyrian", "sumerian" and the
/// like are tags with -Latn, as transliterations are in Latin letters. kUsage: what is none.
Result<std::string> language_tag(std::string_view text);
/// The code of "#atf: lang": akk-x-oldass of akk-Latn-x-oldass; akk of an empty one.
std::string atf_language(std::string_view tag);
std::string tag_of_atf_language(std::string_view code);

}  // namespace dubsar
