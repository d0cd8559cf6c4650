#include "app/panels/window_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/commands/pointing_tools.h"
#include "app/commands/sides.h"
#include "app/panels/palette.h"
#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

constexpr double kLongestBarPx = 150.0;
constexpr float kFaint = 0.33f;
constexpr float kBarRoom = 250.0f;  // for the figure of the slider and the scale bar
constexpr float kToolsWidth = 82.0f, kScrollBar = 10.0f;

void begin(const char* name, float x, float y, float width, float height) {
  ImGui::SetNextWindowPos(ImVec2(x, y));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::Begin(name, nullptr, kFixed);
}

void draw_line(const PanelContext& context) {
  begin("line", 0.0f, 0.0f, context.width, kTopLine);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(context.state.line.title.c_str());
  const FilesState& files = context.state.files;
  if (files.names.size() > 1) {
    ImGui::SameLine(0.0f, 12.0f);
    button(context, tr("files.position", files.shown + 1, files.names.size()), "next_file", false);
  }
  if (!context.state.line.side.empty()) {
    ImGui::SameLine(0.0f, 24.0f);
    ImGui::TextColored(ImColor(kDim), "%s", tr_name("side", context.state.line.side).c_str());
  }
  const std::string display = "F2  " + context.state.line.display;
  const float right = button_width(tr("top.open")) + button_width(tr("top.undo")) + button_width(tr("top.redo")) +
                      button_width(display) + button_width(context.state.line.language) + button_width("?");
  ImGui::SameLine(std::max(ImGui::GetCursorPosX() + 8.0f, context.width - right - 4.0f));
  button(context, tr("top.open"), "open", context.state.ui.choosing.open);
  ImGui::SameLine();
  button(context, tr("top.undo"), "undo", false, !context.state.line.undo.empty());
  ImGui::SameLine();
  button(context, tr("top.redo"), "redo", false, !context.state.line.redo.empty());
  ImGui::SameLine();
  button(context, display, "next_display", false);
  ImGui::SameLine();
  if (!context.state.line.language.empty()) {
    button(context, context.state.line.language, "ui_language", false);
    ImGui::SameLine();
  }
  button(context, "?", "help", false);
  ImGui::End();
}

void draw_scale_bar(const PanelContext& context) {
  if (context.state.mm_per_px <= 0.0) return;
  const double mm = scale_bar_mm(context.state.mm_per_px, kLongestBarPx);
  const auto length = static_cast<float>(mm / context.state.mm_per_px);
  const std::string label = local_figures(fmt::format("{:g} mm", mm));
  const float y = context.height - 0.5f * kStrip, right = context.width - 16.0f;
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  const float left = right - length;
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  draw->AddLine(ImVec2(left, y + 6), ImVec2(right, y + 6), color, 2.0f);
  for (const float x : {left, right}) draw->AddLine(ImVec2(x, y), ImVec2(x, y + 12), color, 2.0f);
  const ImVec2 size = ImGui::CalcTextSize(label.c_str());
  draw->AddText(ImVec2(0.5f * (left + right - size.x), y - size.y + 2), color, label.c_str());
}

void draw_strip(const PanelContext& context) {
  begin("strip", 0.0f, context.height - kStrip, context.width, kStrip);
  ImGui::SetCursorPosY(0.5f * (kStrip - ImGui::GetFrameHeight()));
  for (std::size_t i = 0; i < kSideNames.size(); ++i) {
    const std::string name(kSideNames[i]);
    button(context, tr_name("side", name), "side " + name, context.state.line.side == name);
    ImGui::SameLine(0.0f, i == 3 ? 20.0f : -1.0f);
  }
  if (can_unpack(context.state.document)) {
    auto percent = static_cast<float>(100.0 * context.state.document.unpack);
    ImGui::SameLine(0.0f, 28.0f);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(tr("strip.unpack").c_str());
    ImGui::SameLine();
    if (percent_slider("##unpack", percent,
                       std::clamp(context.width - ImGui::GetCursorPosX() - kBarRoom, 60.0f, 220.0f)))
      context.commands.push_back(fmt::format("unpack {:.4g}", percent));
    explain(context, "unpack_more");
  }
  draw_scale_bar(context);
  ImGui::End();
}

void draw_tools(const PanelContext& context) {
  std::vector<std::string> names{"turn"};
  for (const PointingTool& tool : pointing_tools()) names.emplace_back(tool.name);
  const float row = ImGui::GetFrameHeightWithSpacing();
  begin("tools", 0.0f, kTopLine + kGap, kToolsWidth,
        row * static_cast<float>(names.size()) + 2.0f * ImGui::GetStyle().WindowPadding.y);
  for (const std::string& name : names)
    row_button(context, tr_name("tool", name), "tool " + name, context.state.ui.tool == name);
  ImGui::End();
}

void draw_drawers(const PanelContext& context) {
  struct Row {
    const char* name;
    DrawerFrame frame;
    void (*draw)(const PanelContext&);
  };
  std::vector<Row> rows;
#define DUBSAR_DRAWN(name, key, frame) rows.push_back({#name, DrawerFrame::frame, draw_##name});
  DUBSAR_DRAWERS(DUBSAR_DRAWN)
#undef DUBSAR_DRAWN
  if (context.state.document.parts.size() < 2)
    std::erase_if(rows, [](const Row& row) { return row.frame == DrawerFrame::kOfParts; });
  const float row = ImGui::GetFrameHeightWithSpacing();
  begin("drawers", context.width - kTab, kTopLine + kGap, kTab,
        row * static_cast<float>(rows.size()) + 2.0f * ImGui::GetStyle().WindowPadding.y);
  for (const Row& each : rows)
    row_button(context, tr_name("panel", each.name), std::string("drawer ") + each.name,
               context.state.ui.drawer == each.name);
  ImGui::End();
  for (const Row& each : rows) {
    if (context.state.ui.drawer != each.name) continue;
    if (each.frame == DrawerFrame::kWide) {
      each.draw(context);
      continue;
    }
    // What the window has no room for is reached with the wheel, or the bar at its side.
    const float most = context.height - kTopLine - kStrip - 2.0f * kGap;
    ImGui::SetNextWindowPos(ImVec2(context.width - kTab - 4.0f, kTopLine + kGap), ImGuiCond_Always, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSizeConstraints(
        ImVec2(kDrawer, 0.0f), ImVec2(std::max(kDrawer + kScrollBar, context.width - kTab - kToolsWidth), most));
    ImGui::Begin(each.name, nullptr, (kFixed & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_AlwaysAutoResize);
    const ImVec2 corner = ImGui::GetCursorPos();
    ImGui::Dummy(ImVec2(kDrawer - 2.0f * ImGui::GetStyle().WindowPadding.x, 0.0f));
    ImGui::SetCursorPos(corner);
    each.draw(context);
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
  const PanelContext context{state, keys, commands, width, height};
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
  ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, kScrollBar);
  if (state.ui.panels) {
    draw_line(context);
    if (state.files.has_surface) {
      draw_tools(context);
      draw_strip(context);
      draw_drawers(context);
    }
  }
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0f);
  draw_open_dialogue(state.ui.choosing.open, state.files, width, height, commands);
  draw_opening(state.files, width, height, commands);
  draw_palette(state.ui.palette, keys, width, height, commands);
  ImGui::PopStyleVar();
  ImGui::PopStyleVar(6);
  ImGui::PopStyleColor(12);
}

}  // namespace dubsar::app
