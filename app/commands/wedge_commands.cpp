// Commands for the wedges of an edition: found in the background, chosen, drawn, moved, deleted, named and ordered by
// people; and what comes of clicks with the tools for them.

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/base/files/kept_file.h"
#include "core/base/files/sealed_text.h"
#include "core/script/correction/wedge_edits.h"
#include "core/script/wedge_table.h"

namespace dubsar::app {
namespace {

constexpr Text kWedgeGroup = "group.wedges";

bool has_wedges(const Editor& editor) { return !places_of_wedges(editor.document()).empty(); }

/// The sides of the tablet as the session's home view shows it.
TextSides seen_sides(Editor& editor) {
  TabletFrame frame;
  frame.right = editor.place().reach({1, 0, 0}).direction;
  frame.up = editor.place().reach({0, 1, 0}).direction;
  frame.front = editor.place().reach({0, 0, 1}).direction;
  return TextSides(frame);
}

glm::dvec3 mean_normal(const std::vector<SurfacePin>& pins) {
  glm::dvec3 sum(0.0);
  for (const SurfacePin& pin : pins) sum += pin.normal;
  return glm::length(sum) > 1e-9 ? glm::normalize(sum) : pins.front().normal;
}

Result<std::vector<SurfacePin>> wedge_pins(Editor& editor, const std::vector<glm::dvec3>& places) {
  std::vector<SurfacePin> out;
  for (const glm::dvec3& place : places) {
    DUBSAR_ASSIGN(SurfacePin pin, editor.place().pin(place));
    out.push_back(std::move(pin));
  }
  return out;
}

/// The deepest place within a wedge that a person drew, where there is one.
void measure_depth_of(Editor& editor, ScriptWedge& wedge, const std::string& part) {
  const glm::dvec3 within = wedge.head_mm + 0.3 * (wedge.tail_mm - wedge.head_mm);
  const auto figures = editor.place().figures({MeasureKind::kDepth, {}, part, {within}, {}});
  if (!figures || figures->path_mm.size() < 2) return;
  const glm::dvec3 deepest = figures->path_mm.back();
  if (wedge_at({&wedge, 1}, deepest)) {
    wedge.tip_mm = deepest;
    wedge.depth_mm = figures->depth_mm;
  }
}

Result<void> draw_new(Editor& editor, const std::vector<SurfacePin>& pins) {
  const TextSides sides = seen_sides(editor);
  auto wedge = drawn_wedge({{pins[0].at_mm, pins[1].at_mm}, pins[2].at_mm, mean_normal(pins)}, sides);
  if (!wedge) return fail(ErrorKind::kUsage, "{}", tr("wedge.no_length"));
  measure_depth_of(editor, *wedge, pins[0].part);
  Document next = editor.document();
  const std::size_t number = insert_wedge(next, {*wedge, pins[0].part}, sides);
  give_ids(next);
  editor.change(std::move(next), "add_wedge");
  editor.ui().pointing.wedge = number;
  editor.place().say(wedge_words(wedges_of(editor.document())[number - 1]));
  return {};
}

Result<void> move_to(Editor& editor, std::size_t place, const std::vector<SurfacePin>& pins) {
  Document next = editor.document();
  MarkedWedge& marked = next.edition.wedges[place];
  const auto moved = moved_wedge(marked.wedge, pins[0].at_mm, pins[1].at_mm, mean_normal(pins), seen_sides(editor));
  if (!moved) return fail(ErrorKind::kUsage, "{}", tr("wedge.no_length"));
  marked.wedge = *moved;
  marked.part = pins[0].part;
  measure_depth_of(editor, marked.wedge, marked.part);
  number_wedges(next);
  editor.change(std::move(next), "move_wedge");
  return {};
}

/// Commands on one wedge, by its number: its place in the document, and what follows the number.
Command on_wedge(std::string name, Text argument,
                 std::function<Result<void>(Editor&, std::size_t, const std::string&)> run) {
  Command out{std::move(name), kWedgeGroup, {}, argument};
  out.enabled = has_wedges;
  out.run = [run = std::move(run), what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto [number, rest] = first_word(text);
    const std::vector<std::size_t> places = places_of_wedges(editor.document());
    DUBSAR_ASSIGN(const std::size_t at, place_argument(what, number, places.size()));
    return run(editor, places[at], rest);
  };
  return out;
}

/// One that changes the wedge and nothing else.
Command change_wedge(std::string name, Text argument,
                     std::function<Result<void>(Document&, std::size_t, const std::string&)> change) {
  const std::string why = name;
  return on_wedge(std::move(name), argument,
                  [change = std::move(change), why](Editor& editor, std::size_t place, const std::string& rest) {
                    Document next = editor.document();
                    if (auto done = change(next, place, rest); !done) return done;
                    number_wedges(next);
                    editor.change(std::move(next), why);
                    return Result<void>();
                  });
}

Command find() {
  Command out{"find_wedges", kWedgeGroup, {}, "arg.part_name"};
  out.optional = true;
  out.run = [](Editor& editor, const std::string& part) { return editor.place().find_wedges(part); };
  return out;
}

Command stop_finding() {
  Command out{"stop_wedges", kWedgeGroup, {}};
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    if (!editor.place().stop_wedges()) editor.place().say(tr("wedge.none_sought"));
    return {};
  };
  return out;
}

Command show() {
  Command out{"show_wedges", kWedgeGroup, {}};
  out.enabled = has_wedges;
  out.run = [](Editor& editor, const std::string&) -> Result<void> {
    editor.ui().pointing.wedges = !editor.ui().pointing.wedges;
    return {};
  };
  return out;
}

Command choose() {
  return on_wedge("wedge", "arg.number", [](Editor& editor, std::size_t place, const std::string&) -> Result<void> {
    const auto number = static_cast<std::size_t>(editor.document().edition.wedges[place].wedge.order);
    editor.ui().pointing.wedge = editor.ui().pointing.wedge == number ? 0 : number;
    return {};
  });
}

Command add() {
  Command out{"add_wedge", kWedgeGroup, {}, "arg.wedge_places"};
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    std::string rest;
    DUBSAR_ASSIGN(const auto places, points_argument("add_wedge", text, 3, rest));
    DUBSAR_ASSIGN(const auto pins, wedge_pins(editor, places));
    return draw_new(editor, pins);
  };
  return out;
}

Command move() {
  return on_wedge("move_wedge", "arg.number_two_places",
                  [](Editor& editor, std::size_t place, const std::string& text) -> Result<void> {
                    std::string rest;
                    DUBSAR_ASSIGN(const auto places, points_argument("move_wedge", text, 2, rest));
                    DUBSAR_ASSIGN(const auto pins, wedge_pins(editor, places));
                    return move_to(editor, place, pins);
                  });
}

Command remove() {
  return on_wedge("delete_wedge", "arg.number",
                  [](Editor& editor, std::size_t place, const std::string&) -> Result<void> {
                    Document next = editor.document();
                    // Found by the program it is remembered, so that it is not found again.
                    if (next.edition.wedges[place].wedge.by == WedgeBy::kPerson)
                      next.edition.wedges.erase(next.edition.wedges.begin() + static_cast<std::ptrdiff_t>(place));
                    else
                      next.edition.wedges[place].deleted = true;
                    number_wedges(next);
                    editor.change(std::move(next), "delete_wedge");
                    editor.ui().pointing.wedge = 0;
                    return {};
                  });
}

Command kind() {
  return change_wedge("wedge_kind", "arg.number_kind",
                      [](Document& next, std::size_t place, const std::string& name) -> Result<void> {
                        for (const auto& each : kWedgeKinds)
                          if (each.name == name) {
                            next.edition.wedges[place].wedge.kind = each.value;
                            correct(next.edition.wedges[place].wedge);
                            return {};
                          }
                        return fail(ErrorKind::kUsage,
                                    "wedge_kind: \"{}\" found, expected horizontal, vertical, oblique-down, "
                                    "oblique-up, winkelhaken or odd",
                                    name);
                      });
}

Command line() {
  return change_wedge("wedge_line", "arg.number_line",
                      [](Document& next, std::size_t place, const std::string& text) -> Result<void> {
                        DUBSAR_ASSIGN(const double number, number_argument("wedge_line", text, 0.0, 999.0));
                        next.edition.wedges[place].wedge.line = static_cast<int>(number);
                        correct(next.edition.wedges[place].wedge);
                        return {};
                      });
}

/// To another place of the order, into the line of the one that stood there.
Command order() {
  Command out = on_wedge("wedge_order", "arg.number_number",
                         [](Editor& editor, std::size_t place, const std::string& text) -> Result<void> {
                           Document next = editor.document();
                           const std::vector<std::size_t> places = places_of_wedges(next);
                           DUBSAR_ASSIGN(const std::size_t to, place_argument("wedge_order", text, places.size()));
                           MarkedWedge moved = next.edition.wedges[place];
                           moved.wedge.line = next.edition.wedges[places[to]].wedge.line;
                           correct(moved.wedge);
                           next.edition.wedges.erase(next.edition.wedges.begin() + static_cast<std::ptrdiff_t>(place));
                           next.edition.wedges.insert(
                               next.edition.wedges.begin() + static_cast<std::ptrdiff_t>(places[to]), std::move(moved));
                           number_wedges(next);
                           editor.change(std::move(next), "wedge_order");
                           editor.ui().pointing.wedge = to + 1;
                           return {};
                         });
  return out;
}

Command write() {
  Command out{"write_wedges", kWedgeGroup, {}, "arg.wedge_table"};
  out.enabled = has_wedges;
  out.run = [](Editor& editor, const std::string& path) -> Result<void> {
    const std::string suffix = lower_suffix(path);
    if (suffix != ".csv" && suffix != ".json")
      return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .csv or .json", path);
    KeptFile file{std::filesystem::path(path)};
    DUBSAR_ASSIGN(const std::optional<std::string> before, file.read());
    if (before && !before->empty() && !is_sealed_text(*before))
      return fail(ErrorKind::kUsage, "cannot write {}: something else is there; give another name", path);
    WedgesFound kept;
    kept.wedges = wedges_of(editor.document());
    DUBSAR_TRY(write_file_atomically(path, suffix == ".csv" ? wedges_csv(kept.wedges) : wedges_json(kept, "dubsar")));
    editor.place().say(tr("say.written", path));
    return {};
  };
  return out;
}

}  // namespace

std::string wedge_words(const ScriptWedge& wedge) {
  const std::string depth = fmt::format("{:.2f}", wedge.depth_mm);
  return tr("wedge.words", wedge.order, tr_name("wedge_kind", std::string(name_in(kWedgeKinds, wedge.kind))), depth,
            tr_name("text_side", std::string(name_in(kTextSides, wedge.side))), wedge.line,
            tr_name("wedge_by", std::string(name_in(kWedgeBys, wedge.by))));
}

/// The wedge that is clicked on, and its deepest place.
Result<void> use_wedge(Editor& editor, const std::vector<SurfacePin>& pins) {
  const std::vector<ScriptWedge> wedges = wedges_of(editor.document());
  if (wedges.empty()) {
    editor.place().say(tr("wedge.none_yet"));
    return {};
  }
  const auto at = wedge_at(wedges, pins[0].at_mm);
  editor.ui().pointing.wedge = at ? *at + 1 : 0;
  editor.place().say(at ? wedge_words(wedges[*at]) : tr("wedge.level"));
  return {};
}

Result<void> use_wedge_add(Editor& editor, const std::vector<SurfacePin>& pins) { return draw_new(editor, pins); }

Result<void> use_wedge_move(Editor& editor, const std::vector<SurfacePin>& pins) {
  const std::vector<std::size_t> places = places_of_wedges(editor.document());
  const std::size_t chosen = editor.ui().pointing.wedge;
  if (chosen == 0 || chosen > places.size()) {
    editor.place().say(tr("wedge.choose_first"));
    return {};
  }
  return move_to(editor, places[chosen - 1], pins);
}

std::vector<Command> wedge_commands() {
  std::vector<Command> out;
  out.push_back(find());
  out.push_back(stop_finding());
  out.push_back(show());
  out.push_back(choose());
  out.push_back(add());
  out.push_back(move());
  out.push_back(remove());
  out.push_back(kind());
  out.push_back(line());
  out.push_back(order());
  out.push_back(write());
  return out;
}

}  // namespace dubsar::app
