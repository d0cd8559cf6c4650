#include "app/panels/desk_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/commands/sides.h"

namespace dubsar::app {
namespace {

// One accent and warm neutrals; text stands out 7:1 from the panels.
constexpr ImU32 kAccent = IM_COL32(0xd9, 0xa4, 0x41, 0xff), kDim = IM_COL32(0x9a, 0x96, 0x8e, 0xff),
                kText = IM_COL32(0xe8, 0xe4, 0xdc, 0xff), kLine = IM_COL32(0x3a, 0x3b, 0x3f, 0xff);
constexpr float kTop = 32.0f, kStrip = 48.0f, kTab = 74.0f, kDrawer = 236.0f, kGap = 8.0f, kBall = 110.0f;
constexpr float kFaint = 0.33f;
constexpr double kLowestDeg = 5.0, kHighestDeg = 85.0;
constexpr double kLongestBarPx = 150.0;
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;

struct Board {
  const PanelState& state;
  const KeyTable& keys;
  std::vector<std::string>& commands;
  float width, height;
};

/// What a thing does and which key does the same, while the pointer rests on
/// it.
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

bool button(const Board& desk, const char* label, const std::string& command, bool active, bool enabled = true) {
  ImGui::BeginDisabled(!enabled);
  if (active) ImGui::PushStyleColor(ImGuiCol_Text, kAccent);
  const bool pressed = ImGui::Button(label);
  if (active) ImGui::PopStyleColor();
  ImGui::EndDisabled();
  explain(desk, command);
  if (pressed) desk.commands.push_back(command);
  return pressed;
}

void begin(const char* name, float x, float y, float width, float height) {
  ImGui::SetNextWindowPos(ImVec2(x, y));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::Begin(name, nullptr, kFixed);
}

float button_width(const char* label) {
  return ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x + ImGui::GetStyle().ItemSpacing.x;
}

void draw_line(const Board& desk) {
  begin("line", 0.0f, 0.0f, desk.width, kTop);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(desk.state.title.c_str());
  if (!desk.state.side.empty()) {
    ImGui::SameLine(0.0f, 24.0f);
    ImGui::TextColored(ImColor(kDim), "%s", desk.state.side.c_str());
  }
  const std::string display = "F2  " + desk.state.display;
  const float right = button_width("undo") + button_width("redo") + button_width(display.c_str()) + button_width("?");
  ImGui::SameLine(std::max(ImGui::GetCursorPosX() + 8.0f, desk.width - right - 4.0f));
  button(desk, "undo", "undo", false, !desk.state.undo.empty());
  ImGui::SameLine();
  button(desk, "redo", "redo", false, !desk.state.redo.empty());
  ImGui::SameLine();
  button(desk, display.c_str(), "next_display", false);
  ImGui::SameLine();
  button(desk, "?", "help", false);
  ImGui::End();
}

void draw_scale_bar(const Board& desk) {
  if (desk.state.mm_per_px <= 0.0) return;
  const double mm = scale_bar_mm(desk.state.mm_per_px, kLongestBarPx);
  const auto length = static_cast<float>(mm / desk.state.mm_per_px);
  const std::string label = fmt::format("{:g} mm", mm);
  const float y = desk.height - 0.5f * kStrip, right = desk.width - 16.0f;
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  const float left = right - length;
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  draw->AddLine(ImVec2(left, y + 6), ImVec2(right, y + 6), color, 2.0f);
  for (const float x : {left, right}) draw->AddLine(ImVec2(x, y), ImVec2(x, y + 12), color, 2.0f);
  const ImVec2 size = ImGui::CalcTextSize(label.c_str());
  draw->AddText(ImVec2(0.5f * (left + right - size.x), y - size.y + 2), color, label.c_str());
}

void draw_strip(const Board& desk) {
  begin("strip", 0.0f, desk.height - kStrip, desk.width, kStrip);
  ImGui::SetCursorPosY(0.5f * (kStrip - ImGui::GetFrameHeight()));
  for (std::size_t i = 0; i < kSideNames.size(); ++i) {
    const std::string name(kSideNames[i]);
    button(desk, name.c_str(), "side " + name, desk.state.side == name);
    ImGui::SameLine(0.0f, i == 3 ? 20.0f : -1.0f);
  }
  if (desk.state.can_unpack) {
    auto percent = static_cast<float>(100.0 * desk.state.unpack);
    ImGui::SameLine(0.0f, 28.0f);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("unpack");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(std::clamp(desk.width - 900.0f, 90.0f, 220.0f));
    if (ImGui::SliderFloat("##unpack", &percent, 0.0f, 100.0f, "%.0f %%", ImGuiSliderFlags_AlwaysClamp))
      desk.commands.push_back(fmt::format("unpack {:.4g}", percent));
    explain(desk, "unpack_more");
  }
  draw_scale_bar(desk);
  ImGui::End();
}

void draw_parts(const Board& desk) {
  for (std::size_t i = 0; i < desk.state.parts.size(); ++i) {
    const Part& part = desk.state.parts[i];
    bool visible = part.visible;
    if (ImGui::Checkbox(part.name.c_str(), &visible)) desk.commands.push_back(fmt::format("part {}", i + 1));
    explain(desk, fmt::format("part {}", i + 1));
  }
  button(desk, "all parts", "all_parts", false);
}

/// A ball seen from the front: the light stands where it is touched, low at its
/// rim.
void draw_light(const Board& desk) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("ball", ImVec2(kBall, kBall));
  const ImVec2 middle(corner.x + 0.5f * kBall, corner.y + 0.5f * kBall);
  const float radius = 0.5f * kBall - 4.0f;
  constexpr double kRad = std::numbers::pi / 180.0;
  if (ImGui::IsItemActive()) {
    const ImVec2 at = ImGui::GetIO().MousePos;
    const double x = (at.x - middle.x) / radius, y = (middle.y - at.y) / radius;
    const double azimuth = std::fmod(std::atan2(x, y) / kRad + 360.0, 360.0);
    const double elevation = std::clamp(std::acos(std::min(1.0, std::hypot(x, y))) / kRad, kLowestDeg, kHighestDeg);
    if (std::abs(azimuth - desk.state.light.azimuth_deg) > 0.05 ||
        std::abs(elevation - desk.state.light.elevation_deg) > 0.05)
      desk.commands.push_back(fmt::format("light {:.1f},{:.1f}", azimuth, elevation));
  }
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  draw->AddCircleFilled(middle, radius, IM_COL32(0x2b, 0x2d, 0x31, 0xff), 48);
  draw->AddCircle(middle, radius, kLine, 48, 1.5f);
  const double low = std::cos(desk.state.light.elevation_deg * kRad), azimuth = desk.state.light.azimuth_deg * kRad;
  const ImVec2 light(middle.x + radius * static_cast<float>(low * std::sin(azimuth)),
                     middle.y - radius * static_cast<float>(low * std::cos(azimuth)));
  draw->AddLine(light, middle, kLine, 1.5f);
  draw->AddCircleFilled(light, 6.0f, kAccent, 24);
  ImGui::TextColored(ImColor(kDim), "%.0f° round, %.0f° high", desk.state.light.azimuth_deg,
                     desk.state.light.elevation_deg);
  constexpr std::array<std::array<const char*, 2>, 8> kPresets{{{"upper left", "upper_left"},
                                                                {"top", "top"},
                                                                {"upper right", "upper_right"},
                                                                {"left", "left"},
                                                                {"right", "right"},
                                                                {"lower left", "lower_left"},
                                                                {"bottom", "bottom"},
                                                                {"lower right", "lower_right"}}};
  for (std::size_t i = 0; i < kPresets.size(); ++i) {
    if (i != 0 && i != 3 && i != 5) ImGui::SameLine();
    button(desk, kPresets[i][0], std::string("light_from ") + kPresets[i][1], false);
  }
}

void draw_styles(const Board& desk) {
  if (const Command* const style = desk.keys.commands().find("style"))
    for (const std::string& name : style->values) {
      if (ImGui::RadioButton(name.c_str(), name == desk.state.style)) desk.commands.push_back("style " + name);
    }
  bool occlusion = desk.state.occlusion;
  if (ImGui::Checkbox("dark hollows", &occlusion)) desk.commands.push_back("occlusion");
  explain(desk, "occlusion");
}

void draw_drawers(const Board& desk) {
  struct Row {
    const char *label, *name;
    void (*draw)(const Board&);
  };
  std::vector<Row> rows;
  if (desk.state.parts.size() > 1) rows.push_back({"Parts", "parts", draw_parts});
  rows.push_back({"Light", "light", draw_light});
  rows.push_back({"Style", "style", draw_styles});
  const float row = ImGui::GetFrameHeightWithSpacing();
  begin("drawers", desk.width - kTab, kTop + kGap, kTab,
        row * static_cast<float>(rows.size()) + 2.0f * ImGui::GetStyle().WindowPadding.y);
  for (const Row& each : rows)
    button(desk, each.label, std::string("drawer ") + each.name, desk.state.drawer == each.name);
  ImGui::End();
  for (const Row& each : rows) {
    if (desk.state.drawer != each.name) continue;
    ImGui::SetNextWindowPos(ImVec2(desk.width - kTab - kDrawer - 4.0f, kTop + kGap));
    ImGui::SetNextWindowSize(ImVec2(kDrawer, 0.0f));
    ImGui::Begin(each.name, nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
    each.draw(desk);
    ImGui::End();
  }
}

}  // namespace

double scale_bar_mm(double mm_per_px, double most_px) {
  const double most = mm_per_px * most_px, decade = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= most * (1.0 + 1e-12)) return step * decade;
  return decade;
}

void draw_panels(const PanelState& state, const KeyTable& keys, float width, float height,
                 std::vector<std::string>& commands) {
  const Board desk{state, keys, commands, width, height};
  ImGui::PushStyleColor(ImGuiCol_Text, kText);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(0x1f, 0x21, 0x25, 0xeb));
  ImGui::PushStyleColor(ImGuiCol_PopupBg, IM_COL32(0x1f, 0x21, 0x25, 0xf5));
  ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(0x2b, 0x2d, 0x31, 0xff));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, IM_COL32(0x3a, 0x3b, 0x3f, 0xff));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, IM_COL32(0x4a, 0x46, 0x3c, 0xff));
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(0x2b, 0x2d, 0x31, 0xff));
  ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, IM_COL32(0x3a, 0x3b, 0x3f, 0xff));
  ImGui::PushStyleColor(ImGuiCol_FrameBgActive, IM_COL32(0x3a, 0x3b, 0x3f, 0xff));
  ImGui::PushStyleColor(ImGuiCol_CheckMark, kAccent);
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, kAccent);
  ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, kAccent);
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, state.faint ? kFaint : 1.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(8.0f, 4.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 3.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(16.0f, 16.0f));
  draw_line(desk);
  draw_strip(desk);
  draw_drawers(desk);
  ImGui::PopStyleVar(5);
  ImGui::PopStyleColor(12);
}

}  // namespace dubsar::app
