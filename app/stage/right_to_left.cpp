#include "app/stage/right_to_left.h"

#include <fribidi/fribidi.h>

#include <algorithm>

#include "display/render/images/utf8.h"

namespace dubsar::app {
namespace {

constexpr FriBidiChar kLostInALigature = 0xfeff;  // FriBidi leaves it where two letters became one

bool is_right_to_left(unsigned code) {
  return FRIBIDI_IS_RTL(fribidi_get_bidi_type(code)) != 0 || fribidi_get_bidi_type(code) == FRIBIDI_TYPE_AN;
}

std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    if (end > at) out.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

}  // namespace

bool has_right_to_left(std::string_view text) {
  const std::vector<unsigned> codes = code_points(text);
  return std::any_of(codes.begin(), codes.end(), is_right_to_left);
}

std::string as_seen(std::string_view line, bool right_to_left) {
  const std::vector<unsigned> codes = code_points(line);
  if (std::none_of(codes.begin(), codes.end(), is_right_to_left)) return std::string(line);
  std::vector<FriBidiChar> text(codes.begin(), codes.end());
  const auto count = static_cast<FriBidiStrIndex>(text.size());
  std::vector<FriBidiCharType> types(text.size());
  std::vector<FriBidiBracketType> brackets(text.size());
  std::vector<FriBidiLevel> levels(text.size());
  std::vector<FriBidiArabicProp> joins(text.size());
  fribidi_get_bidi_types(text.data(), count, types.data());
  fribidi_get_bracket_types(text.data(), count, types.data(), brackets.data());
  FriBidiParType base = right_to_left ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_LTR;
  const FriBidiFlags flags = FRIBIDI_FLAGS_DEFAULT | FRIBIDI_FLAGS_ARABIC;
  if (fribidi_get_par_embedding_levels_ex(types.data(), brackets.data(), count, &base, levels.data()) == 0)
    return std::string(line);  // only where memory is out
  fribidi_get_joining_types(text.data(), count, joins.data());
  fribidi_join_arabic(types.data(), count, levels.data(), joins.data());
  fribidi_shape(flags, levels.data(), count, joins.data(), text.data());
  if (fribidi_reorder_line(flags, types.data(), count, 0, base, levels.data(), text.data(), nullptr) == 0)
    return std::string(line);
  std::string out;
  for (const FriBidiChar code : text) {
    const FriBidiCharType type = fribidi_get_bidi_type(code);
    const bool mark = FRIBIDI_IS_EXPLICIT_OR_BN(type) != 0 || type == FRIBIDI_TYPE_LRI || type == FRIBIDI_TYPE_RLI ||
                      type == FRIBIDI_TYPE_FSI || type == FRIBIDI_TYPE_PDI || code == 0x200e || code == 0x200f;
    if (code != kLostInALigature && !mark) out += utf8(code);
  }
  return out;
}

std::vector<std::string> lines_as_seen(std::string_view text, bool right_to_left,
                                       const std::function<bool(const std::string&)>& fits) {
  std::vector<std::string> out;
  std::string line;
  for (const std::string& word : split_words(text)) {
    std::string longer = line;
    if (!longer.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && !fits(as_seen(longer, right_to_left))) {
      out.push_back(as_seen(line, right_to_left));
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) out.push_back(as_seen(line, right_to_left));
  return out;
}

}  // namespace dubsar::app
