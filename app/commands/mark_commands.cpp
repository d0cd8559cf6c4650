// Commands for what is put on the surface: measures, notes, and the tools that place them by clicks.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/commands/pointing_tools.h"
#include "app/document/document_file.h"
#include "app/document/mark_file.h"
#include "core/edition/line_label.h"
#include "core/script/correction/wedge_edits.h"

namespace dubsar::app {
namespace {

constexpr Text kMeasures = "group.measures", kNotes = "group.notes";

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
  editor.ui().note = editor.document().notes.size();
  editor.ui().drawer = "notes";
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
  Command out{"tool", kMeasures, {}, "arg.tool"};
  out.values = {"turn"};
  out.keys = {{"v", "turn"}};
  for (const PointingTool& each : pointing_tools()) {
    out.values.emplace_back(each.name);
    out.keys.push_back({std::string(each.key), std::string(each.name)});
  }
  out.closed = true;
  out.run = [](Editor& editor, const std::string& name) -> Result<void> {
    UiState& ui = editor.ui();
    ui.tool = ui.tool == name ? "turn" : name;
    ui.pending.clear();
    const Text hint = Text::find("hint." + ui.tool);
    if (!hint.empty()) editor.place().say(tr(hint));
    return {};
  };
  return out;
}

/// What a click with a tool says.
Command point() {
  Command out{"point", kMeasures, {}, "arg.place"};
  out.enabled = [](const Editor& editor) { return editor.ui().tool != "turn"; };
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    std::string rest;
    DUBSAR_ASSIGN(const auto points, points_argument("point", text, 1, rest));
    DUBSAR_ASSIGN(SurfacePin pin, editor.place().pin(points[0]));
    UiState& ui = editor.ui();
    const PointingTool& now = *pointing_tool(ui.tool);
    ui.pending.push_back(std::move(pin));
    if (ui.pending.size() < now.places) return {};
    return now.use(editor, std::exchange(ui.pending, {}));
  };
  return out;
}

Command measure(MeasureKind kind) {
  const std::string kind_name(measure_kind_name(kind));
  Command out{"measure_" + kind_name, kMeasures, {}};
  const std::size_t count = points_of(kind);
  constexpr std::array<Text, 3> kPlaces{"arg.place_name", "arg.two_places_name", "arg.three_places_name"};
  out.argument = kPlaces[count - 1];
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
Command on_list(std::string name, Text group, Text argument, const List& list,
                std::function<void(Editor&, Document&, std::size_t, const std::string&)> change) {
  Command out{std::move(name), group, {}, argument};
  out.enabled = [list](const Editor& editor) { return !(editor.document().*list).empty(); };
  out.run = [list, change = std::move(change), what = out.name](Editor& editor,
                                                                const std::string& text) -> Result<void> {
    const auto [number, rest] = first_word(text);
    DUBSAR_ASSIGN(const std::size_t at, place_argument(what, number, (editor.document().*list).size()));
    Document next = editor.document();
    change(editor, next, at, rest);
    editor.change(std::move(next), what, Transition::kGlide);
    return {};
  };
  return out;
}

Command note(std::string name, std::size_t count) {
  Command out{std::move(name), kNotes, {}};
  out.argument = count == 1 ? Text("arg.place_text") : Text("arg.two_places_text");
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
  Command out{"open_note", kNotes, {}, "arg.number"};
  out.enabled = [](const Editor& editor) { return !editor.document().notes.empty(); };
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const std::size_t at, place_argument("open_note", text, editor.document().notes.size()));
    editor.ui().note = editor.ui().note == at + 1 ? 0 : at + 1;
    return {};
  };
  return out;
}

Command write(std::string name, Text group, std::string (*format)(const Document&)) {
  Command out{std::move(name), group, {}, "arg.json"};
  out.run = [format](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_TRY(write_marks(path, format(editor.document())));
    editor.place().say(tr("say.written", path));
    return {};
  };
  return out;
}

}  // namespace

Result<void> use_distance(Editor& editor, const std::vector<SurfacePin>& pins) {
  return add_measure(editor, MeasureKind::kDistance, pins, {});
}
Result<void> use_angle(Editor& editor, const std::vector<SurfacePin>& pins) {
  return add_measure(editor, MeasureKind::kAngle, pins, {});
}
/// Of the wedge that is clicked on, at its deepest place; where the wedges of the part are known, what is beside them
/// is level.
Result<void> use_depth(Editor& editor, const std::vector<SurfacePin>& pins) {
  const auto& all = editor.document().edition.wedges;
  const bool known = std::any_of(all.begin(), all.end(), [&](const MarkedWedge& marked) {
    return !marked.deleted && marked.part == pins[0].part;
  });
  if (!known) return add_measure(editor, MeasureKind::kDepth, pins, {});
  const std::vector<ScriptWedge> wedges = wedges_of(editor.document());
  const auto at = wedge_at(wedges, pins[0].at_mm);
  if (!at) {
    editor.place().say(tr("wedge.level"));
    return {};
  }
  std::vector<SurfacePin> deepest = pins;
  deepest[0].at_mm = wedges[*at].tip_mm;
  editor.ui().pointing.wedge = *at + 1;
  return add_measure(editor, MeasureKind::kDepth, deepest, {});
}
Result<void> use_profile(Editor& editor, const std::vector<SurfacePin>& pins) {
  return add_measure(editor, MeasureKind::kProfile, pins, {});
}
Result<void> use_note(Editor& editor, const std::vector<SurfacePin>& pins) {
  add_note(editor, pins, {});
  ++editor.ui().pointing.notes;
  return {};
}
Result<void> use_line(Editor& editor, const std::vector<SurfacePin>& pins) { return use_note(editor, pins); }

std::vector<Command> mark_commands() {
  std::vector<Command> out;
  out.push_back(tool());
  out.push_back(point());
  out.push_back(measure(MeasureKind::kDistance));
  out.push_back(measure(MeasureKind::kAngle));
  out.push_back(measure(MeasureKind::kDepth));
  out.push_back(measure(MeasureKind::kProfile));
  out.push_back(
      on_list("name_measure", kMeasures, "arg.number_name", &Document::measures,
              [](Editor&, Document& next, std::size_t at, const std::string& name) { next.measures[at].name = name; }));
  out.push_back(on_list("delete_measure", kMeasures, "arg.number", &Document::measures,
                        [](Editor&, Document& next, std::size_t at, const std::string&) {
                          next.measures.erase(next.measures.begin() + static_cast<std::ptrdiff_t>(at));
                        }));
  out.push_back(write("write_measures", kMeasures, format_measures));
  out.push_back(note("add_note", 1));
  out.push_back(note("add_line", 2));
  out.push_back(open_note());
  out.push_back(on_list("note_text", kNotes, "arg.number_text", &Document::notes,
                        [](Editor& editor, Document& next, std::size_t at, const std::string& text) {
                          next.notes[at].text = text;
                          warn_of_patch(editor, next.notes[at]);
                        }));
  out.push_back(
      on_list("note_label", kNotes, "arg.number_label", &Document::notes,
              [](Editor&, Document& next, std::size_t at, const std::string& text) { next.notes[at].label = text; }));
  out.push_back(
      on_list("go_to_note", kNotes, "arg.number", &Document::notes,
              [](Editor&, Document& next, std::size_t at, const std::string&) { next.now = next.notes[at].camera; }));
  out.back().steers = true;
  out.push_back(on_list("delete_note", kNotes, "arg.number", &Document::notes,
                        [](Editor& editor, Document& next, std::size_t at, const std::string&) {
                          next.notes.erase(next.notes.begin() + static_cast<std::ptrdiff_t>(at));
                          editor.ui().note = 0;
                        }));
  out.push_back(write("write_notes", kNotes, format_notes));
  out.push_back(write("write_annotations", kNotes, format_annotations));
  return out;
}

}  // namespace dubsar::app
