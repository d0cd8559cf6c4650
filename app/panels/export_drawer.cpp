// The drawer that writes what is published: a plate, a hand copy, a figure, a film, a page, a model, a text.

#include <fmt/format.h>

#include "app/commands/export_words.h"
#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

constexpr float kFigurePx = 84.0f, kExportBarPx = 170.0f;

void draw_words_row(const PanelContext& context, Text heading, const char* family, const std::string& now,
                    std::initializer_list<const char*> words) {
  say_dim(tr(heading));
  bool first = true;
  for (const char* const word : words) {
    const std::string label = tr_name(family, word);
    if (!first) next_in_row(button_width(label));
    first = false;
    button(context, label,
           fmt::format("export_as {} {}", family == std::string_view("export_hand") ? "hand" : "ground", word),
           now == word);
  }
}

void draw_number(const PanelContext& context, const std::string& label, const char* what, double now, float least,
                 float most) {
  auto value = static_cast<float>(now);
  ImGui::SetNextItemWidth(kFigurePx);
  if (ImGui::DragFloat(label.c_str(), &value, 1.0f, least, most, "%.0f", ImGuiSliderFlags_AlwaysClamp))
    context.commands.push_back(fmt::format("export_as {} {:.0f}", what, value));
}

}  // namespace

void draw_export(const PanelContext& context) {
  const ExportChoice& choice = context.state.ui.choosing.publishing;
  draw_number(context, tr("export.width"), "width", choice.width_mm, 5.0f, 2000.0f);
  draw_number(context, tr("export.dpi"), "dpi", choice.dpi, 50.0f, 4800.0f);
  draw_words_row(context, "export.ground", "export_ground", choice.ground, {"white", "grey", "black", "none"});
  button(context, tr("export.scale_bar"), "export_as scale-bar", choice.scale_bar);
  next_in_row(button_width(tr("export.labels")));
  button(context, tr("export.labels"), "export_as labels", choice.labels);
  draw_words_row(context, "export.hand", "export_hand", choice.hand, {"outlined", "filled", "weighted"});
  ImGui::Separator();
  if (const auto& job = context.state.exporting) {
    say_dim(job->name);
    ImGui::ProgressBar(static_cast<float>(job->fraction), ImVec2(kExportBarPx, 0.0f));
    ImGui::SameLine();
    button(context, tr("export.stop"), "stop_export", false);
    return;
  }
  bool first = true;
  for (const ExportKind& kind : kExportKinds) {
    const std::string label = tr_name("export_kind", kind.name);
    if (!first) next_in_row(button_width(label));
    first = false;
    const bool can = kind.name != "film" || context.state.document.keyframes.size() > 1;
    button(context, label, fmt::format("export {}", kind.name), false, can);
  }
  say_dim(tr("export.beside"));
}

}  // namespace dubsar::app
