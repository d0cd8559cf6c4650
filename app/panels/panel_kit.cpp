#include "app/panels/panel_kit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace dubsar::app {

void explain(const Board& desk, const std::string& command) {
  if (!ImGui::IsItemHovered()) return;
  const auto [name, argument] = split_command(command);
  const Command* const known = desk.keys.commands().find(name);
  if (known == nullptr) return;
  std::string text = argument.empty() ? known->words : fmt::format("{}: {}", known->words, argument);
  const auto keys = desk.keys.keys_for(command);
  if (!keys.empty()) text += "    " + keys.front();
  ImGui::SetTooltip("%s", text.c_str());
}

namespace {

bool sized_button(const Board& desk, const char* label, const std::string& command, bool active, float width) {
  if (active) ImGui::PushStyleColor(ImGuiCol_Text, kAccent);
  const bool pressed = ImGui::Button(label, ImVec2(width, 0.0f));
  if (active) ImGui::PopStyleColor();
  explain(desk, command);
  if (pressed) desk.commands.push_back(command);
  return pressed;
}

/// Once it has the keys: behind its text, none of which is marked.
int go_behind(ImGuiInputTextCallbackData* field) {
  int& wanted = *static_cast<int*>(field->UserData);
  if (std::exchange(wanted, 0) != 0) field->CursorPos = field->SelectionStart = field->SelectionEnd = field->BufTextLen;
  return 0;
}

}  // namespace

bool button(const Board& desk, const char* label, const std::string& command, bool active, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = sized_button(desk, label, command, active, 0.0f);
  ImGui::EndDisabled();
  return pressed;
}

bool row_button(const Board& desk, const char* label, const std::string& command, bool active) {
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
  const bool pressed = sized_button(desk, label, command, active, ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleVar();
  return pressed;
}

float button_width(const char* label) {
  return ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x + ImGui::GetStyle().ItemSpacing.x;
}

bool percent_slider(const char* label, float& percent, float width, float most) {
  const std::string id = std::string("##slider") + label;
  ImGui::BeginGroup();
  ImGui::SetNextItemWidth(width);
  const bool moved = ImGui::SliderFloat(id.c_str(), &percent, 0.0f, most, "", ImGuiSliderFlags_AlwaysClamp);
  if (moved) percent = std::round(percent);
  const std::string_view words(label);
  const std::string text = fmt::format("{:.0f} %{}{}", percent, words.starts_with("##") ? "" : " ",
                                       words.starts_with("##") ? std::string_view() : words);
  ImGui::SameLine();
  ImGui::TextUnformatted(text.c_str());
  ImGui::EndGroup();  // what is said of it is said over all of it
  return moved;
}

void say_dim(const char* words) {
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(words);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

ImTextureID texture_id(std::uint32_t texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));  // NOLINT(performance-no-int-to-ptr)
}

bool type_in(const char* id, const std::string& now, std::string& typed, float width, bool goes_on) {
  std::array<char, 2048> text{};
  now.copy(text.data(), std::min(now.size(), text.size() - 1));
  ImGui::SetNextItemWidth(width);
  int& behind = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID(id));
  if (goes_on) {
    behind = 1;
    ImGui::SetKeyboardFocusHere();
  }
  if (!ImGui::InputText(id, text.data(), text.size(), ImGuiInputTextFlags_CallbackAlways, go_behind, &behind))
    return false;
  typed = text.data();
  return typed != now;
}

}  // namespace dubsar::app
