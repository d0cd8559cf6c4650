// The drawers for what is made of a surface: measures, notes, cuts, film.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "app/document/text_lines.h"
#include "app/panels/panel_kit.h"
#include "app/stage/marks.h"
#include "core/edition/brackets.h"
#include "core/edition/line_label.h"
#include "core/edition/typed_letters.h"

namespace dubsar::app {
namespace {

constexpr float kFieldPx = 236.0f;

/// A profile as a curve: along its chord, and how far below it.
void draw_curve(const Measure& measure) {
  const auto& path = measure.figures.path_mm;
  if (path.size() < 3) return;
  const glm::dvec3 chord = path.back() - path.front();
  const double length = glm::length(chord);
  if (length == 0) return;
  std::vector<float> below;
  for (const glm::dvec3& p : path) {
    const glm::dvec3 off = p - path.front();
    below.push_back(-static_cast<float>(glm::length(off - chord * (glm::dot(off, chord) / (length * length)))));
  }
  ImGui::PlotLines("##curve", below.data(), static_cast<int>(below.size()), 0, nullptr,
                   -1.05f * static_cast<float>(std::max(measure.figures.depth_mm, 1e-3)), 0.05f,
                   ImVec2(kFieldPx, 60.0f));
}

/// Letters of transliterations for keyboards that do not have them, for the place `at` of the text. Returns the place
/// behind the one that was pressed.
std::optional<std::size_t> letter_buttons(const PanelContext& context, const std::string& command, std::string text,
                                          std::size_t at) {
  std::optional<std::size_t> behind;
  constexpr std::array<const char*, 9> kLetters{"\u0161", "\u1e63", "\u1e6d", "\u1e2b", "\u02be",
                                                "\u02bf", "\u2082", "\u2083", "\u2093"};
  for (std::size_t i = 0; i < kLetters.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, 2.0f);
    if (!ImGui::SmallButton(kLetters[i])) continue;
    context.commands.push_back(command + text.insert(at, kLetters[i]));
    behind = at + std::string_view(kLetters[i]).size();
  }
  return behind;
}

/// Enter makes the next line; what is wrong with brackets; the translation. Below the text field.
void draw_line_below(const PanelContext& context, std::size_t at) {
  const Note& note = context.state.document.notes[at];
  if (ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)))
    context.commands.push_back(fmt::format("next_line {}", at + 1));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("note.letters").c_str());
  const std::vector<BracketFault> faults = bracket_faults(note.text);
  for (const BracketFault& fault : faults)
    ImGui::TextColored(ImColor(kAccent), "%s",
                       (fault.kind == BracketFault::Kind::kNotClosed   ? tr("bracket.not_closed", fault.bracket)
                        : fault.kind == BracketFault::Kind::kNotOpened ? tr("bracket.not_opened", fault.bracket)
                                                                       : tr("bracket.nested", fault.bracket))
                           .c_str());
  if (!faults.empty())
    button(context, tr("note.close_brackets"), fmt::format("note_text {} {}", at + 1, with_brackets_closed(note.text)),
           false);
  std::string typed;
  if (type_in("##translation", note.translation, typed, kFieldPx))
    context.commands.push_back(fmt::format("line_translation {} {}", at + 1, typed));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("note.translation").c_str());
  button(context, tr("note.next_line"), fmt::format("next_line {}", at + 1), false);
  next_in_row(button_width(tr("note.line_above")));
  button(context, tr("note.line_above"), fmt::format("insert_line {}", at + 1), false);
}

/// Lines of a transliteration that was read in and are not on the clay yet.
void draw_waiting(const PanelContext& context) {
  if (context.state.document.edition.atf.empty()) return;
  const std::vector<TextPassage> waiting = waiting_lines(context.state.document);
  if (waiting.empty()) return;
  say_dim(tr("note.waiting", waiting.size()));
  constexpr std::size_t kShown = 12;
  for (std::size_t k = 0; k < std::min(waiting.size(), kShown); ++k)
    say_dim(fmt::format("{}  {}", line_label(waiting[k].spot), waiting[k].text));
}

}  // namespace

void draw_measures(const PanelContext& context) {
  if (context.state.document.measures.empty()) say_dim(tr("measure.none"));
  for (std::size_t i = 0; i < context.state.document.measures.size(); ++i) {
    const Measure& measure = context.state.document.measures[i];
    ImGui::PushID(static_cast<int>(i));
    std::string name;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(ImColor(kDim), "%zu", i + 1);
    ImGui::SameLine(28.0f);
    if (type_in("##name", measure.name, name, 150.0f))
      context.commands.push_back(fmt::format("name_measure {} {}", i + 1, name));
    ImGui::SameLine();
    button(context, "x", fmt::format("delete_measure {}", i + 1), false);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(figures_text(measure).c_str());
    ImGui::PopTextWrapPos();
    if (measure.kind == MeasureKind::kProfile) draw_curve(measure);
    ImGui::PopID();
  }
}

void draw_notes(const PanelContext& context) {
  if (context.state.document.notes.empty()) say_dim(tr("note.none"));
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const ImGuiID answered = ImGui::GetID("answered"), lettered = ImGui::GetID("lettered"),
                length = ImGui::GetID("length");
  for (std::size_t i = 0; i < context.state.document.notes.size(); ++i) {
    const Note& note = context.state.document.notes[i];
    const bool open = context.state.ui.note == i + 1;
    ImGui::PushID(static_cast<int>(i));
    const std::string title = fmt::format("{}  {}", note.label.empty() ? std::to_string(i + 1) : note.label,
                                          open ? std::string() : note.text.substr(0, note.text.find('\n')));
    button(context, title, fmt::format("open_note {}", i + 1), open);
    if (open) {
      std::string typed;
      if (type_in("##label", note.label, typed, 90.0f))
        context.commands.push_back(fmt::format("note_label {} {}", i + 1, typed));
      next_in_row(button_width(tr("note.look")));
      button(context, tr("note.look"), fmt::format("go_to_note {}", i + 1), false);
      next_in_row(button_width(tr("note.delete")));
      button(context, tr("note.delete"), fmt::format("delete_note {}", i + 1), false);
      const int placed = static_cast<int>(context.state.ui.pointing.notes);
      // What is typed after the click that placed a note, or after a letter was pressed, is its text.
      const bool fresh = kept.GetInt(answered) != placed;
      const int behind = kept.GetInt(lettered);  // a letter, once it stands there
      const bool goes_on = behind > 0 && kept.GetInt(length) == static_cast<int>(note.text.size());
      std::optional<std::size_t> from;
      if (fresh) from = note.text.size();
      if (goes_on) from = static_cast<std::size_t>(behind);
      if (from) kept.SetInt(lettered, 0);
      kept.SetInt(answered, placed);
      if (type_in("##text", note.text, typed, kFieldPx, from, is_text_line(note) ? typed_letters : nullptr))
        context.commands.push_back(fmt::format("note_text {} {}", i + 1, typed));
      if (is_text_line(note)) draw_line_below(context, i);
      if (fresh) ImGui::SetScrollHereY();
      const std::size_t at = from.value_or(caret_in("##text", note.text));
      if (const auto with = letter_buttons(context, fmt::format("note_text {} ", i + 1), note.text, at)) {
        kept.SetInt(lettered, static_cast<int>(*with));
        kept.SetInt(length, static_cast<int>(note.text.size() + *with - at));
      }
    }
    ImGui::PopID();
  }
  draw_waiting(context);
}

void draw_cuts(const PanelContext& context) {
  button(context, tr("cut.box"), "cut_handles", context.state.ui.pointing.cut_box);
  button(context, tr("cut.across"), "cut_here", false);
  const bool any = !context.state.document.clips.empty();
  button(context, tr("cut.deeper"), "cut_deeper", false, any);
  next_in_row(button_width(tr("cut.less_deep")));
  button(context, tr("cut.less_deep"), "cut_back", false, any);
  next_in_row(button_width(tr("cut.none")));
  button(context, tr("cut.none"), "no_cuts", false, any);
  for (const std::string side : {"front", "back", "left", "right", "top", "bottom"}) {
    const std::string label = tr_name("box_side", side);
    if (side != "front" && side != "left" && side != "top") next_in_row(button_width(label));
    button(context, label, fmt::format("cut {} 20", side), false);
  }
  auto percent = static_cast<float>(100.0 * context.state.document.fog);
  if (percent_slider(tr("cut.fog"), percent, 120.0f)) context.commands.push_back(fmt::format("fog {:.4g}", percent));
  explain(context, "fog");
}

}  // namespace dubsar::app
