#include "app/panels/panel_kit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace dubsar::app {

void explain(const PanelContext& context, const std::string& command) {
  if (!ImGui::IsItemHovered()) return;
  const auto [name, argument] = split_command(command);
  const Command* const known = context.keys.commands().find(name);
  if (known == nullptr) return;
  std::string text = tr(known->words);
  if (!argument.empty()) text += ": " + argument_words(*known, argument);
  const auto keys = context.keys.keys_for(command);
  if (!keys.empty()) text += "    " + key_words(keys.front());
  ImGui::SetTooltip("%s", text.c_str());
}

namespace {

bool sized_button(const PanelContext& context, const std::string& label, const std::string& command, bool active,
                  float width) {
  if (active) ImGui::PushStyleColor(ImGuiCol_Text, kAccent);
  const bool pressed = ImGui::Button(label.c_str(), ImVec2(width, 0.0f));
  if (active) ImGui::PopStyleColor();
  explain(context, command);
  if (pressed) context.commands.push_back(command);
  return pressed;
}

/// Of a field, in the storage of its window, plus one; 0: none.
struct Caret {
  int* wanted;  ///< where it is to go, once the field has the keys; nothing is marked then
  int* last;    ///< where it was while the field had them
  std::string (*letters)(std::string_view) = nullptr;  ///< what becomes of what is typed
};
void change_letters(ImGuiInputTextCallbackData* field, std::string (*letters)(std::string_view)) {
  const std::string_view now(field->Buf, static_cast<std::size_t>(field->BufTextLen));
  const std::string text = letters(now);
  if (text == now) return;
  const std::string before = letters(now.substr(0, static_cast<std::size_t>(field->CursorPos)));
  field->DeleteChars(0, field->BufTextLen);
  field->InsertChars(0, text.c_str());
  field->CursorPos = field->SelectionStart = field->SelectionEnd =
      std::min(static_cast<int>(before.size()), field->BufTextLen);
}
int keep_caret(ImGuiInputTextCallbackData* field) {
  const Caret& caret = *static_cast<const Caret*>(field->UserData);
  if (caret.letters != nullptr) change_letters(field, caret.letters);
  if (const int wanted = std::exchange(*caret.wanted, 0); wanted != 0)
    field->CursorPos = field->SelectionStart = field->SelectionEnd = std::min(wanted - 1, field->BufTextLen);
  *caret.last = field->CursorPos + 1;
  return 0;
}
Caret caret_of(const char* id) {
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const ImGuiID wanted = ImGui::GetID(fmt::format("{}.wanted", id).c_str()),
                last = ImGui::GetID(fmt::format("{}.last", id).c_str());
  kept.GetIntRef(wanted);  // a new entry moves the others
  int* const at = kept.GetIntRef(last);
  return {kept.GetIntRef(wanted), at};
}

}  // namespace

bool button(const PanelContext& context, const std::string& label, const std::string& command, bool active,
            bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = sized_button(context, label, command, active, 0.0f);
  ImGui::EndDisabled();
  return pressed;
}

bool row_button(const PanelContext& context, const std::string& label, const std::string& command, bool active) {
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
  const float room = ImGui::GetContentRegionAvail().x;
  ImGui::SetWindowFontScale(std::min(1.0f, room / (button_width(label) - ImGui::GetStyle().ItemSpacing.x)));
  const bool pressed = sized_button(context, label, command, active, room);
  ImGui::SetWindowFontScale(1.0f);
  ImGui::PopStyleVar();
  return pressed;
}

float button_width(const std::string& label) {
  return ImGui::CalcTextSize(label.c_str()).x + 2.0f * ImGui::GetStyle().FramePadding.x +
         ImGui::GetStyle().ItemSpacing.x;
}

void next_in_row(float width) {
  ImGui::SameLine();
  if (ImGui::GetCursorPosX() + width > ImGui::GetWindowContentRegionMax().x + 1.0f) ImGui::NewLine();
}

bool percent_slider(const std::string& label, float& percent, float width, float most) {
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

void say_dim(const std::string& words) {
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string duration_words(double seconds) {
  const auto to = [](double value, long step) { return step * std::lround(value / static_cast<double>(step)); };
  if (seconds < 10) return tr("time.few");
  if (seconds < 50) return tr("time.seconds", to(seconds, 5));
  if (seconds < 3300) return tr("time.minutes", std::max(1L, to(seconds / 60, seconds < 570 ? 1 : 5)));
  return tr("time.hours", to(seconds / 60, 10) / 60, to(seconds / 60, 10) % 60);
}

void draw_job(const PanelContext& context, const JobState& job, const std::string& stop) {
  constexpr float kBarPx = 170.0f;
  say_dim(job.remaining_s ? job.name + ", " + tr("files.to_go", duration_words(*job.remaining_s)) : job.name);
  ImGui::ProgressBar(static_cast<float>(job.share), ImVec2(kBarPx, 0.0f));
  ImGui::SameLine();
  button(context, tr("job.stop"), stop, false);
}

void say_fitted(ImU32 color, const std::string& words, float room) {
  ImGui::SetWindowFontScale(std::min(1.0f, room / std::max(1.0f, ImGui::CalcTextSize(words.c_str()).x)));
  ImGui::TextColored(ImColor(color), "%s", words.c_str());
  ImGui::SetWindowFontScale(1.0f);
}

float combo_width(const std::string& words) {
  return std::max(
      120.0f, ImGui::CalcTextSize(words.c_str()).x + ImGui::GetFrameHeight() + 3.0f * ImGui::GetStyle().FramePadding.x);
}

ImTextureID texture_id(std::uint32_t texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));  // NOLINT(performance-no-int-to-ptr)
}

bool type_in(const char* id, const std::string& now, std::string& typed, float width,
             std::optional<std::size_t> goes_on, std::string (*letters)(std::string_view)) {
  std::array<char, 2048> text{};
  now.copy(text.data(), std::min(now.size(), text.size() - 1));
  ImGui::SetNextItemWidth(width);
  Caret caret = caret_of(id);
  caret.letters = letters;
  if (goes_on) {
    *caret.wanted = static_cast<int>(*goes_on) + 1;
    ImGui::SetKeyboardFocusHere();
  }
  if (!ImGui::InputText(id, text.data(), text.size(), ImGuiInputTextFlags_CallbackAlways, keep_caret, &caret))
    return false;
  typed = text.data();
  return typed != now;
}

std::size_t caret_in(const char* id, const std::string& text) {
  const int last = *caret_of(id).last;
  std::size_t at = last == 0 ? text.size() : std::min(static_cast<std::size_t>(last) - 1, text.size());
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0u) == 0x80u) ++at;  // amid a letter
  return at;
}

}  // namespace dubsar::app
