#pragma once
// Every text that a person sees in the window, by its id: "tool.turn". The table stands in words/en.json, English;
// another language is one file beside it (language.h).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace dubsar::app {

struct TextRow {
  std::string_view id, text;
};

inline constexpr auto kEnglish = std::to_array<TextRow>({
#include "english_rows.inc"
});

/// How many values a text takes: one more than the number of its largest placeholder {0}, {1} ...
constexpr std::size_t values_of(std::string_view text) {
  std::size_t most = 0;
  for (std::size_t i = 0; i + 2 < text.size(); ++i)
    if (text[i] == '{' && text[i + 2] == '}' && text[i + 1] >= '0' && text[i + 1] <= '9')
      most = std::max(most, static_cast<std::size_t>(text[i + 1] - '0') + 1);
  return most;
}

/// A text of the table, or none. One that is named in the program and is not there does not compile.
class Text {
 public:
  constexpr Text() = default;
  consteval Text(const char* id) : place_(place_of(id)) {  // NOLINT(google-explicit-constructor)
    if (place_ == kNone) throw "there is no text of this id in app/words/en.json";
  }
  /// None where there is no text of this id.
  static Text find(std::string_view id) noexcept {
    Text out;
    out.place_ = place_of(id);
    return out;
  }
  constexpr bool empty() const noexcept { return place_ == kNone; }
  constexpr std::size_t place() const noexcept { return place_; }
  constexpr std::string_view id() const noexcept { return empty() ? std::string_view() : kEnglish[place_].id; }
  constexpr std::string_view english() const noexcept { return empty() ? std::string_view() : kEnglish[place_].text; }
  friend constexpr bool operator==(const Text&, const Text&) = default;

 private:
  static constexpr std::uint16_t kNone = 0xffff;
  static constexpr std::uint16_t place_of(std::string_view id) noexcept {
    for (std::size_t i = 0; i < kEnglish.size(); ++i)
      if (kEnglish[i].id == id) return static_cast<std::uint16_t>(i);
    return kNone;
  }
  std::uint16_t place_ = kNone;
};

/// A text that takes so many values, no more and no fewer, or it does not compile.
template <class... Values>
struct TextOf {
  Text text;
  consteval TextOf(const char* id) : text(id) {  // NOLINT(google-explicit-constructor)
    if (values_of(text.english()) != sizeof...(Values)) throw "this text of app/words/en.json takes other values";
  }
};

/// In the language of the window (language.h); empty for none.
const std::string& text_of(const Text& text);
inline const std::string& tr(TextOf<> text) { return text_of(text.text); }
template <std::same_as<Text> Known>
const std::string& tr(const Known& text) {
  return text_of(text);
}

/// The text with values in the places of {0}, {1} ... Of a text with forms ("{0} note|{0} notes") the one that the
/// language has for the first value, a whole number.
std::string filled(const std::string& text, std::span<const std::string> values);

template <class... Values>
requires(sizeof...(Values) > 0) std::string tr(std::type_identity_t<TextOf<Values...>> text, const Values&... values) {
  return filled(text_of(text.text), std::array<std::string, sizeof...(Values)>{fmt::format("{}", values)...});
}

/// The text of "family.name", as "side.obverse", the name with _ for spaces and small letters; where there is none, the
/// name itself, which is data then.
std::string tr_name(std::string_view family, std::string_view name);

/// Figures as the language writes them: 12.5 is 12,5 in German. For what people read, never for files.
std::string local_figures(std::string text);

}  // namespace dubsar::app
