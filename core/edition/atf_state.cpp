// The grammar of lines that begin with $: what became of the clay.

#include <algorithm>
#include <array>

#include "core/edition/atf.h"

namespace dubsar {
namespace {

constexpr std::array<std::string_view, 8> kStates{"blank",   "broken", "effaced", "illegible",
                                                  "missing", "traces", "omitted", "continues"};
constexpr std::array<std::string_view, 5> kStatePlaces{"rest", "start", "beginning", "middle", "end"};
constexpr std::array<std::string_view, 24> kStateScopes{
    "tablet", "envelope", "prism", "bulla",  "fragment", "object", "obverse", "reverse",
    "left",   "right",    "top",   "bottom", "edge",     "face",   "side",    "surface",
    "column", "columns",  "line",  "lines",  "case",     "cases",  "excerpt", "space"};

bool is_in(std::string_view word, auto& words) { return std::find(words.begin(), words.end(), word) != words.end(); }

/// Words of a state, taken from the left.
class StateWords {
 public:
  explicit StateWords(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
      if (end > 0) words_.push_back(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }
  bool done() const { return at_ == words_.size(); }
  bool take(std::string_view word) {
    return take_if([&](std::string_view each) { return each == word; });
  }
  bool take_of(auto& words) {
    return take_if([&](std::string_view each) { return is_in(each, words); });
  }
  bool take_number() {
    return take_if([](std::string_view each) {
      const std::size_t dash = each.find('-');
      const auto whole = [](std::string_view part) {
        return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
      };
      return dash == std::string_view::npos ? whole(each) : whole(each.substr(0, dash)) && whole(each.substr(dash + 1));
    });
  }
  bool take_short() {  // of "edge b", "column 2'", "seal 1"
    return take_if([](std::string_view each) { return each.size() <= 3 && !is_in(each, kStates); });
  }

 private:
  template <class Test>
  bool take_if(Test test) {
    if (done() || !test(words_[at_])) return false;
    ++at_;
    return true;
  }
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
};

bool is_strict(std::string_view text) {
  while (!text.empty() && std::string_view("?!*").find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  if (text.ends_with("\u00b0")) text.remove_suffix(2);
  while (text.ends_with(" ")) text.remove_suffix(1);
  for (const std::string_view ruling : {"ruling", "single ruling", "double ruling", "triple ruling"})
    if (text == ruling) return true;
  StateWords words(text);
  if (words.take("seal")) return words.take_short() && words.done();
  if (words.take("at")) {
    if (!words.take("least") && !words.take("most")) return false;
  } else {
    words.take("about");
  }
  bool any = words.take_number() || words.take("several") || words.take("some");
  if (words.take_of(kStatePlaces)) {
    if (!words.take("of") || !words.take_of(kStateScopes)) return false;
    any = true;
    words.take_short();
  } else if (words.take_of(kStateScopes)) {
    any = true;
    words.take_short();
  }
  return (words.take_of(kStates) || any) && words.done();
}

}  // namespace

AtfStateForm atf_state_form(std::string_view value) {
  if (value.starts_with("@(")) return AtfStateForm::kFree;  // in a block of translation
  if (value.starts_with("(") && value.ends_with(")")) return AtfStateForm::kFree;
  return is_strict(value) ? AtfStateForm::kStrict : AtfStateForm::kWrong;
}

}  // namespace dubsar
