#include "core/edition/line_label.h"

#include <array>
#include <utility>

#include "core/edition/line_number.h"

namespace dubsar {
namespace {

// The first of each side is the one that is written.
constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kSideLabels{{{"obverse", "o."},
                                                                                     {"obverse", "o"},
                                                                                     {"obverse", "obv."},
                                                                                     {"bottom", "lo.e."},
                                                                                     {"bottom", "b.e."},
                                                                                     {"bottom", "lower edge"},
                                                                                     {"reverse", "r."},
                                                                                     {"reverse", "r"},
                                                                                     {"reverse", "rev."},
                                                                                     {"top", "u.e."},
                                                                                     {"top", "t.e."},
                                                                                     {"top", "upper edge"},
                                                                                     {"left", "le.e."},
                                                                                     {"left", "l.e."},
                                                                                     {"left", "left edge"},
                                                                                     {"right", "r.e."},
                                                                                     {"right", "right edge"}}};

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::string side_abbreviation(std::string_view surface) {
  for (const auto& [name, label] : kSideLabels)
    if (name == surface) return std::string(label);
  return std::string(surface) + ":";
}

std::string line_label(const TextSpot& spot) {
  return side_abbreviation(spot.surface) + " " + (spot.column > 0 ? roman_number(spot.column) + " " : "") + spot.number;
}

std::optional<TextSpot> spot_of_label(std::string_view label) {
  TextSpot out;
  std::string_view rest = without_blanks(label);
  if (const std::size_t colon = rest.find(": "); colon != std::string_view::npos && colon > 0) {
    out.surface = rest.substr(0, colon);
    rest = without_blanks(rest.substr(colon + 1));
  } else {
    std::size_t longest = 0;
    for (const auto& [name, known] : kSideLabels)
      if (rest.starts_with(known) && known.size() > longest &&
          (rest.size() == known.size() || rest[known.size()] == ' ')) {
        out.surface = name;
        longest = known.size();
      }
    rest = without_blanks(rest.substr(longest));
  }
  if (const std::size_t blank = rest.find(' '); blank != std::string_view::npos) {
    out.column = number_of_roman(rest.substr(0, blank));
    if (out.column == 0) return std::nullopt;
    rest = without_blanks(rest.substr(blank));
  }
  if (!is_line_number(rest)) return std::nullopt;
  out.number = rest;
  return out;
}

}  // namespace dubsar
