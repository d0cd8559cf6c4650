#include "core/edition/text_passages.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/edition/atf_chunks.h"
#include "core/edition/line_number.h"

namespace dubsar {
namespace {

/// The lines of a chunk that say what one numbered line is: [first, end).
struct LineBlock {
  std::size_t first = 0, end = 0;
};

std::size_t block_end(const std::vector<AtfLine>& lines, std::size_t first) {
  std::size_t end = first + 1;
  while (end < lines.size() && belongs_to_line(lines[end].kind)) ++end;
  return end;
}

std::string text_of_block(const std::vector<AtfLine>& lines, const LineBlock& block) {
  std::string out = lines[block.first].value;
  for (std::size_t k = block.first + 1; k < block.end && lines[k].kind == AtfKind::kContinued; ++k)
    out += (out.empty() ? "" : " ") + lines[k].value;
  return out;
}

std::string usual_end(const AtfFile& file) {
  const auto dos =
      std::count_if(file.lines.begin(), file.lines.end(), [](const AtfLine& l) { return l.end == "\r\n"; });
  return 2 * static_cast<std::size_t>(dos) > file.lines.size() ? "\r\n" : "\n";
}

/// Puts passages into the chunks of a text.
class PassageWriter {
 public:
  PassageWriter(const AtfFile& base, std::string translated)
      : chunks_(chunks_of(base)), end_(usual_end(base)), translated_(std::move(translated)) {}

  void set_head(const TabletRecord& record) {
    std::vector<AtfLine>& lines = chunks_.front().lines;
    const auto head =
        std::find_if(lines.begin(), lines.end(), [](const AtfLine& line) { return line.kind == AtfKind::kText; });
    const std::string name = record.museum_number.empty() ? name_of(record) : record.museum_number;
    if (head == lines.end()) {
      // Not catalogued: no number is made up, X is for what has none.
      const std::string id = record.p_number.empty() ? "X000001" : record.p_number;
      lines.insert(lines.begin(), {line(fmt::format("&{} = {}", id, name.empty() ? "unnamed" : name)),
                                   line("#atf: lang " + atf_language(record.language))});
    } else if (!record.p_number.empty() && record.p_number != head->key) {
      *head = line(fmt::format("&{} = {}", record.p_number, head->value.empty() ? name : head->value), head->end);
    }
  }

  void put(const TextPassage& passage) {
    AtfChunk& chunk = chunk_of(passage.spot);
    std::vector<AtfLine>& lines = chunk.lines;
    for (std::size_t k = 0; k < lines.size(); ++k)
      if (lines[k].kind == AtfKind::kLine && lines[k].key == passage.spot.number)
        return change(lines, {k, block_end(lines, k)}, passage);
    insert(lines, passage);
  }

  AtfFile take() {
    AtfFile out;
    for (AtfChunk& chunk : chunks_)
      for (AtfLine& each : chunk.lines) {
        if (!out.lines.empty() && out.lines.back().end.empty()) out.lines.back().end = end_;
        out.lines.push_back(std::move(each));
      }
    return out;
  }

 private:
  AtfLine line(std::string bytes) const { return line(std::move(bytes), end_); }
  static AtfLine line(const std::string& bytes, const std::string& end) {
    AtfLine out = atf_line(bytes);
    out.end = end;
    return out;
  }
  std::string translation_bytes(const TextPassage& passage) const {
    return fmt::format("#tr.{}: {}", translated_, passage.translation);
  }

  void change(std::vector<AtfLine>& lines, const LineBlock& block, const TextPassage& passage) {
    LineBlock now = block;
    if (text_of_block(lines, block) != passage.text) {
      const std::string& bytes = lines[now.first].bytes;
      const std::size_t number = bytes.find('.') + 1;
      const std::size_t text = bytes.find_first_not_of(" \t", number);
      const std::string between =
          text == std::string::npos || text == number ? " " : bytes.substr(number, text - number);
      lines[now.first] = line(bytes.substr(0, number) + between + passage.text, lines[now.first].end);
      while (now.first + 1 < now.end && lines[now.first + 1].kind == AtfKind::kContinued) {
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(now.first) + 1);
        --now.end;
      }
    }
    if (passage.translation.empty()) return;
    for (std::size_t k = now.first; k < now.end; ++k) {
      if (lines[k].kind != AtfKind::kTranslation || lines[k].key != translated_) continue;
      if (lines[k].value != passage.translation) lines[k] = line(translation_bytes(passage), lines[k].end);
      return;
    }
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(now.end), line(translation_bytes(passage)));
  }

  void insert(std::vector<AtfLine>& lines, const TextPassage& passage) const {
    // Behind the last line that is read before it; else before the first one; else at the end, before blank lines.
    std::size_t at = lines.size();
    while (at > 0 && lines[at - 1].kind == AtfKind::kBlank) --at;
    bool behind = false;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (lines[k].kind != AtfKind::kLine) continue;
      if (is_line_before(lines[k].key, passage.spot.number)) {
        at = block_end(lines, k);
        behind = true;
      } else if (!behind) {
        at = k;
        break;
      }
    }
    std::vector<AtfLine> fresh{
        line(fmt::format("{}. {}", passage.spot.number, passage.text.empty() ? "..." : passage.text))};
    if (!passage.translation.empty()) fresh.push_back(line(translation_bytes(passage)));
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), fresh.begin(), fresh.end());
  }

  AtfChunk& chunk_of(const TextSpot& spot) {
    const auto fits = [&](const AtfChunk& chunk) {
      return !chunk.tail && chunk.object == spot.object && chunk.side() == spot.surface && chunk.column == spot.column;
    };
    // A line that is there already may stand before any side is named.
    for (AtfChunk& chunk : chunks_)
      if (fits(chunk) && std::any_of(chunk.lines.begin(), chunk.lines.end(), [&](const AtfLine& each) {
            return each.kind == AtfKind::kLine && each.key == spot.number;
          }))
        return chunk;
    for (AtfChunk& chunk : chunks_) {
      const bool any_line = std::any_of(chunk.lines.begin(), chunk.lines.end(),
                                        [](const AtfLine& each) { return each.kind == AtfKind::kLine; });
      if (fits(chunk) && (!chunk.surface.empty() || any_line)) return chunk;
    }
    return add_chunk(spot);
  }

  AtfChunk& add_chunk(const TextSpot& spot) {
    const auto has = [&](auto test) { return std::any_of(chunks_.begin(), chunks_.end(), test); };
    const bool object_named = has([&](const AtfChunk& chunk) {
      return chunk.object == spot.object && !chunk.lines.empty() &&
             (chunk.lines.front().kind == AtfKind::kObject || !chunk.surface.empty());
    });
    const bool side_named = object_named && has([&](const AtfChunk& chunk) {
                              return chunk.object == spot.object && chunk.surface == spot.surface;
                            });
    AtfChunk fresh;
    fresh.object = spot.object;
    fresh.surface = spot.surface;
    fresh.column = spot.column;
    if (!object_named) fresh.lines.push_back(line("@" + spot.object));
    if (!side_named) fresh.lines.push_back(line("@" + spot.surface));
    if (spot.column > 0) fresh.lines.push_back(line(fmt::format("@column {}", spot.column)));
    std::size_t at = 1;  // behind the head of the text
    for (std::size_t k = 1; k < chunks_.size(); ++k) {
      const AtfChunk& chunk = chunks_[k];
      const TextSpot other{chunk.object, chunk.side(), chunk.column, spot.number};
      if (!chunk.tail && !is_read_before(spot, other)) at = k + 1;
    }
    return *chunks_.insert(chunks_.begin() + static_cast<std::ptrdiff_t>(at), std::move(fresh));
  }

  std::vector<AtfChunk> chunks_;
  std::string end_, translated_;
};

std::string language_of_translation(const TabletRecord& record) {
  return record.translated.empty() ? "en" : record.translated;
}

}  // namespace

std::vector<TextPassage> passages_of(const AtfFile& file, std::string_view translated_into) {
  if (translated_into.empty()) translated_into = "en";
  AtfFile first;
  bool any = false;
  for (const AtfLine& line : file.lines) {
    if (line.kind == AtfKind::kText && std::exchange(any, true)) break;
    first.lines.push_back(line);
  }
  std::vector<TextPassage> out;
  for (const AtfChunk& chunk : chunks_of(first)) {
    const std::vector<AtfLine>& lines = chunk.lines;
    for (std::size_t k = 0; k < lines.size() && !chunk.tail; ++k) {
      if (lines[k].kind != AtfKind::kLine) continue;
      const LineBlock block{k, block_end(lines, k)};
      TextPassage passage{{chunk.object, chunk.side(), chunk.column, lines[k].key}, text_of_block(lines, block), {}};
      for (std::size_t j = block.first; j < block.end; ++j)
        if (lines[j].kind == AtfKind::kTranslation && lines[j].key == translated_into)
          passage.translation = lines[j].value;
      out.push_back(std::move(passage));
    }
  }
  return out;
}

Result<AtfFile> text_of_atf(const AtfFile& file, const TabletRecord& record, std::string_view source) {
  std::vector<AtfFile> texts;
  std::vector<const AtfLine*> heads;
  for (const AtfLine& line : file.lines) {
    if (line.kind == AtfKind::kText) {
      texts.emplace_back();
      heads.push_back(&line);
    }
    if (!texts.empty()) texts.back().lines.push_back(line);
  }
  if (texts.empty())
    return fail(ErrorKind::kBadData, "{}: no text found, expected a line such as \"&P123456 = AO 8295\"", source);
  for (std::size_t k = 0; k < texts.size(); ++k)
    if (!record.p_number.empty() && heads[k]->key == record.p_number) return texts[k];
  for (std::size_t k = 0; k < texts.size(); ++k)
    if (!heads[k]->value.empty() && (heads[k]->value == record.museum_number || heads[k]->value == record.title))
      return texts[k];
  if (texts.size() > 1)
    return fail(ErrorKind::kBadData,
                "{} holds {} texts, and none of them is {}; say which with the command p_number, e.g. \"p_number {}\"",
                source, texts.size(), record == TabletRecord{} ? "known to be this tablet's" : name_of(record),
                heads[0]->key);
  return texts[0];
}

TabletRecord record_of(const AtfFile& text) {
  TabletRecord out;
  for (const AtfLine& line : text.lines) {
    if (line.kind == AtfKind::kText) {
      if (const auto number = catalogue_number(line.key); number && !line.key.starts_with("X")) out.p_number = *number;
      out.title = line.value;
    }
    if (line.kind == AtfKind::kProtocol && line.key == "atf" && line.value.starts_with("lang "))
      out.language = tag_of_atf_language(std::string_view(line.value).substr(5));
    if (line.kind == AtfKind::kTranslation && out.translated.empty()) out.translated = line.key;
  }
  return out;
}

AtfFile with_passages(const AtfFile& base, const TabletRecord& record, std::span<const TextPassage> passages) {
  PassageWriter writer(base, language_of_translation(record));
  writer.set_head(record);
  std::vector<TextPassage> sorted(passages.begin(), passages.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const TextPassage& a, const TextPassage& b) { return is_read_before(a.spot, b.spot); });
  for (const TextPassage& passage : sorted) writer.put(passage);
  return writer.take();
}

}  // namespace dubsar
