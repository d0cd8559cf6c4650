#include "core/edition/typed_letters.h"

#include <array>
#include <utility>

namespace dubsar {
namespace {

constexpr std::string_view kTypedVowels = "aeiuAEIU";
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTypedPairs{{{"sz", "\u0161"},
                                                                                     {"sZ", "\u0161"},
                                                                                     {"SZ", "\u0160"},
                                                                                     {"Sz", "\u0160"},
                                                                                     {"s,", "\u1e63"},
                                                                                     {"S,", "\u1e62"},
                                                                                     {"t,", "\u1e6d"},
                                                                                     {"T,", "\u1e6c"},
                                                                                     {"h,", "\u1e2b"},
                                                                                     {"H,", "\u1e2a"},
                                                                                     {"s'", "\u015b"},
                                                                                     {"S'", "\u015a"},
                                                                                     {"s\u02be", "\u015b"},
                                                                                     {"S\u02be", "\u015a"},
                                                                                     {"s\u2019", "\u015b"},
                                                                                     {"S\u2019", "\u015a"}}};
constexpr std::string_view kTypedAlef = "\u02be", kTypedX = "\u2093";

bool is_plain_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_plain_digit(char c) { return c >= '0' && c <= '9'; }

/// Of U+2080 to U+2089.
bool ends_with_subscript(std::string_view text) {
  return text.size() >= 3 && text.substr(text.size() - 3, 2) == "\xe2\x82" &&
         static_cast<unsigned char>(text.back()) >= 0x80 && static_cast<unsigned char>(text.back()) <= 0x89;
}
/// Of the alphabets of transliterations: Latin with its extensions, and alef and ayin.
bool ends_with_letter(std::string_view text) {
  if (text.empty()) return false;
  if (is_plain_letter(text.back())) return true;
  std::size_t at = text.size();
  while (at > 0 && (static_cast<unsigned char>(text[at - 1]) & 0xc0u) == 0x80u) --at;
  if (at == 0 || at == text.size()) return false;
  const auto lead = static_cast<unsigned char>(text[at - 1]);
  if (text.ends_with("\u02be") || text.ends_with("\u02bf")) return true;
  return (lead >= 0xc3 && lead <= 0xc9) || (lead == 0xe1 && static_cast<unsigned char>(text[at]) >= 0xb8);
}

/// "4(N": what follows is the number of a sign in a list.
bool ends_in_sign_name(std::string_view text) {
  std::size_t at = text.size();
  while (at > 0 && is_plain_digit(text[at - 1])) --at;
  return at >= 3 && text[at - 1] == 'N' && text[at - 2] == '(' && is_plain_digit(text[at - 3]);
}

class Typist {
 public:
  explicit Typist(std::string_view text) : text_(text) {}
  std::string type() {
    while (at_ < text_.size()) step();
    return std::move(out_);
  }

 private:
  std::string_view rest() const { return text_.substr(at_); }
  bool at_start() const {
    return out_.empty() || std::string_view(" \t[({<").find(out_.back()) != std::string_view::npos;
  }
  void copy(std::size_t bytes) {
    out_ += rest().substr(0, bytes);
    at_ += bytes;
  }

  void step() {
    const char c = text_[at_];
    if (c == '%' && at_start()) return copy(std::min(rest().find_first_of(" \t"), rest().size()));
    if (c == '@') {
      std::size_t end = 1;
      while (end < rest().size() && (is_plain_letter(rest()[end]) || is_plain_digit(rest()[end]))) ++end;
      return copy(end);
    }
    for (const auto& [typed, letter] : kTypedPairs)
      if (rest().starts_with(typed)) {
        out_ += letter;
        at_ += typed.size();
        return;
      }
    if (c == '|') bars_ = !bars_;
    if (c == '\'' && is_alef()) {
      out_ += kTypedAlef;
      ++at_;
      return;
    }
    if (is_plain_digit(c) && (ends_with_letter(out_) || ends_with_subscript(out_)) && !ends_in_sign_name(out_)) {
      out_ += "\xe2\x82";
      out_ += static_cast<char>(0x80 + (c - '0'));
      ++at_;
      return;
    }
    if (c == '(' && !bars_ && out_.ends_with('x') && is_value(std::string_view(out_).substr(0, out_.size() - 1))) {
      out_.pop_back();
      out_ += kTypedX;
    }
    copy(1);
  }

  /// Before a vowel or another letter: at a word's beginning; between two vowels.
  bool is_alef() const {
    if (rest().size() < 2) return false;
    const char next = rest()[1];
    if (at_start() || out_.ends_with('-')) return is_plain_letter(next);
    return kTypedVowels.find(out_.back()) != std::string_view::npos &&
           kTypedVowels.find(next) != std::string_view::npos;
  }
  /// Values of signs are in small letters: "KAx(LA)" is a sign, "lax(LA)" a value.
  static bool is_value(std::string_view before) {
    return ends_with_letter(before) && !(before.back() >= 'A' && before.back() <= 'Z');
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool bars_ = false;  ///< within | |
  std::string out_;
};

}  // namespace

std::string typed_letters(std::string_view text) { return Typist(text).type(); }

std::string ascii_letters(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kLetters{{{"\u0161", "sz"},
                                                                                    {"\u1e63", "s,"},
                                                                                    {"\u1e62", "S,"},
                                                                                    {"\u1e6d", "t,"},
                                                                                    {"\u1e6c", "T,"},
                                                                                    {"\u1e2b", "h"},
                                                                                    {"\u1e2a", "H"},
                                                                                    {"\u015b", "s'"},
                                                                                    {"\u015a", "S'"},
                                                                                    {"\u02be", "'"},
                                                                                    {"\u2093", "x"},
                                                                                    {"\u00d7", "x"},
                                                                                    {"\u014b", "j"},
                                                                                    {"\u014a", "J"}}};
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    std::size_t step = 0;
    for (const auto& [letter, typed] : kLetters)
      if (step == 0 && rest.starts_with(letter)) {
        out += typed;
        step = letter.size();
      }
    if (rest.starts_with("\u0160")) {
      const bool beside = (!out.empty() && is_capital(out.back())) || (rest.size() > 2 && is_capital(rest[2]));
      out += beside ? "SZ" : "Sz";
      step = 2;
    }
    if (rest.size() > 2 && ends_with_subscript(rest.substr(0, 3))) {
      out += static_cast<char>('0' + static_cast<unsigned char>(rest[2]) - 0x80);
      step = 3;
    }
    if (step == 0) {
      out += rest[0];
      step = 1;
    }
    at += step;
  }
  return out;
}

}  // namespace dubsar
