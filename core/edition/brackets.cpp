#include "core/edition/brackets.h"

#include <algorithm>
#include <array>

namespace dubsar {
namespace {

struct BracketPair {
  std::string_view open, close;
  bool nests = false;
};
// Longer ones first: << before <.
constexpr std::array<BracketPair, 8> kBracketPairs{{{"<<", ">>", false},
                                                    {"{{", "}}", false},
                                                    {"[", "]", false},
                                                    {"\u2e22", "\u2e23", false},
                                                    {"\u02f9", "\u02fa", false},
                                                    {"(", ")", true},
                                                    {"{", "}", true},
                                                    {"<", ">", false}}};
constexpr std::string_view kRoom = "($___$)";  // that the scribe left, of a token

struct FoundBracket {
  std::size_t byte = 0;
  std::size_t pair = 0;
  bool nested = false;
};

/// What is left open, and what closes nothing, by byte.
struct BracketScan {
  std::vector<FoundBracket> open, unopened, nested;
};

BracketScan scan_brackets(std::string_view text) {
  BracketScan out;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with(kRoom)) {
      at += kRoom.size();
      continue;
    }
    std::size_t step = 1;
    for (std::size_t p = 0; p < kBracketPairs.size(); ++p) {
      const BracketPair& pair = kBracketPairs[p];
      const auto same = [&](const FoundBracket& each) { return each.pair == p; };
      if (rest.starts_with(pair.open)) {
        if (!pair.nests && std::any_of(out.open.begin(), out.open.end(), same)) out.nested.push_back({at, p});
        out.open.push_back({at, p});
        step = pair.open.size();
        break;
      }
      if (rest.starts_with(pair.close)) {
        const auto last = std::find_if(out.open.rbegin(), out.open.rend(), same);
        if (last == out.open.rend())
          out.unopened.push_back({at, p});
        else
          out.open.erase(std::next(last).base());
        step = pair.close.size();
        break;
      }
    }
    at += step;
  }
  return out;
}

}  // namespace

std::size_t characters_before(std::string_view text, std::size_t byte) {
  std::size_t out = 0;
  for (std::size_t at = 0; at < std::min(byte, text.size()); ++at)
    if ((static_cast<unsigned char>(text[at]) & 0xc0u) != 0x80u) ++out;
  return out;
}

std::vector<BracketFault> bracket_faults(std::string_view text) {
  const BracketScan scan = scan_brackets(text);
  std::vector<BracketFault> out;
  const auto add = [&](const std::vector<FoundBracket>& found, BracketFault::Kind kind) {
    for (const FoundBracket& each : found) {
      const BracketPair& pair = kBracketPairs[each.pair];
      const bool closes = kind == BracketFault::Kind::kNotOpened;
      out.push_back({characters_before(text, each.byte) + 1, std::string(closes ? pair.close : pair.open), kind});
    }
  };
  add(scan.open, BracketFault::Kind::kNotClosed);
  add(scan.unopened, BracketFault::Kind::kNotOpened);
  add(scan.nested, BracketFault::Kind::kNested);
  std::stable_sort(out.begin(), out.end(),
                   [](const BracketFault& a, const BracketFault& b) { return a.column < b.column; });
  return out;
}

std::string with_brackets_closed(std::string_view text) {
  const BracketScan scan = scan_brackets(text);
  std::string before, after;
  for (auto it = scan.unopened.rbegin(); it != scan.unopened.rend(); ++it) before += kBracketPairs[it->pair].open;
  for (auto it = scan.open.rbegin(); it != scan.open.rend(); ++it) after += kBracketPairs[it->pair].close;
  return before + std::string(text) + after;
}

bool tells_damage(std::string_view text) {
  for (const std::string_view mark : {"[", "]", "\u2e22", "\u2e23", "\u02f9", "\u02fa"})
    if (text.find(mark) != std::string_view::npos) return true;
  const std::size_t flag = text.find('#');
  return flag != std::string_view::npos && flag > 0 && text[flag - 1] != ' ';
}

}  // namespace dubsar
