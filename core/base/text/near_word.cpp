#include "core/base/text/near_word.h"

#include <algorithm>

#include "core/base/text/lower_text.h"

namespace dubsar {
namespace {

/// Damerau and Levenshtein's distance with neighbours exchanged at most once.
std::size_t slips(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t k = 0; k <= b.size(); ++k) d[0][k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t k = 1; k <= b.size(); ++k) {
      d[i][k] =
          std::min({d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + std::size_t{a[i - 1] == b[k - 1] ? 0u : 1u}});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        d[i][k] = std::min(d[i][k], d[i - 2][k - 2] + 1);
    }
  return d[a.size()][b.size()];
}

constexpr std::size_t kLongestWord = 64;  // longer ones are no slips, and cost time

}  // namespace

std::string near_word(std::string_view word, std::span<const std::string> known) {
  if (word.size() < 2 || word.size() > kLongestWord) return {};
  const std::string wanted = lower_text(word);
  std::string best;
  std::size_t least = word.size() < 5 ? 2 : 3;  // nearer than this
  for (const std::string& candidate : known) {
    if (candidate.empty() || candidate.size() > kLongestWord || candidate == word) continue;
    const std::size_t distance = slips(wanted, lower_text(candidate));
    if (distance < least) least = distance, best = candidate;
  }
  if (!best.empty() || wanted.size() < 3) return best;
  for (const std::string& candidate : known)
    if (lower_text(candidate).starts_with(wanted)) {
      if (!best.empty()) return {};
      best = candidate;
    }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::string near = near_word(word, known);
  return near.empty() ? "" : "; did you mean \"" + near + "\"?";
}

std::string did_you_mean(std::string_view word, std::string_view known) {
  std::vector<std::string> words;
  while (!known.empty()) {
    const std::size_t end = known.find(", ");
    words.emplace_back(known.substr(0, end));
    known.remove_prefix(end == std::string_view::npos ? known.size() : end + 2);
  }
  return did_you_mean(word, std::span<const std::string>(words));
}

}  // namespace dubsar
