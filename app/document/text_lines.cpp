#include "app/document/text_lines.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "core/edition/line_label.h"
#include "core/edition/line_number.h"

namespace dubsar::app {
namespace {

glm::dvec3 middle_of(const Note& note) { return 0.5 * (note.line_mm.front() + note.line_mm.back()); }

/// Unit, in the surface: to the line above.
glm::dvec3 up_of(const Note& note) {
  const glm::dvec3 up = glm::cross(note.normal, note.line_mm.back() - note.line_mm.front());
  const double length = glm::length(up);
  return length > 0 ? up / length : glm::dvec3(0, 1, 0);
}

std::string object_of(const Note& note) { return note.part.starts_with("envelope") ? "envelope" : "tablet"; }

/// Lines of one side, in the order of their numbers.
struct SideLine {
  std::size_t note = 0;
  TextSpot spot;
};
std::vector<SideLine> lines_of(const Document& document, const std::string& object, const std::string& side) {
  std::vector<SideLine> out;
  for (std::size_t k = 0; k < document.notes.size(); ++k) {
    const auto spot = is_text_line(document.notes[k]) ? spot_of(document.notes[k]) : std::nullopt;
    if (spot && spot->object == object && spot->surface == side) out.push_back({k, *spot});
  }
  std::sort(out.begin(), out.end(),
            [](const SideLine& a, const SideLine& b) { return is_read_before(a.spot, b.spot); });
  return out;
}

/// Numbers from this one on, as long as they follow each other, are those of the line below.
void make_room(Document& document, const std::vector<SideLine>& lines, const TextSpot& spot) {
  std::string number = spot.number;
  for (const SideLine& line : lines) {
    if (line.spot.column != spot.column || line.spot.number != number) continue;
    number = next_line_number(number);
    TextSpot moved = line.spot;
    moved.number = number;
    document.notes[line.note].label = line_label(moved);
  }
}

}  // namespace

bool is_text_line(const Note& note) { return note.line_mm.size() > 1; }

std::optional<TextSpot> spot_of(const Note& note) {
  auto out = spot_of_label(note.label);
  if (out) out->object = object_of(note);
  return out;
}

std::vector<TextPassage> passages_of(const Document& document) {
  std::vector<TextPassage> out;
  for (const Note& note : document.notes) {
    if (!is_text_line(note)) continue;
    if (const auto spot = spot_of(note)) out.push_back({*spot, note.text, note.translation});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const TextPassage& a, const TextPassage& b) { return is_read_before(a.spot, b.spot); });
  return out;
}

std::vector<TextPassage> waiting_lines(const Document& document) {
  std::vector<TextPassage> out =
      dubsar::passages_of(read_atf(document.edition.atf), document.edition.record.translated);
  const std::vector<TextPassage> pinned = passages_of(document);
  std::erase_if(out, [&](const TextPassage& each) {
    return std::any_of(pinned.begin(), pinned.end(), [&](const TextPassage& p) { return p.spot == each.spot; });
  });
  return out;
}

void put_line(Document& document, Note line, const std::string& side) {
  const std::string object = object_of(line);
  const std::vector<SideLine> lines = lines_of(document, object, side);
  const glm::dvec3 up = up_of(line);
  const double height = glm::dot(middle_of(line), up);
  TextSpot spot{object, side, 0, "1"};
  const SideLine *above = nullptr, *below = nullptr;
  if (!lines.empty()) {  // of the column that the nearest line has
    const auto far = [&](const SideLine& each) {
      return glm::distance(middle_of(document.notes[each.note]), middle_of(line));
    };
    spot.column = std::min_element(lines.begin(), lines.end(), [&](const SideLine& a, const SideLine& b) {
                    return far(a) < far(b);
                  })->spot.column;
  }
  for (const SideLine& each : lines) {
    if (each.spot.column != spot.column) continue;
    const bool higher = glm::dot(middle_of(document.notes[each.note]), up) > height;
    if (!higher && below == nullptr) below = &each;
    if (higher && below == nullptr) above = &each;
  }
  if (above != nullptr) spot.number = next_line_number(above->spot.number);
  if (above == nullptr && below != nullptr) spot.number = below->spot.number;
  if (line.text.empty()) {
    for (const TextPassage& waits : waiting_lines(document)) {
      if (waits.spot.object != object || waits.spot.surface != side) continue;
      if (above != nullptr && is_read_before(waits.spot, above->spot)) continue;
      if (below != nullptr && is_read_before(below->spot, waits.spot)) break;
      spot = waits.spot;
      line.text = waits.text;
      line.translation = waits.translation;
      break;
    }
  }
  make_room(document, lines, spot);
  line.label = line_label(spot);
  document.notes.push_back(std::move(line));
}

std::array<glm::dvec3, 2> place_beside(const Document& document, std::size_t line, double share) {
  const Note& note = document.notes[line];
  const glm::dvec3 up = up_of(note);
  double interval = kUsualIntervalMm;
  if (const auto spot = spot_of(note)) {
    const glm::dvec3 here = middle_of(note);
    double nearest = 1e30;
    for (const SideLine& each : lines_of(document, spot->object, spot->surface)) {
      const double rise = glm::dot(middle_of(document.notes[each.note]) - here, up);
      if (each.note != line && each.spot.column == spot->column && rise > 0 && rise < nearest) nearest = rise;
    }
    if (nearest < 1e30) interval = nearest;
  }
  const glm::dvec3 way = -share * interval * up;
  return {note.line_mm.front() + way, note.line_mm.back() + way};
}

AtfFile atf_of(const Document& document) {
  std::vector<TextPassage> lines = passages_of(document);
  std::erase_if(lines, [](const TextPassage& line) { return line.text.empty(); });
  return with_passages(read_atf(document.edition.atf), document.edition.record, lines);
}

AtfTaken take_atf(Document& document, const AtfFile& text) {
  TabletRecord& record = document.edition.record;
  const TabletRecord said = record_of(text);
  const auto fill = [](std::string& here, const std::string& there) {
    if (here.empty()) here = there;
  };
  fill(record.p_number, said.p_number);
  fill(record.title, said.title);
  fill(record.language, said.language);
  fill(record.translated, said.translated);
  document.edition.atf = write_atf(text);
  AtfTaken out;
  for (const TextPassage& passage : dubsar::passages_of(text, record.translated)) {
    ++out.lines;
    for (Note& note : document.notes) {
      if (!is_text_line(note) || spot_of(note) != passage.spot) continue;
      ++out.pinned;
      note.text = passage.text;
      if (!passage.translation.empty()) note.translation = passage.translation;
    }
  }
  return out;
}

}  // namespace dubsar::app
