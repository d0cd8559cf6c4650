#include "app/panels/legend_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/panels/panel_kit.h"
#include "display/render/images/legend_image.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {

constexpr float kBarEm = 15.0f, kTall = 12.0f, kPad = 10.0f;
constexpr float kWholeLegendAbove = 900.0f;  // pixels of height from which on letters are of full size
constexpr float kSmallestLegend = 0.6f;      // of it

}  // namespace

std::optional<LegendPicture> legend_of(const Style& style, const SurfaceDifference* difference) {
  if (!is_field(style.map)) return std::nullopt;
  const FieldScale scale = field_scale(style);
  LegendPicture out{tr_name("legend", scale.name), std::string(scale.unit), scale.from, scale.to, field_colors(style)};
  if (difference != nullptr) {
    const auto mm = [](double value) { return local_figures(fmt::format("{:.3f}", value)); };
    out.figures = tr("legend.apart", mm(difference->median_mm), mm(difference->most_mm));
  }
  return out;
}

void draw_legend(const LegendPicture& legend, float left, float bottom) {
  const float scale = std::clamp(bottom / kWholeLegendAbove, kSmallestLegend, 1.0f), em = scale * ImGui::GetFontSize(),
              line = scale * ImGui::GetTextLineHeight(), bar = kBarEm * em, aside = 1.5f * em,
              words = legend.figures.empty() ? 0.0f : scale * ImGui::CalcTextSize(legend.figures.c_str()).x + aside,
              width = std::max(bar + 2 * aside, words) + 2 * kPad,
              height = (legend.figures.empty() ? 2 : 3) * line + kTall + 2 * kPad + 6.0f;
  ImGui::SetNextWindowPos(ImVec2(left, bottom - height));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::Begin("legend", nullptr, kFixed | ImGuiWindowFlags_NoInputs);
  ImGui::SetWindowFontScale(scale);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string title = legend.unit.empty() ? legend.name : fmt::format("{}, {}", legend.name, legend.unit);
  const ImVec2 corner(left + kPad + aside, bottom - height + kPad);
  list.AddText(corner, kText, title.c_str());
  const float top = corner.y + line + 2.0f;
  const float step = bar / static_cast<float>(legend.colors.size());
  for (std::size_t i = 0; i < legend.colors.size(); ++i) {
    const auto& c = legend.colors[i];
    const float x = corner.x + step * static_cast<float>(i);
    list.AddRectFilled(ImVec2(x, top), ImVec2(x + step + 0.5f, top + kTall), IM_COL32(c[0], c[1], c[2], 255));
  }
  for (int tick = 0; tick < kLegendTicks; ++tick) {
    const double part = tick / (kLegendTicks - 1.0);
    const std::string number = local_figures(legend_number(legend.from + part * (legend.to - legend.from)));
    const float x = corner.x + static_cast<float>(part) * bar;
    list.AddLine(ImVec2(x, top + kTall), ImVec2(x, top + kTall + 4.0f), kText);
    list.AddText(ImVec2(x - 0.5f * ImGui::CalcTextSize(number.c_str()).x, top + kTall + 4.0f), kText, number.c_str());
  }
  if (!legend.figures.empty()) list.AddText(ImVec2(corner.x, top + kTall + 4.0f + line), kText, legend.figures.c_str());
  ImGui::End();
}

}  // namespace dubsar::app
