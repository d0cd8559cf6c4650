#pragma once
// The language of the window: English is in the program, others are files {"tool.turn": "Drehen", ...}. What a file
// lacks is English.

#include <string>
#include <string_view>
#include <vector>

#include "app/words/text.h"
#include "core/base/result.h"

namespace dubsar::app {

class Language {
 public:
  /// English.
  Language();
  /// From the text of a file. kConfig: no object of texts, an id that does not exist, a text whose placeholders are not
  /// those of the English one, or with another number of forms than the language has.
  static Result<Language> parse(std::string_view code, std::string_view json_text, std::string_view source);

  const std::string& code() const noexcept { return code_; }
  const std::string& name() const noexcept { return (*this)[Text("language.name")]; }
  const std::string& operator[](const Text& text) const { return texts_[text.place()]; }
  /// Which of the forms of a text is that for `count`.
  std::size_t form(long long count) const noexcept;
  std::size_t forms() const noexcept;
  /// Ids that have a text of their own.
  std::size_t translated() const noexcept { return translated_; }

 private:
  std::string code_ = "en";
  std::vector<std::string> texts_;
  std::size_t translated_ = 0;
};

/// Codes of the languages in the program, English first: "en", "de".
const std::vector<std::string>& language_codes();

/// One of them, or a file FILE.json, becomes that of the window. kUsage: neither; errors of Language::parse and of
/// reading. One thread, that of the window.
Result<void> use_language(const std::string& code_or_file);
/// The present one.
const Language& language();

/// The language that a value of LC_ALL, LC_MESSAGES or LANG asks for, as "de" of "de_DE.UTF-8"; English where the
/// program does not speak it.
std::string language_of_locale(std::string_view locale);

}  // namespace dubsar::app
