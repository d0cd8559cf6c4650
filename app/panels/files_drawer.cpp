// The drawer for what stands beside a surface, and for work that was set aside.

#include <fmt/format.h>

#include <filesystem>

#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

void draw_companion(const PanelContext& context) {
  const Companion& companion = context.state.document.companion;
  if (companion.path.empty()) {
    say_dim(tr("files.no_companion"));
    button(context, tr("files.set_beside"), "set_beside", false);
    return;
  }
  ImGui::TextUnformatted(std::filesystem::path(companion.path).filename().string().c_str());
  button(context, tr("files.take_away"), "take_away", false);
  next_in_row(button_width(tr("legend.difference")));
  button(context, tr("legend.difference"), "difference", companion.difference_mm > 0);
  if (!(companion.difference_mm > 0)) return;
  for (const double mm : {0.1, 0.25, 1.0}) {
    const std::string number = fmt::format("{:g}", mm), label = local_figures(number + " mm");
    if (mm > 0.1) next_in_row(button_width(label));
    button(context, label, "difference " + number, companion.difference_mm == mm);
  }
}

void draw_other(const PanelContext& context, const OtherWorkRow& other, std::size_t number) {
  ImGui::PushID(static_cast<int>(number));
  ImGui::TextUnformatted((other.day.empty() ? other.name : other.day + "  " + other.name).c_str());
  say_dim(other.taken ? tr("files.taken", other.marks) : other.marks);
  const std::string which = fmt::format(" {}", number);
  button(context, tr("files.take_over"), "take_over" + which, false, !other.taken);
  if (other.day.empty()) return ImGui::PopID();
  next_in_row(button_width(tr("files.delete")));
  const bool asked = context.state.ui.choosing.deleting == number;
  button(context, asked ? tr("files.delete_asked") : tr("files.delete"), "delete_work" + which, asked);
  if (asked) {
    next_in_row(button_width(tr("files.keep")));
    button(context, tr("files.keep"), "delete_work none", false);
  }
  ImGui::PopID();
}

}  // namespace

void draw_files(const PanelContext& context) {
  ImGui::TextColored(ImColor(kAccent), "%s", tr("files.companion").c_str());
  draw_companion(context);
  ImGui::Separator();
  ImGui::TextColored(ImColor(kAccent), "%s", tr("files.aside").c_str());
  const auto& others = context.state.others;
  if (others.empty()) say_dim(tr("files.none_aside"));
  for (std::size_t i = 0; i < others.size(); ++i) draw_other(context, others[i], i + 1);
}

}  // namespace dubsar::app
