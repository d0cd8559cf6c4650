#include "core/base/text/json_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/text/plain_text.h"

namespace dubsar {
namespace {

constexpr std::size_t kMostShown = 24;  // bytes of the file that a sentence repeats
constexpr int kMostLevels = 64;         // the parser is asked for fewer
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }

/// Bytes of the UTF-8 character at the front of `text`; 0: none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  if ((lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) > 0x9F) || (lead == 0xF0 && byte(1) < 0x90) ||
      (lead == 0xF4 && byte(1) > 0x8F))
    return 0;
  return length;
}

std::optional<JsonFault> encoding_fault(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at));
    if (length == 0)
      return JsonFault{at,
                       fmt::format("the byte {:02X} is not UTF-8; save the file as UTF-8 (it may be Latin-1 or "
                                   "Windows-1252 now)",
                                   static_cast<unsigned char>(text[at])),
                       JsonSlip::kBytes};
    at += length;
  }
  return std::nullopt;
}

/// Two bytes a character: by the mark in front, or by the zeros between plain letters.
bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  const std::string_view head = text.substr(0, 64);
  return static_cast<std::size_t>(std::count(head.begin(), head.end(), '\0')) * 3 > head.size();
}

/// Quotes of word processors and of other languages, double ones first.
constexpr std::array<std::string_view, 12> kOddQuotes{"\u201C", "\u201D", "\u201E", "\u201F", "\u00AB", "\u00BB",
                                                      "\u2033", "\u2018", "\u2019", "\u201A", "'",      "`"};
constexpr std::size_t kDoubleQuotes = 7;

/// The quote that is none of JSON's at the front of `text`; empty: there is none.
std::string_view odd_quote(std::string_view text) {
  for (const std::string_view quote : kOddQuotes)
    if (text.starts_with(quote)) return quote;
  return {};
}

/// Lines end in LF, CR LF or CR.
struct Place {
  std::size_t line = 1, begin = 0;  ///< begin: of the line
};
Place place_of(std::string_view text, std::size_t at) {
  Place place;
  for (std::size_t i = 0; i < at; ++i)
    if (text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'))) {
      ++place.line;
      place.begin = i + 1;
    }
  return place;
}

/// Walks the text as a strict parser would and ends at the first thing that it cannot take.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  std::optional<JsonFault> first_fault() {
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    skip();
    if (!fault_ && at_ == text_.size()) return JsonFault{0, {}};
    value(0);
    skip();
    if (!fault_ && at_ < text_.size())
      wrong(at_, fmt::format("{} found after the end of the text, expected nothing more", shown(at_)), JsonSlip::kTail);
    return fault_;
  }

 private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool wrong(std::size_t at, std::string what, JsonSlip slip = JsonSlip::kOther) {
    if (!fault_) fault_ = JsonFault{at, std::move(what), slip};
    return false;
  }
  /// The word, name or sign that stands at `at`, for a sentence.
  std::string shown(std::size_t at) const {
    if (at >= text_.size()) return "the end";
    std::size_t end = at + std::max<std::size_t>(1, utf8_length(text_.substr(at)));
    if (text_[at] == '"') {
      while (end < text_.size() && end - at < kMostShown && text_[end] != '"' && text_[end] != '\n') ++end;
      if (end < text_.size() && text_[end] == '"') return plain_text(text_.substr(at, end + 1 - at));
    } else if (is_word(text_[at]) || text_[at] == '-') {
      while (end < text_.size() && end - at < kMostShown && (is_word(text_[end]) || text_[end] == '.')) ++end;
      return plain_text(text_.substr(at, end - at));
    }
    while (end < text_.size() && utf8_length(text_.substr(end)) == 0) ++end;
    return plain_text(text_.substr(at, end - at)) + (text_[at] == '"' ? " ..." : "");
  }
  std::string place(std::size_t at) const { return fmt::format("line {}", place_of(text_, at).line); }

  bool skip() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    if (here() == '/' || here() == '#')
      return wrong(at_, "a comment found; JSON has none, take it out", JsonSlip::kComment);
    return true;
  }

  bool value(int level) {
    if (level > kMostLevels) return wrong(at_, "nested too deep");
    if (!skip()) return false;
    switch (here()) {
      case '{':
        return members(level);
      case '[':
        return elements(level);
      case '"':
        return string();
      default:
        break;
    }
    if (is_digit(here()) || here() == '-' || here() == '+' || here() == '.') return number();
    if (is_word(here())) return word();
    if (const auto quote = odd_quote(text_.substr(at_)); !quote.empty()) return odd_quotes(at_, quote);
    if (at_ >= text_.size()) return wrong(at_, "the text ends here, expected a value");
    return wrong(at_, fmt::format("{} found, expected a value", shown(at_)));
  }

  bool odd_quotes(std::size_t at, std::string_view quote) {
    return wrong(at, fmt::format("the quote {} found, expected the straight \"", quote), JsonSlip::kQuote);
  }

  bool members(int level) {
    const std::size_t opened = at_++;
    std::size_t comma = 0;
    for (bool first = true;; first = false) {
      if (!skip()) return false;
      if (here() == '}') {
        if (!first) return wrong(comma, "a comma too many before }", JsonSlip::kCommaTooMany);
        ++at_;
        return true;
      }
      if (!name(comma)) return at_ >= text_.size() && !fault_ ? unclosed(opened) : false;
      const std::size_t named = name_;
      if (!skip()) return false;
      if (here() != ':')
        return wrong(at_,
                     here() == '=' ? std::string("= found, expected a colon")
                                   : fmt::format("a colon is missing after {}", shown(named)),
                     here() == '=' ? JsonSlip::kEquals : JsonSlip::kColonMissing);
      ++at_;
      if (!skip()) return false;
      if (here() == ',' || here() == '}') return wrong(at_, fmt::format("the value of {} is missing", shown(named)));
      if (!value(level + 1) || !skip()) return false;
      if (here() == '}') {
        ++at_;
        return true;
      }
      if (!separator(opened, '}')) return false;
      comma = at_ - 1;
    }
  }

  bool elements(int level) {
    const std::size_t opened = at_++;
    if (!skip()) return false;
    if (here() == ']') {
      ++at_;
      return true;
    }
    for (;;) {
      if (!value(level + 1) || !skip()) return false;
      if (here() == ']') {
        ++at_;
        return true;
      }
      if (!separator(opened, ']')) return false;
      const std::size_t comma = at_ - 1;
      if (!skip()) return false;
      if (here() == ']') return wrong(comma, "a comma too many before ]", JsonSlip::kCommaTooMany);
      if (here() == ',') return wrong(at_, "a comma too many", JsonSlip::kCommaTooMany);
    }
  }

  /// A comma behind a value of a list or an object that began at `opened`.
  bool separator(std::size_t opened, char close) {
    if (here() == ',') {
      ++at_;
      return true;
    }
    if (at_ >= text_.size()) return unclosed(opened);
    const char c = here();
    if (c == '}' || c == ']')
      return wrong(at_,
                   fmt::format("{} found, expected {}, as {} opened at {}", c, close, text_[opened], place(opened)));
    if (c == ':') return wrong(at_, "a colon found, expected a comma");
    if (c == ';') return wrong(at_, "; found, expected a comma", JsonSlip::kSemicolon);
    if (c == '"' || c == '{' || c == '[' || c == '-' || is_word(c) || !odd_quote(text_.substr(at_)).empty())
      return wrong(at_, fmt::format("a comma is missing before {}", shown(at_)), JsonSlip::kCommaMissing);
    return wrong(at_, fmt::format("{} found, expected a comma or {}", shown(at_), close));
  }

  bool unclosed(std::size_t opened) {
    return wrong(at_,
                 fmt::format("the text ends before the {} that closes the {} of {}", text_[opened] == '{' ? '}' : ']',
                             text_[opened], place(opened)),
                 JsonSlip::kOpenEnd);
  }

  /// Of a member; `comma`: where the comma before it stands, 0: none.
  bool name(std::size_t comma) {
    name_ = at_;
    if (here() == '"') return string();
    if (at_ >= text_.size()) return false;
    if (comma > 0 && here() == ',') return wrong(at_, "a comma too many", JsonSlip::kCommaTooMany);
    if (comma > 0 && comma + 1 == at_ && is_digit(here()) && is_digit(text_[comma - 1])) {
      std::size_t begin = comma, end = at_;
      while (begin > 0 && (is_digit(text_[begin - 1]) || text_[begin - 1] == '-')) --begin;
      while (end < text_.size() && is_digit(text_[end])) ++end;
      const std::string found(text_.substr(begin, std::min(end - begin, kMostShown)));
      std::string wanted = found;
      std::replace(wanted.begin(), wanted.end(), ',', '.');
      return wrong(begin, fmt::format("{} found, expected a decimal point: {}", found, wanted),
                   JsonSlip::kDecimalComma);
    }
    if (const auto quote = odd_quote(text_.substr(at_)); !quote.empty()) return odd_quotes(at_, quote);
    if (is_word(here()))
      return wrong(at_, fmt::format("{} found, expected a name in quotes: \"{}\"", shown(at_), shown(at_)),
                   JsonSlip::kBareName);
    return wrong(at_, fmt::format("{} found, expected a name in quotes", shown(at_)));
  }

  bool string() {
    const std::size_t opened = at_++;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"') {
        ++at_;
        return true;
      }
      if (c == '\n' || c == '\r') {
        const std::string_view line = text_.substr(opened, at_ - opened);
        for (std::size_t i = 1; i < line.size(); ++i)
          for (const std::string_view quote : std::span(kOddQuotes).first(kDoubleQuotes))
            if (line.substr(i).starts_with(quote)) return odd_quotes(opened + i, quote);
        return wrong(opened, fmt::format("the closing quote of {} is missing on its line", shown(opened)),
                     JsonSlip::kOpenText);
      }
      if (static_cast<unsigned char>(c) < 0x20)
        return wrong(
            at_,
            fmt::format("a control character ({}) found in a text, expected {}",
                        c == '\t' ? "a tab" : fmt::format("code {}", static_cast<int>(c)), c == '\t' ? "\\t" : "none"),
            JsonSlip::kControl);
      if (c == '\\' && !escape()) return false;
    }
    return wrong(opened, fmt::format("the closing quote of {} is missing", shown(opened)));
  }

  /// at_ stands on the backslash and ends on the last character of what it begins.
  bool escape() {
    const std::size_t begin = at_++;
    const char c = here();
    if (c == 'u') {
      const auto hex = [](char d) { return is_digit(d) || (d >= 'a' && d <= 'f') || (d >= 'A' && d <= 'F'); };
      const std::string_view digits = text_.substr(at_ + 1, 4);
      if (digits.size() == 4 && std::all_of(digits.begin(), digits.end(), hex)) {
        at_ += 4;
        return true;
      }
    } else if (std::string_view("\"\\/bfnrt").find(c) != std::string_view::npos && c != '\0') {
      return true;
    }
    return wrong(begin,
                 fmt::format("a single \\ before {} found in a text, expected \\\\ (in paths, / will do)",
                             at_ < text_.size() ? shown(at_).substr(0, 1) : "the end"),
                 JsonSlip::kBackslash);
  }

  bool number() {
    const std::size_t begin = at_;
    std::size_t end = at_;
    while (end < text_.size() && (is_word(text_[end]) || text_[end] == '.' || text_[end] == '+' || text_[end] == '-'))
      ++end;
    const std::string_view all = text_.substr(begin, end - begin);
    std::size_t i = all.starts_with('-') ? 1 : 0;
    const auto digits = [&] {
      const std::size_t from = i;
      while (i < all.size() && is_digit(all[i])) ++i;
      return i > from;
    };
    const bool zero = i < all.size() && all[i] == '0';
    const std::size_t whole = i;
    bool good = digits() && !(zero && i > whole + 1);
    if (good && i < all.size() && all[i] == '.') {
      ++i;
      good = digits();
    }
    if (good && i < all.size() && (all[i] == 'e' || all[i] == 'E')) {
      ++i;
      if (i < all.size() && (all[i] == '+' || all[i] == '-')) ++i;
      good = digits();
    }
    if (!good || i != all.size())
      return wrong(begin,
                   fmt::format("{} is no number of JSON, expected one such as 0.5, -3 or 1e-3",
                               plain_text(all.substr(0, kMostShown))),
                   JsonSlip::kNumber);
    if (double value = 0.0; std::from_chars(all.data(), all.data() + all.size(), value).ec != std::errc() &&
                            all.find("e-") == std::string_view::npos && all.find("E-") == std::string_view::npos)
      return wrong(begin, fmt::format("the number {} is too large", all.substr(0, kMostShown)));
    at_ = end;
    return true;
  }

  bool word() {
    std::size_t end = at_;
    while (end < text_.size() && is_word(text_[end])) ++end;
    const std::string_view all = text_.substr(at_, end - at_);
    if (all != "true" && all != "false" && all != "null")
      return wrong(at_, fmt::format("{} found, expected true, false, null, a number or a text in quotes", shown(at_)),
                   JsonSlip::kWord);
    at_ = end;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t name_ = 0;  ///< where the last name of a member begins
  std::optional<JsonFault> fault_;
};

}  // namespace

std::string json_place(std::string_view text, std::size_t at) {
  at = std::min(at, text.size());
  Place place = place_of(text, at);
  if (place.begin == 0 && text.starts_with(kByteOrderMark)) place.begin = std::min(at, kByteOrderMark.size());
  const std::string_view before = text.substr(place.begin, at - place.begin);
  const auto column = std::count_if(before.begin(), before.end(), [](char c) { return (c & 0xC0) != 0x80; });
  return fmt::format("line {}, column {}", place.line, column + 1);
}

std::optional<JsonFault> first_json_fault(std::string_view text) {
  if (is_utf16(text)) return JsonFault{0, "the text is UTF-16, expected UTF-8; save the file as UTF-8"};
  if (auto fault = encoding_fault(text)) return fault;
  auto fault = Walk(text).first_fault();
  if (fault && fault->what.empty()) fault->what = "the file is empty, expected JSON";
  return fault;
}

std::string json_fault(std::string_view text, std::size_t refused_at) {
  auto fault = first_json_fault(text);
  if (fault && fault->at == 0 && (fault->what.starts_with("the text is") || fault->what.starts_with("the file is")))
    return fault->what;
  if (!fault) fault = JsonFault{refused_at > 0 ? refused_at - 1 : 0, "no JSON that can be read"};
  return fmt::format("{}: {}", json_place(text, fault->at), fault->what);
}

}  // namespace dubsar
