#include "core/edition/tablet_record.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/text/lower_text.h"

namespace dubsar {
namespace {

// Names that people type, and the tags of the registry of IANA; private ones of periods are those of ORACC.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kLanguageNames{{
    {"akkadian", "akk"},
    {"old akkadian", "akk-x-oldakk"},
    {"old assyrian", "akk-x-oldass"},
    {"middle assyrian", "akk-x-midass"},
    {"neo-assyrian", "akk-x-neoass"},
    {"old babylonian", "akk-x-oldbab"},
    {"middle babylonian", "akk-x-midbab"},
    {"neo-babylonian", "akk-x-neobab"},
    {"late babylonian", "akk-x-ltebab"},
    {"standard babylonian", "akk-x-stdbab"},
    {"sumerian", "sux"},
    {"emesal", "sux-x-emesal"},
    {"hittite", "hit"},
    {"elamite", "elx"},
    {"ugaritic", "uga"},
    {"hurrian", "xhu"},
}};

std::vector<std::string> subtags_of(std::string_view text) {
  std::vector<std::string> out;
  for (bool more = true; more;) {
    const std::size_t dash = text.find('-');
    more = dash != std::string_view::npos;
    out.emplace_back(text.substr(0, dash));
    if (more) text.remove_prefix(dash + 1);
  }
  return out;
}

bool is_subtag(std::string_view text) {
  return !text.empty() && text.size() <= 8 &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

}  // namespace

std::string name_of(const TabletRecord& record) {
  if (!record.title.empty()) return record.title;
  return record.museum_number.empty() ? record.p_number : record.museum_number;
}

Result<std::string> catalogue_number(std::string_view text) {
  std::string out(text);
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z') out[0] = static_cast<char>(out[0] - 'a' + 'A');
  if (out.size() == 6) out.insert(0, "P");
  if (out.size() == 7 && std::string_view("PQX").find(out[0]) != std::string_view::npos &&
      out.find_first_not_of("0123456789", 1) == std::string::npos)
    return out;
  return fail(ErrorKind::kUsage, "\"{}\" found, expected a number of CDLI such as P293386", text);
}

Result<std::string> language_tag(std::string_view text) {
  std::string low = lower_text(text);
  for (const auto& [name, tag] : kLanguageNames)
    if (low == name) low = tag;
  const std::vector<std::string> parts = subtags_of(low);
  if (parts[0].size() < 2 || parts[0].size() > 3 || !std::all_of(parts.begin(), parts.end(), is_subtag))
    return fail(ErrorKind::kUsage,
                "\"{}\" found, expected a language such as akk, akk-x-oldass, sumerian or old assyrian", text);
  std::string out = parts[0], rest;
  bool script = false, own = false;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    std::string part = parts[k];
    own = own || part == "x";
    if (!own && part.size() == 4 && part[0] > '9') {
      part[0] = static_cast<char>(part[0] - 'a' + 'A');
      script = true;
    }
    rest += "-" + part;
  }
  // Languages of two letters are those of today, which nobody transliterates.
  return out + (script || out.size() == 2 ? "" : "-Latn") + rest;
}

std::string atf_language(std::string_view tag) {
  if (tag.empty()) return "akk";
  std::string out(tag);
  if (const std::size_t at = out.find("-Latn"); at != std::string::npos) out.erase(at, 5);
  return out;
}

std::string tag_of_atf_language(std::string_view code) {
  const auto tag = language_tag(code);
  return tag ? *tag : std::string();
}

}  // namespace dubsar
