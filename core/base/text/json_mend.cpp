#include "core/base/text/json_mend.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace dubsar {
namespace {

constexpr std::size_t kMostSlips = 40;
constexpr std::array<std::string_view, 7> kOddDoubleQuotes{"\u201C", "\u201D", "\u201E", "\u201F",
                                                           "\u00AB", "\u00BB", "\u2033"};
constexpr std::array<std::string_view, 5> kOddSingleQuotes{"\u2018", "\u2019", "\u201A", "'", "`"};

/// `put` in place of `length` bytes from `at` on.
struct Mend {
  std::size_t at = 0, length = 0;
  std::string put;
};

bool is_part_of_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}

std::size_t word_end(std::string_view text, std::size_t at) {
  while (at < text.size() && is_part_of_word(text[at])) ++at;
  return at;
}

std::size_t line_end(std::string_view text, std::size_t at) {
  return std::min(text.find_first_of("\r\n", at), text.size());
}

std::string_view odd_quote_at(std::string_view text, std::size_t at) {
  for (const std::span<const std::string_view> quotes :
       {std::span<const std::string_view>(kOddDoubleQuotes), std::span<const std::string_view>(kOddSingleQuotes)})
    for (const std::string_view quote : quotes)
      if (text.substr(at).starts_with(quote)) return quote;
  return {};
}

/// From an odd quote to the one that closes it, if that is the next quote of its line.
Mend straight_quotes(std::string_view text, std::size_t at) {
  const std::string_view opening = odd_quote_at(text, at);
  const std::size_t begin = at + std::max<std::size_t>(opening.size(), 1), end = line_end(text, at);
  for (std::size_t i = begin; i < end && text[i] != '"'; ++i)
    if (const auto closing = odd_quote_at(text, i); !closing.empty() && (opening.size() == 1) == (closing.size() == 1))
      return {at, i + closing.size() - at, "\"" + std::string(text.substr(begin, i - begin)) + "\""};
  return {at, begin - at, "\""};
}

/// The brackets that are open at the end, closed.
std::string closers(std::string_view text) {
  std::string open;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      quoted = !quoted;
    else if (!quoted && (text[i] == '{' || text[i] == '['))
      open += text[i] == '{' ? '}' : ']';
    else if (!quoted && (text[i] == '}' || text[i] == ']') && !open.empty())
      open.pop_back();
  }
  std::reverse(open.begin(), open.end());
  return open;
}

/// The text's end on its line, before what separates it from the next.
std::size_t text_end(std::string_view text, std::size_t at) {
  const std::string_view line = text.substr(at, line_end(text, at) - at);
  return at + std::max<std::size_t>(line.find_last_not_of(" \t,}]") + 1, 1);
}

std::optional<Mend> mend_of(std::string_view text, const JsonFault& fault) {
  const std::size_t at = fault.at;
  switch (fault.slip) {
    case JsonSlip::kOther:
      return std::nullopt;
    case JsonSlip::kBytes: {  // one encoding, one fault: all that are none of UTF-8
      std::string rest(text.substr(at));
      for (std::size_t i = 0; i < rest.size(); ++i)
        rest[i] = static_cast<unsigned char>(rest[i]) < 0x80 ? rest[i] : '?';
      return Mend{at, rest.size(), rest};
    }
    case JsonSlip::kTail:
      return Mend{at, text.size() - at, ""};
    case JsonSlip::kComment: {
      const bool block = text.substr(at).starts_with("/*");
      const std::size_t close = text.find("*/", at);
      const std::size_t end = block ? (close == std::string_view::npos ? text.size() : close + 2) : line_end(text, at);
      return Mend{at, end - at, " "};
    }
    case JsonSlip::kQuote:
      return straight_quotes(text, at);
    case JsonSlip::kCommaTooMany:
      return Mend{at, 1, ""};
    case JsonSlip::kCommaMissing:
      return Mend{at, 0, ","};
    case JsonSlip::kSemicolon: {
      const std::size_t next = text.find_first_not_of(" \t\r\n", at + 1);
      const bool last = next == std::string_view::npos || text[next] == ']' || text[next] == '}';
      return Mend{at, 1, last ? " " : ","};
    }
    case JsonSlip::kDecimalComma:
      return Mend{text.find(',', at), 1, "."};
    case JsonSlip::kEquals:
      return Mend{at, 1, ":"};
    case JsonSlip::kColonMissing:
      return Mend{at, 0, ":"};
    case JsonSlip::kBareName:
    case JsonSlip::kWord: {
      const std::string word(text.substr(at, word_end(text, at) - at));
      if (fault.slip == JsonSlip::kWord && (word == "True" || word == "False"))
        return Mend{at, word.size(), word == "True" ? "true" : "false"};
      return Mend{at, word.size(), "\"" + word + "\""};
    }
    case JsonSlip::kNumber: {
      std::size_t end = at;
      while (end < text.size() && (is_part_of_word(text[end]) || std::string_view("+-.").find(text[end]) < 3)) ++end;
      return Mend{at, end - at, "1"};
    }
    case JsonSlip::kBackslash:
      return Mend{at, 0, "\\"};
    case JsonSlip::kControl:
      return Mend{at, 1, " "};
    case JsonSlip::kOpenText:
      return Mend{text_end(text, at), 0, "\""};
    case JsonSlip::kOpenEnd:
      return Mend{text.size(), 0, closers(text)};
  }
  return std::nullopt;
}

}  // namespace

std::size_t MendedJson::given_at(std::size_t at) const { return at < from_.size() ? from_[at] : given_size_; }

bool MendedJson::mended_in(std::size_t begin, std::size_t end) const {
  const std::size_t first = given_at(begin), last = given_at(std::max(end, begin + 1) - 1) + 1;
  return std::any_of(touched_.begin(), touched_.end(),
                     [&](const auto& range) { return range.first < last && range.second > first; });
}

MendedJson mend_json(std::string_view text) {
  MendedJson out;
  out.text = text;
  out.given_size_ = text.size();
  for (std::size_t i = 0; i < text.size(); ++i) out.from_.push_back(i);
  while (const auto fault = first_json_fault(out.text)) {
    JsonFault told = *fault;
    told.at = out.given_at(fault->at);
    out.faults.push_back(std::move(told));
    const auto mend = out.faults.size() < kMostSlips ? mend_of(out.text, *fault) : std::nullopt;
    if (!mend) return out;
    const std::size_t given = out.given_at(mend->at), after = out.given_at(mend->at + mend->length);
    out.text.replace(mend->at, mend->length, mend->put);
    const auto begin = out.from_.begin() + static_cast<std::ptrdiff_t>(mend->at);
    if (mend->put.size() != mend->length) {
      const auto next = out.from_.erase(begin, begin + static_cast<std::ptrdiff_t>(mend->length));
      out.from_.insert(next, mend->put.size(), given);
    }
    if (fault->slip != JsonSlip::kCommaMissing) out.touched_.emplace_back(given, std::max(after, given + 1));
  }
  out.whole = true;
  return out;
}

}  // namespace dubsar
