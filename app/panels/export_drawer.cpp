// The drawer that writes what is published: a plate, a hand copy, a figure, a film, a page, a model, a text.

#include <fmt/format.h>

#include "app/commands/export_words.h"
#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

constexpr float kFigurePx = 84.0f;

template <class Label>
std::vector<std::pair<std::string, std::string>> labelled(std::initializer_list<const char*> words,
                                                          const Label& label) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const char* const word : words) out.emplace_back(word, label(word));
  return out;
}

/// Words of which one is chosen: "export_as WHAT WORD".
void draw_words_row(const PanelContext& context, Text heading, const char* what, const std::string& now,
                    const std::vector<std::pair<std::string, std::string>>& words_and_labels) {
  say_dim(tr(heading));
  bool first = true;
  for (const auto& [word, label] : words_and_labels) {
    if (!first) next_in_row(button_width(label));
    first = false;
    button(context, label, fmt::format("export_as {} {}", what, word), now == word);
  }
}

void draw_number(const PanelContext& context, const std::string& label, const char* what, double now,
                 const PrintBounds& bounds) {
  auto value = static_cast<float>(now);
  ImGui::SetNextItemWidth(kFigurePx);
  if (ImGui::DragFloat(label.c_str(), &value, 1.0f, static_cast<float>(bounds.least), static_cast<float>(bounds.most),
                       "%.0f", ImGuiSliderFlags_AlwaysClamp))
    context.commands.push_back(fmt::format("export_as {} {:.0f}", what, value));
}

}  // namespace

void draw_export(const PanelContext& context) {
  const ExportChoice& choice = context.state.ui.choosing.publishing;
  draw_number(context, tr("export.width"), "width", choice.width_mm, kFigureMm);
  draw_number(context, tr("export.dpi"), "dpi", choice.dpi, kPlateDpi);
  draw_words_row(
      context, "export.ground", "ground", choice.ground,
      labelled({"white", "grey", "black", "none"}, [](const char* word) { return tr_name("export_ground", word); }));
  button(context, tr("export.scale_bar"), "export_as scale-bar", choice.scale_bar);
  next_in_row(button_width(tr("export.labels")));
  button(context, tr("export.labels"), "export_as labels", choice.labels);
  draw_words_row(
      context, "export.hand", "hand", choice.hand,
      labelled({"outlined", "filled", "weighted"}, [](const char* word) { return tr_name("export_hand", word); }));
  ImGui::Separator();
  if (context.state.exporting) {
    draw_job(context, *context.state.exporting, "stop_export");
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
