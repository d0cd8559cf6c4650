#pragma once
// What panels are made of: colours, sizes, buttons that say which key does the same. Part of this room.

#include <imgui.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/drawers.h"
#include "app/panels/window_panels.h"
#include "app/words/text.h"

namespace dubsar::app {

// One accent and warm neutrals; text stands out 7:1 from the panels.
inline constexpr ImU32 kAccent = IM_COL32(0xd9, 0xa4, 0x41, 0xff), kDim = IM_COL32(0x9a, 0x96, 0x8e, 0xff),
                       kText = IM_COL32(0xe8, 0xe4, 0xdc, 0xff), kLine = IM_COL32(0x3a, 0x3b, 0x3f, 0xff);
inline constexpr float kTopLine = 32.0f, kStrip = 48.0f, kTab = 90.0f, kDrawer = 264.0f, kGap = 8.0f;
inline constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                           ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;

struct PanelContext {
  const PanelState& state;
  const KeyTable& keys;
  std::vector<std::string>& commands;
  float width, height;
};

/// What a thing does and which key does the same, while the pointer rests on it.
void explain(const PanelContext& context, const std::string& command);
/// Posts the command when it is pressed.
bool button(const PanelContext& context, const std::string& label, const std::string& command, bool active,
            bool enabled = true);
/// The same in a column of them: as wide as the column, so that all of the line is pressed.
bool row_button(const PanelContext& context, const std::string& label, const std::string& command, bool active);
/// A button of text without a frame, as long as its words.
float button_width(const std::string& label);
/// Goes on in the same row where so wide a thing has room there, else in the next one.
void next_in_row(float width);
/// A slider from 0 to `most` per cent, its figure beside it, where the knob does not cover it, then its label (nothing
/// for one that begins with ##). True when it was moved: `percent` is whole then.
bool percent_slider(const std::string& label, float& percent, float width, float most = 100.0f);
/// Dim words that break where the panel ends.
void say_dim(const std::string& words);
/// As rough as rough_duration(), in the window's language.
std::string duration_words(double seconds);
/// Work beside the window: its name, how long it will still take, how far it is, and a button that posts `stop`.
void draw_job(const PanelContext& context, const JobState& job, const std::string& stop);
/// A line in letters so small that it ends within `room`, if it has to be.
void say_fitted(ImU32 color, const std::string& words, float room);
/// The width of a combo in which all of such words are seen, 120 at least.
float combo_width(const std::string& words);
/// What ImGui calls a texture of GL's.
ImTextureID texture_id(std::uint32_t texture);
/// A line of text that is kept while it is typed in, and told as it changes: true then. `id` names it in its window.
/// `goes_on`: it takes the keys from now on, behind so many bytes of what stands there. `letters`: what becomes of all
/// that stands there with each key; once more of that changes nothing.
bool type_in(const char* id, const std::string& now, std::string& typed, float width,
             std::optional<std::size_t> goes_on = std::nullopt, std::string (*letters)(std::string_view) = nullptr);
/// How many bytes of `text` stand before the place where was typed last in the field of that name; all, where never.
std::size_t caret_in(const char* id, const std::string& text);

// Drawers, one each.
#define DUBSAR_DRAW_DRAWER(name, key, frame) void draw_##name(const PanelContext& context);
DUBSAR_DRAWERS(DUBSAR_DRAW_DRAWER)
#undef DUBSAR_DRAW_DRAWER

}  // namespace dubsar::app
