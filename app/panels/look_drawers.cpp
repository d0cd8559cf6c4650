// The drawers for what is seen: parts, light, style and evidence.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/panels/panel_kit.h"
#include "app/stage/light_over.h"
#include "display/render/shading.h"

namespace dubsar::app {
namespace {

constexpr float kBall = 110.0f;

std::string style_words(const std::string& name) { return tr_name("style", name); }

/// Figures as people write them.
template <class... Values>
std::string figures(fmt::format_string<const Values&...> format, const Values&... values) {
  return local_figures(fmt::format(format, values...));
}

/// What the hatch means, and how much of the surface it is.
void draw_evidence(const PanelContext& context) {
  bool evidence = context.state.document.style.evidence;
  if (ImGui::Checkbox(tr("look.mark_inferred").c_str(), &evidence)) context.commands.push_back("evidence");
  explain(context, "evidence");
  const bool blue = context.state.document.style.hatch == "blue";
  const Hatch& hatch = blue ? kBlueHatch : kSepiaHatch;
  const auto color = [](const Rgb8& c) { return IM_COL32(c[0], c[1], c[2], 255); };
  if (evidence) {
    const std::string label = tr_name("hatch", "blue");
    next_in_row(button_width(label));
    button(context, label, blue ? "hatch sepia" : "hatch blue", blue);
  }
  const double all = context.state.evidence.measured_mm2 + context.state.evidence.inferred_mm2;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float size = ImGui::GetTextLineHeight();
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  const ImVec2 end(corner.x + 2.0f * size, corner.y + size);
  draw->AddRectFilled(corner, end, color(hatch.ground));
  for (float x = corner.x; x < end.x; x += 8.0f)
    draw->AddRectFilled(ImVec2(x, corner.y), ImVec2(std::min(x + 4.0f, end.x), end.y), color(hatch.stripe));
  ImGui::Dummy(ImVec2(2.0f * size + 4.0f, size));
  ImGui::SameLine();
  ImGui::TextUnformatted(figures("{:.1f} mm\u00b2, {:.1f} %", context.state.evidence.inferred_mm2,
                                 all > 0 ? 100.0 * context.state.evidence.inferred_mm2 / all : 0.0)
                             .c_str());
  say_dim(tr("look.inferred"));
  ImGui::Text("%.0f mm\u00b2", context.state.evidence.measured_mm2);
  ImGui::SameLine();
  ImGui::TextColored(ImColor(kDim), "%s", tr("look.measured").c_str());
}

/// A second style, and how much of it.
void draw_blend(const PanelContext& context) {
  const Command* const style = context.keys.commands().find("style");
  if (style == nullptr) return;
  const auto share = static_cast<float>(100.0 * context.state.document.style.share);
  const std::string other =
      context.state.document.style.other.empty() ? tr("look.nothing") : style_words(context.state.document.style.other);
  ImGui::SetNextItemWidth(combo_width(other));
  if (ImGui::BeginCombo(tr("look.mixed_with").c_str(), other.c_str())) {
    for (const std::string& name : style->values)
      if (ImGui::Selectable(style_words(name).c_str(), name == context.state.document.style.other))
        context.commands.push_back(fmt::format("blend {} {:.4g}", name, share > 0 ? share : 50.0f));
    ImGui::EndCombo();
  }
  explain(context, "blend");
  if (context.state.document.style.other.empty()) return;
  float percent = share;
  if (percent_slider(tr("look.of_it"), percent, 120.0f, 100.0f))
    context.commands.push_back(fmt::format("blend {} {:.4g}", context.state.document.style.other, percent));
  explain(context, "blend");
}

std::string colour_words(const std::string& name) { return tr_name("colours", name.empty() ? "designed" : name); }

/// Radiance scaling, and the colours of figures with their legend.
void draw_shades(const PanelContext& context) {
  auto percent = static_cast<float>(100.0 * context.state.document.style.radiance);
  if (percent_slider(tr("look.ridges"), percent, 120.0f, 200.0f))
    context.commands.push_back(fmt::format("radiance {:.4g}", percent));
  explain(context, "radiance");
  const Command* const colours = context.keys.commands().find("colours");
  ImGui::SetNextItemWidth(combo_width(colour_words(context.state.document.style.colours)));
  if (colours != nullptr &&
      ImGui::BeginCombo(tr("look.colours").c_str(), colour_words(context.state.document.style.colours).c_str())) {
    for (const std::string& name : colours->values)
      if (ImGui::Selectable(colour_words(name).c_str(), name == context.state.document.style.colours))
        context.commands.push_back("colours " + name);
    ImGui::EndCombo();
  }
  explain(context, "colours");
}

}  // namespace

void draw_parts(const PanelContext& context) {
  for (std::size_t i = 0; i < context.state.document.parts.size(); ++i) {
    const Part& part = context.state.document.parts[i];
    bool visible = part.visible;
    if (ImGui::Checkbox(tr_name("part", part.name).c_str(), &visible))
      context.commands.push_back(fmt::format("part {}", i + 1));
    explain(context, fmt::format("part {}", i + 1));
    auto percent = static_cast<float>(100.0 * part.opacity);
    ImGui::SameLine();
    const float left = std::max(ImGui::GetCursorPosX(), 144.0f), figure = ImGui::CalcTextSize(" 100 %").x;
    ImGui::SetCursorPosX(left);  // behind long names
    ImGui::PushID(static_cast<int>(i));
    if (percent_slider("##opacity", percent, std::max(kDrawer - left - figure - 2.0f * kGap, 24.0f)))
      context.commands.push_back(fmt::format("part_opacity {} {:.4g}", i + 1, percent));
    explain(context, "part_opacity");
    std::array<float, 3> colour{}, offset{};
    for (std::size_t c = 0; c < 3; ++c) {
      colour[c] = static_cast<float>(part.colour[c]) / 255.0f;
      offset[c] = static_cast<float>(part.offset_mm[static_cast<int>(c)]);
    }
    if (ImGui::ColorEdit3("##colour", colour.data(), ImGuiColorEditFlags_NoInputs))
      context.commands.push_back(fmt::format("part_colour {} {:02x}{:02x}{:02x}", i + 1, std::lround(255 * colour[0]),
                                             std::lround(255 * colour[1]), std::lround(255 * colour[2])));
    explain(context, "part_colour");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(196.0f);
    if (ImGui::DragFloat3("##offset", offset.data(), 0.2f, -500.0f, 500.0f, "%.1f mm"))
      context.commands.push_back(
          fmt::format("part_offset {} {:.4g},{:.4g},{:.4g}", i + 1, offset[0], offset[1], offset[2]));
    explain(context, "part_offset");
    ImGui::PopID();
  }
  button(context, tr("look.all_parts"), "all_parts", false);
}

/// A ball seen from the front: the light stands where it is touched, low at its
/// rim.
void draw_light(const PanelContext& context) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("ball", ImVec2(kBall, kBall));
  const ImVec2 middle(corner.x + 0.5f * kBall, corner.y + 0.5f * kBall);
  const float radius = 0.5f * kBall - 4.0f;
  if (ImGui::IsItemActive()) {
    const ImVec2 at = ImGui::GetIO().MousePos;
    const LightPlace asked = light_over((at.x - middle.x) / radius, (middle.y - at.y) / radius);
    if (std::abs(asked.azimuth_deg - context.state.document.light.azimuth_deg) > 0.05 ||
        std::abs(asked.elevation_deg - context.state.document.light.elevation_deg) > 0.05)
      context.commands.push_back(fmt::format("light {:.1f},{:.1f}", asked.azimuth_deg, asked.elevation_deg));
  }
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  draw->AddCircleFilled(middle, radius, IM_COL32(0x2b, 0x2d, 0x31, 0xff), 48);
  draw->AddCircle(middle, radius, kLine, 48, 1.5f);
  const glm::dvec3 stands = place_over(context.state.document.light);
  const ImVec2 light(middle.x + radius * static_cast<float>(stands.x),
                     middle.y - radius * static_cast<float>(stands.y));
  draw->AddLine(light, middle, kLine, 1.5f);
  draw->AddCircleFilled(light, 6.0f, kAccent, 24);
  say_dim(tr("light.place", fmt::format("{:.0f}", context.state.document.light.azimuth_deg),
             fmt::format("{:.0f}", context.state.document.light.elevation_deg)));
  constexpr std::array<const char*, 8> kPresets{"upper_left", "top",        "upper_right", "left",
                                                "right",      "lower_left", "bottom",      "lower_right"};
  for (std::size_t i = 0; i < kPresets.size(); ++i) {
    const std::string label = tr_name("direction", kPresets[i]);
    if (i != 0 && i != 3 && i != 5) next_in_row(button_width(label));
    button(context, label, std::string("light_from ") + kPresets[i], false);
  }
}

void draw_style(const PanelContext& context) {
  if (const Command* const style = context.keys.commands().find("style"))
    for (const std::string& name : style->values) {
      if (ImGui::RadioButton(style_words(name).c_str(), name == context.state.document.style.name))
        context.commands.push_back("style " + name);
      explain(context, "style " + name);
    }
  bool occlusion = context.state.document.style.occlusion;
  if (ImGui::Checkbox(tr("look.dark_hollows").c_str(), &occlusion)) context.commands.push_back("occlusion");
  explain(context, "occlusion");
  auto strength = static_cast<float>(100.0 * context.state.document.style.strength);
  if (percent_slider(tr("look.strength"), strength, 120.0f, 200.0f))
    context.commands.push_back(fmt::format("strength {:.4g}", strength));
  draw_shades(context);
  draw_blend(context);
  ImGui::Separator();
  draw_evidence(context);
}

}  // namespace dubsar::app
