#pragma once
// Words and numbers of text formats, independent of the locale.

#include <charconv>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace dubsar {

class TextScanner {
 public:
  explicit TextScanner(std::string_view text) noexcept : text_(text) {}

  /// The next word, separated by blanks of any kind including line ends; empty at the end.
  std::string_view word() noexcept {
    while (!text_.empty() && blank(text_.front())) text_.remove_prefix(1);
    std::size_t length = 0;
    while (length < text_.size() && !blank(text_[length])) ++length;
    const std::string_view found = text_.substr(0, length);
    text_.remove_prefix(length);
    return found;
  }
  /// False when the next word is missing or not a number of this type, to its last character.
  template <class T>
  bool number(T& value) noexcept {
    return parse(word(), value);
  }
  template <class T>
  static bool parse(std::string_view text, T& value) noexcept {
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    if (text.empty()) return false;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return false;
    if constexpr (std::is_floating_point_v<T>) {
      if (error == std::errc::result_out_of_range && text.find_first_of("eE") != std::string_view::npos &&
          text[text.find_first_of("eE") + 1] == '-') {
        value = T(0);  // smaller than the smallest number
        return true;
      }
    }
    return error == std::errc();
  }
  /// The rest of the line without its end; moves behind it. \n, \r\n and \r end lines.
  std::string_view line() noexcept {
    const std::size_t length = text_.find_first_of("\r\n");
    if (length == std::string_view::npos) {
      const std::string_view last = text_;
      text_ = {};
      return last;
    }
    const std::string_view found = text_.substr(0, length);
    const bool two = text_[length] == '\r' && length + 1 < text_.size() && text_[length + 1] == '\n';
    text_.remove_prefix(length + (two ? 2 : 1));
    return found;
  }
  std::string_view rest() const noexcept { return text_; }

 private:
  static bool blank(char c) noexcept { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string_view text_;
};

}  // namespace dubsar
