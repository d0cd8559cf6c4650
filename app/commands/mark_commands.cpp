// Commands for what is put on the surface: measures, notes, and the tools that place them by clicks.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/document_file.h"
#include "app/document/mark_file.h"
#include "core/edition/line_label.h"

namespace dubsar::app {
namespace {

constexpr std::string_view kMeasures = "Measures", kNotes = "Notes";
constexpr std::array<std::string_view, 8> kTools{"turn",    "distance", "angle", "depth",
                                                 "profile", "note",     "line",  "slice"};

/// As editions count lines: o. 1, lo.e. 2, r. 3 ...
std::string next_label(const Document& document, const std::string& side) {
  const std::string prefix = side.empty() ? "" : side_abbreviation(side) + " ";
  for (int number = 1;; ++number) {
    std::string label = fmt::format("{}{}", prefix, number);
    if (std::none_of(document.notes.begin(), document.notes.end(),
                     [&](const Note& note) { return note.label == label; }))
      return label;
  }
}

Result<void> add_measure(Editor& editor, MeasureKind kind, const std::vector<SurfacePin>& pins, std::string name) {
  Measure measure{kind, std::move(name), pins.front().part, {}, {}};
  for (const SurfacePin& pin : pins) measure.points_mm.push_back(pin.at_mm);
  DUBSAR_ASSIGN(measure.figures, editor.place().figures(measure));
  Document next = editor.document();
  const std::string words = figures_text(measure);
  next.measures.push_back(std::move(measure));
  give_ids(next);
  editor.change(std::move(next), "measure");
  editor.place().say(words);
  return {};
}

void add_pin(Editor& editor, const SurfacePin& pin, std::string text) {
  Document next = editor.document();
  Note note;
  note.part = pin.part;
  note.label = next_label(next, pin.side);
  note.text = std::move(text);
  note.at_mm = pin.at_mm;
  note.normal = pin.normal;
  note.camera = next.now;
  note.created = editor.place().today();
  next.notes.push_back(std::move(note));
  give_ids(next);
  editor.change(std::move(next), "note");
  editor.desk().note = editor.document().notes.size();
  editor.desk().drawer = "notes";
}

void add_note(Editor& editor, const std::vector<SurfacePin>& pins, std::string text) {
  if (pins.size() > 1) return add_text_line(editor, pins, std::move(text));
  add_pin(editor, pins.front(), std::move(text));
}

Result<std::vector<SurfacePin>> pins_of(Editor& editor, const std::vector<glm::dvec3>& points) {
  std::vector<SurfacePin> out;
  for (const glm::dvec3& point : points) {
    DUBSAR_ASSIGN(SurfacePin pin, editor.place().pin(point));
    out.push_back(std::move(pin));
  }
  return out;
}

Command tool() {
  Command out{"tool", std::string(kMeasures), "what a click does", {}, "a tool"};
  out.values.assign(kTools.begin(), kTools.end());
  out.keys = {{"v", "turn"},    {"d", "distance"}, {"a", "angle"}, {"w", "depth"},
              {"f", "profile"}, {"n", "note"},     {"i", "line"},  {"j", "slice"}};
  out.closed = true;
  out.run = [](Editor& editor, const std::string& name) -> Result<void> {
    Desk& desk = editor.desk();
    desk.tool = desk.tool == name ? "turn" : name;
    desk.pending.clear();
    constexpr std::array<const char*, 8> kWords{"",
                                                "Click two places: the distance between them.",
                                                "Click three places: the angle at the second.",
                                                "Click into a wedge: its depth below the surface around it.",
                                                "Click two places: the section between them.",
                                                "Click where the note belongs.",
                                                "Click the beginning and the end of a line of text.",
                                                "Click where the scan shall be cut."};
    const auto* const at = std::find(kTools.begin(), kTools.end(), desk.tool);
    if (const char* const words = kWords[static_cast<std::size_t>(at - kTools.begin())]; *words != '\0')
      editor.place().say(words);
    return {};
  };
  return out;
}

/// What a click with a tool says.
Command point() {
  Command out{"point", std::string(kMeasures), "a place for the tool", {}, "x,y,z in mm of the scan"};
  out.enabled = [](const Editor& editor) { return editor.desk().tool != "turn"; };
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    std::string rest;
    DUBSAR_ASSIGN(const auto points, points_argument("point", text, 1, rest));
    DUBSAR_ASSIGN(SurfacePin pin, editor.place().pin(points[0]));
    Desk& desk = editor.desk();
    if (desk.tool == "slice") {
      slice_through(editor, pin);
      return {};
    }
    desk.pending.push_back(std::move(pin));
    const auto kind = measure_kind(desk.tool);
    const std::size_t wanted = kind ? points_of(*kind) : desk.tool == "line" ? 2 : 1;
    if (desk.pending.size() < wanted) return {};
    const std::vector<SurfacePin> pins = std::exchange(desk.pending, {});
    if (kind) return add_measure(editor, *kind, pins, {});
    add_note(editor, pins, {});
    ++desk.pointing.notes;
    return {};
  };
  return out;
}

Command measure(MeasureKind kind, std::string words) {
  const std::string kind_name(measure_kind_name(kind));
  Command out{"measure_" + kind_name, std::string(kMeasures), std::move(words), {}};
  const std::size_t count = points_of(kind);
  out.argument = fmt::format("{} place{} x,y,z in mm of the scan, and a name", count, count == 1 ? "" : "s");
  out.run = [kind, count, what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    std::string name;
    DUBSAR_ASSIGN(const auto points, points_argument(what, text, count, name));
    DUBSAR_ASSIGN(const auto pins, pins_of(editor, points));
    return add_measure(editor, kind, pins, std::move(name));
  };
  return out;
}

/// Commands on one thing of a list, by its number.
template <class List>
Command on_list(std::string name, std::string_view group, std::string words, std::string argument, const List& list,
                std::function<void(Editor&, Document&, std::size_t, const std::string&)> change) {
  Command out{std::move(name), std::string(group), std::move(words), {}, std::move(argument)};
  out.enabled = [list](const Editor& editor) { return !(editor.document().*list).empty(); };
  out.run = [list, change = std::move(change), what = out.name, why = out.words](
                Editor& editor, const std::string& text) -> Result<void> {
    const auto [number, rest] = first_word(text);
    DUBSAR_ASSIGN(const std::size_t at, place_argument(what, number, (editor.document().*list).size()));
    Document next = editor.document();
    change(editor, next, at, rest);
    editor.change(std::move(next), why, Way::kGlide);
    return {};
  };
  return out;
}

Command note(std::string name, std::string words, std::size_t count) {
  Command out{std::move(name), std::string(kNotes), std::move(words), {}};
  out.argument = fmt::format("{} place{} x,y,z in mm of the scan, and its text", count, count == 1 ? "" : "s");
  out.run = [count, what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    std::string words_of_it;
    DUBSAR_ASSIGN(const auto points, points_argument(what, text, count, words_of_it));
    DUBSAR_ASSIGN(const auto pins, pins_of(editor, points));
    add_note(editor, pins, std::move(words_of_it));
    return {};
  };
  return out;
}

Command open_note() {
  Command out{"open_note", std::string(kNotes), "open a note, or close it", {}, "its number"};
  out.enabled = [](const Editor& editor) { return !editor.document().notes.empty(); };
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const std::size_t at, place_argument("open_note", text, editor.document().notes.size()));
    editor.desk().note = editor.desk().note == at + 1 ? 0 : at + 1;
    return {};
  };
  return out;
}

Command write(std::string name, std::string_view group, std::string words, std::string (*format)(const Document&)) {
  Command out{std::move(name), std::string(group), std::move(words), {}, "FILE.json"};
  out.run = [format](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_TRY(write_marks(path, format(editor.document())));
    editor.place().say("written: " + path);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> mark_commands() {
  std::vector<Command> out;
  out.push_back(tool());
  out.push_back(point());
  out.push_back(measure(MeasureKind::kDistance, "distance of two places, straight and along the surface"));
  out.push_back(measure(MeasureKind::kAngle, "angle at the second of three places"));
  out.push_back(measure(MeasureKind::kDepth, "depth of a wedge below the surface around it"));
  out.push_back(measure(MeasureKind::kProfile, "section between two places"));
  out.push_back(
      on_list("name_measure", kMeasures, "name a measure", "its number and a name", &Document::measures,
              [](Editor&, Document& next, std::size_t at, const std::string& name) { next.measures[at].name = name; }));
  out.push_back(on_list("delete_measure", kMeasures, "take a measure away", "its number", &Document::measures,
                        [](Editor&, Document& next, std::size_t at, const std::string&) {
                          next.measures.erase(next.measures.begin() + static_cast<std::ptrdiff_t>(at));
                        }));
  out.push_back(write("write_measures", kMeasures, "write the measures into a file (JSON)", format_measures));
  out.push_back(note("add_note", "a note on the surface", 1));
  out.push_back(note("add_line", "a text along a line of the surface", 2));
  out.push_back(open_note());
  out.push_back(on_list("note_text", kNotes, "what a note says", "its number and a text", &Document::notes,
                        [](Editor& editor, Document& next, std::size_t at, const std::string& text) {
                          next.notes[at].text = text;
                          warn_of_patch(editor, next.notes[at]);
                        }));
  out.push_back(
      on_list("note_label", kNotes, "the number of a note, as o. 5", "which one and its number", &Document::notes,
              [](Editor&, Document& next, std::size_t at, const std::string& text) { next.notes[at].label = text; }));
  out.push_back(
      on_list("go_to_note", kNotes, "look at a note as it was made", "its number", &Document::notes,
              [](Editor&, Document& next, std::size_t at, const std::string&) { next.now = next.notes[at].camera; }));
  out.back().steers = true;
  out.push_back(on_list("delete_note", kNotes, "take a note away", "its number", &Document::notes,
                        [](Editor& editor, Document& next, std::size_t at, const std::string&) {
                          next.notes.erase(next.notes.begin() + static_cast<std::ptrdiff_t>(at));
                          editor.desk().note = 0;
                        }));
  out.push_back(write("write_notes", kNotes, "write the notes into a file (JSON)", format_notes));
  out.push_back(
      write("write_annotations", kNotes, "write the notes into a file (W3C Web Annotations)", format_annotations));
  return out;
}

}  // namespace dubsar::app
