#include "core/edition/atf_chunks.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/base/text/parse_number.h"
#include "core/edition/line_number.h"

namespace dubsar {
namespace {

int rank_in(std::string_view word, auto& words) {
  return static_cast<int>(std::find(words.begin(), words.end(), word) - words.begin());
}

std::string named(const AtfLine& line) { return line.value.empty() ? line.key : line.key + " " + line.value; }

}  // namespace

int rank_of_object(std::string_view object) {
  constexpr std::array<std::string_view, 2> kFirst{"tablet", "envelope"};
  return rank_in(object, kFirst);
}

int rank_of_surface(std::string_view surface) {
  constexpr std::array<std::string_view, 6> kRead{"obverse", "bottom", "reverse", "top", "left", "right"};
  return rank_in(surface.empty() ? "obverse" : surface, kRead) + (surface.starts_with("seal") ? 1 : 0);
}

bool is_read_before(const TextSpot& a, const TextSpot& b) {
  const auto key = [](const TextSpot& spot) {
    return std::tuple(rank_of_object(spot.object), spot.object, rank_of_surface(spot.surface), spot.surface,
                      spot.column);
  };
  return key(a) != key(b) ? key(a) < key(b) : is_line_before(a.number, b.number);
}

bool belongs_to_line(AtfKind kind) {
  switch (kind) {
    case AtfKind::kContinued:
    case AtfKind::kManuscript:
    case AtfKind::kLemmas:
    case AtfKind::kTranslation:
    case AtfKind::kNote:
    case AtfKind::kLink:
    case AtfKind::kBilingual:
    case AtfKind::kGloss:
      return true;
    default:
      return false;
  }
}

std::vector<AtfChunk> chunks_of(const AtfFile& text) {
  std::vector<AtfChunk> out(1);
  for (const AtfLine& line : text.lines) {
    AtfChunk next;
    next.object = out.back().object;
    next.surface = out.back().surface;
    bool begins = true;
    switch (line.kind) {
      case AtfKind::kObject:
        next.object = named(line);
        next.surface.clear();
        break;
      case AtfKind::kSurface:
      case AtfKind::kSeal:
        next.surface = named(line);
        break;
      case AtfKind::kColumn:
        next.column = parse_whole(line.value).value_or(0);
        break;
      case AtfKind::kTranslationBlock:
        next.tail = true;
        break;
      default:
        begins = false;
    }
    if (begins && !out.back().tail) out.push_back(std::move(next));
    out.back().lines.push_back(line);
  }
  return out;
}

}  // namespace dubsar
