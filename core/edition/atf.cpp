#include "core/edition/atf.h"

#include <algorithm>
#include <array>

#include "core/edition/line_number.h"

namespace dubsar {
namespace {

constexpr std::string_view kAtfMark = "\xef\xbb\xbf";  // of byte order
constexpr std::string_view kAtfBlanks = " \t";
constexpr std::array<std::string_view, 6> kAtfObjects{"tablet", "envelope", "prism", "bulla", "fragment", "object"};
constexpr std::array<std::string_view, 9> kAtfSurfaces{"obverse", "reverse", "left", "right",  "top",
                                                       "bottom",  "edge",    "face", "surface"};
constexpr std::array<std::string_view, 17> kAtfParts{
    "catchline", "colophon", "date",      "signature", "signatures", "summary", "witnesses",      "h1", "h2", "h3",
    "div",       "end",      "composite", "score",     "note",       "include", "transliteration"};

bool is_one_of(std::string_view word, auto& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kAtfBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kAtfBlanks) - first + 1);
}

/// Flags at the end of a word: "obverse?!" is obverse and ?!.
std::string take_flags(std::string_view& word) {
  std::size_t end = word.size();
  const auto flag_before = [&](std::size_t at) -> std::size_t {
    if (at > 0 && std::string_view("'?!*").find(word[at - 1]) != std::string_view::npos) return 1;
    for (const std::string_view mark : {"\u2032", "\u2019", "\u02be", "\u00b0"})
      if (word.substr(0, at).ends_with(mark)) return mark.size();
    return 0;
  };
  while (const std::size_t size = flag_before(end)) end -= size;
  const std::string flags(word.substr(end));
  word = word.substr(0, end);
  return flags;
}

void read_at(std::string_view text, AtfLine& out) {
  const std::string_view rest = text.substr(1);
  if (rest.starts_with("(") || rest.starts_with("?(")) {
    out.kind = AtfKind::kTranslationLabel;
    out.value = rest;
    return;
  }
  const std::size_t end = std::min(rest.find_first_of(kAtfBlanks), rest.size());
  std::string_view word = rest.substr(0, end), value = trimmed(rest.substr(end));
  out.kind = AtfKind::kUnknown;
  if (word.starts_with("m=") || word.starts_with("label")) {
    out.kind = word.starts_with("m=") ? AtfKind::kPart : AtfKind::kTranslationLabel;
    out.key = word;
    out.value = value;
    return;
  }
  const std::string of_word = take_flags(word);
  out.key = word;
  if (word == "translation") out.kind = AtfKind::kTranslationBlock;
  if (is_one_of(word, kAtfParts)) out.kind = AtfKind::kPart;
  if (is_one_of(word, kAtfObjects)) out.kind = AtfKind::kObject;
  if (is_one_of(word, kAtfSurfaces)) out.kind = AtfKind::kSurface;
  if (word == "column") out.kind = AtfKind::kColumn;
  if (word == "seal") out.kind = AtfKind::kSeal;
  out.flags = of_word;
  if (out.kind == AtfKind::kColumn || out.kind == AtfKind::kSurface || out.kind == AtfKind::kObject)
    out.flags += take_flags(value);
  out.value = trimmed(value);
}

void read_hash(std::string_view text, AtfLine& out) {
  out.kind = AtfKind::kComment;
  const std::string_view rest = text.substr(1);
  const std::size_t colon = rest.find(':');
  const std::string_view name = rest.substr(0, std::min(colon, rest.size()));
  // "#CAD H, p. 5: ..." is a comment: names of protocols are one word in small letters.
  const bool named = colon != std::string_view::npos && !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
                     (name.find_first_of(kAtfBlanks) == std::string_view::npos || name.starts_with("tr."));
  out.value = trimmed(named ? rest.substr(colon + 1) : rest);
  if (!named) return;
  out.key = name;
  out.kind = AtfKind::kProtocol;
  if (name == "lem") out.kind = AtfKind::kLemmas;
  if (name == "note") out.kind = AtfKind::kNote;
  if (name == "tr" || name.starts_with("tr.")) {
    out.kind = AtfKind::kTranslation;
    out.key = name.substr(std::min<std::size_t>(3, name.size()));
  }
}

/// "3'. a-na" or "3'."
bool read_numbered(std::string_view text, AtfLine& out) {
  const std::size_t end = std::min(text.find_first_of(kAtfBlanks), text.size());
  std::string_view number = text.substr(0, end);
  if (number.size() < 2 || number.back() != '.') return false;
  number.remove_suffix(1);
  // "[...]." and "..." are no numbers: a digit, or one letter and more, is in all of them.
  if (number.find_first_of("0123456789") == std::string_view::npos && !is_line_number(number)) return false;
  if (number.find_first_of("[]()<>{}\"") != std::string_view::npos) return false;
  out.kind = AtfKind::kLine;
  out.key = number;
  out.value = trimmed(text.substr(end));
  return true;
}

/// What a line is by itself.
void read_alone(std::string_view text, AtfLine& out) {
  if (text.find_first_not_of(kAtfBlanks) == std::string_view::npos) return;
  if (text[0] == '&') {
    out.kind = AtfKind::kText;
    const std::size_t equals = text.find('=');
    out.key = trimmed(text.substr(1, equals == std::string_view::npos ? equals : equals - 1));
    if (equals != std::string_view::npos) out.value = trimmed(text.substr(equals + 1));
  } else if (text[0] == '@') {
    read_at(text, out);
  } else if (text[0] == '$') {
    out.kind = AtfKind::kState;
    out.value = trimmed(text.substr(1));
  } else if (text[0] == '#') {
    read_hash(text, out);
  } else if (text.starts_with(">>") || text.starts_with("<<") || text.starts_with("||")) {
    out.kind = AtfKind::kLink;
    out.key = text.substr(0, 2);
    out.value = trimmed(text.substr(2));
  } else if (text.starts_with("==") || text.starts_with("=:")) {
    out.kind = AtfKind::kBilingual;
    out.value = trimmed(text.substr(2));
  } else if (text.starts_with("={")) {
    out.kind = AtfKind::kGloss;
    out.value = trimmed(text.substr(1));
  } else if (kAtfBlanks.find(text[0]) != std::string_view::npos) {
    out.kind = AtfKind::kContinued;
    out.value = trimmed(text);
  } else if (!read_numbered(text, out)) {
    out.kind = AtfKind::kUnknown;
  }
}

/// "A: a-na", "A o 3: a-na": of a score.
bool read_manuscript(std::string_view text, AtfLine& out) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0 || text.substr(0, colon).find('.') != std::string_view::npos)
    return false;
  out.kind = AtfKind::kManuscript;
  out.key = text.substr(0, colon);
  out.value = trimmed(text.substr(colon + 1));
  return true;
}

/// What lines above say of those below.
struct AtfContext {
  bool score = false, translation = false;
  void follow(AtfLine& line, std::string_view text) {
    if (line.kind == AtfKind::kText) score = translation = false;
    if (line.kind == AtfKind::kPart && line.key == "score") score = true;
    if (line.kind == AtfKind::kTranslationBlock) translation = true;
    if (line.kind == AtfKind::kPart && line.key == "end" && line.value.starts_with("translation")) translation = false;
    const bool plain =
        line.kind == AtfKind::kUnknown || line.kind == AtfKind::kContinued || line.kind == AtfKind::kLine;
    if (translation && plain) {  // sentences begin with anything: "12. ...", "@?perhaps?@ ..."
      line.kind = AtfKind::kTranslationText;
      line.key.clear();
      line.flags.clear();
      line.value = trimmed(text);
    } else if (score && line.kind == AtfKind::kUnknown) {
      read_manuscript(text, line);
    }
  }
};

}  // namespace

AtfLine atf_line(std::string_view bytes) {
  AtfLine out;
  out.bytes = bytes;
  read_alone(bytes, out);
  return out;
}

AtfFile read_atf(std::string_view text) {
  AtfFile out;
  AtfContext context;
  for (bool first = true; !text.empty(); first = false) {
    const std::size_t newline = text.find('\n');
    std::size_t size = std::min(newline, text.size());
    const std::size_t whole = newline == std::string_view::npos ? text.size() : newline + 1;
    if (size < whole && size > 0 && text[size - 1] == '\r') --size;
    AtfLine line;
    line.bytes = text.substr(0, size);
    line.end = text.substr(size, whole - size);
    std::string_view read = line.bytes;
    if (first && read.starts_with(kAtfMark)) read.remove_prefix(kAtfMark.size());
    while (read.ends_with('\r')) read.remove_suffix(1);
    read_alone(read, line);
    if (!read.empty()) context.follow(line, read);
    out.lines.push_back(std::move(line));
    text.remove_prefix(whole);
  }
  return out;
}

std::string write_atf(const AtfFile& file) {
  std::string out;
  for (const AtfLine& line : file.lines) out += line.bytes + line.end;
  return out;
}

}  // namespace dubsar
