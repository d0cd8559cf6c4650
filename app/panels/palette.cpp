#include "app/panels/palette.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/panels/panel_kit.h"
#include "core/base/text/lower_text.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kRows = 12;
constexpr float kPaletteWidth = 560.0f;

/// What is typed, between frames.
struct Typed {
  std::array<char, 512> text{};
  std::size_t marked = 0;
  bool was_open = false;
  bool focus = false;  ///< the next frame's field takes the keys, its cursor at the end
  bool to_end = false;
  float width = kPaletteWidth;  ///< that the rows need
};
Typed& typed_now() {
  static Typed typed;
  return typed;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> out(1);
  for (const char c : lower_text(text)) {
    const bool splits = c == ' ' || c == '_' || c == ',' || c == ':';
    if (splits && !out.back().empty()) out.emplace_back();
    if (!splits) out.back() += c;
  }
  if (out.back().empty()) out.pop_back();
  return out;
}

bool fits(const std::vector<std::string>& typed, const std::vector<std::string>& there) {
  return std::all_of(typed.begin(), typed.end(), [&](const std::string& word) {
    return std::any_of(there.begin(), there.end(), [&](const std::string& other) { return other.starts_with(word); });
  });
}

int put_cursor(ImGuiInputTextCallbackData* data) {
  bool& to_end = *static_cast<bool*>(data->UserData);
  if (to_end) data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  to_end = false;
  return 0;
}

}  // namespace

std::vector<PaletteRow> palette_rows(const KeyTable& keys, std::string_view typed, std::size_t most) {
  const std::string wanted = lower_text(typed);
  const std::vector<std::string> words = words_of(typed);
  std::vector<PaletteRow> first, out;
  if (!typed.empty() && typed.find(' ') != std::string_view::npos && keys.commands().check(typed))
    first.push_back({std::string(typed), tr("palette.typed"), {}, true});
  const auto add = [&](const Command& command, const std::string& argument, bool ready) {
    PaletteRow row{argument.empty() ? command.name : command.name + " " + argument, tr(command.words), {}, ready};
    if (!argument.empty()) row.words += ": " + argument_words(command, argument);
    if (!ready) row.words += " (" + tr(command.argument) + ")";
    std::vector<std::string> there =
        words_of(fmt::format("{} {} {} {}", row.text, row.words, tr(command.group), command.words.english()));
    if (!fits(words, there) ||
        std::any_of(first.begin(), first.end(), [&](const auto& r) { return r.text == row.text; }))
      return;
    const auto bound = keys.keys_for(row.text);
    if (!bound.empty()) row.key = key_words(bound.front());
    (!wanted.empty() && row.text.starts_with(wanted) ? first : out).push_back(std::move(row));
  };
  std::vector<const Command*> commands;  // the window's own come last
  for (const Command& command : keys.commands().all())
    if (command.name != "palette") commands.push_back(&command);
  std::stable_partition(commands.begin(), commands.end(),
                        [](const Command* command) { return command->group != kWindowGroup; });
  for (const Command* const each : commands) {
    const Command& command = *each;
    if (command.argument.empty() || command.optional) add(command, {}, true);
    for (const std::string& value : command.values) add(command, value, true);
    if (!command.argument.empty() && !command.closed) add(command, {}, false);
  }
  first.insert(first.end(), out.begin(), out.end());
  if (first.size() > most) first.resize(most);
  return first;
}

void draw_palette(bool open, const KeyTable& keys, float width, float height, std::vector<std::string>& commands) {
  Typed& typed = typed_now();
  const bool fresh = open && !typed.was_open;
  typed.was_open = open;
  if (!open) return;
  if (fresh) typed = {{}, 0, true, true, false};
  ImGui::SetNextWindowPos(ImVec2(0.5f * width, kTopLine + kGap), ImGuiCond_Always, ImVec2(0.5f, 0.0f));
  ImGui::SetNextWindowSize(ImVec2(std::min(typed.width, width - 24.0f), 0.0f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(width, height - 2.0f * kTopLine));
  ImGui::Begin("palette", nullptr,
               (kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::SetNextItemWidth(-1.0f);
  if (std::exchange(typed.focus, false)) ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputTextWithHint(
      "##typed", tr("palette.field").c_str(), typed.text.data(), typed.text.size(),
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways, put_cursor, &typed.to_end);
  const std::vector<PaletteRow> rows = palette_rows(keys, typed.text.data(), kRows);
  float widest = kPaletteWidth;
  for (const PaletteRow& row : rows) widest = std::max(widest, button_width(row.words) + button_width(row.key) + 40.0f);
  typed.width = widest;
  if (ImGui::IsItemEdited()) typed.marked = 0;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow)) && typed.marked + 1 < rows.size()) ++typed.marked;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow)) && typed.marked > 0) --typed.marked;
  typed.marked = rows.empty() ? 0 : std::min(typed.marked, rows.size() - 1);
  const auto choose = [&](const PaletteRow& row) {
    if (row.ready) {
      commands.emplace_back("palette");
      commands.push_back(row.text);
    } else {  // what is missing is typed behind it
      typed.text = {};
      (row.text + " ").copy(typed.text.data(), typed.text.size() - 1);
      typed.focus = typed.to_end = true;
    }
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PaletteRow& row = rows[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable("##row", i == typed.marked)) choose(row);
    ImGui::SameLine(8.0f);
    ImGui::TextColored(ImColor(i == typed.marked ? kAccent : kText), "%s", row.words.c_str());
    if (!row.key.empty()) {
      ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(row.key.c_str()).x - 16.0f);
      ImGui::TextColored(ImColor(kDim), "%s", row.key.c_str());
    }
    ImGui::PopID();
  }
  if (rows.empty()) say_dim(tr("palette.none"));
  if (entered && !rows.empty()) choose(rows[typed.marked]);
  ImGui::End();
}

}  // namespace dubsar::app
