// The drawer for the wedges of an edition: looked for, counted by whose they are, and the chosen one corrected.

#include <fmt/format.h>

#include <algorithm>

#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

std::string figure(double mm) { return local_figures(fmt::format("{:.2f}", mm)); }

void draw_search(const PanelContext& context, bool any) {
  if (context.state.finding) {
    draw_job(context, *context.state.finding, "stop_wedges");
    return;
  }
  button(context, any ? tr("wedge.again") : tr("wedge.find"), "find_wedges", false);
  if (!any) return;
  next_in_row(button_width(tr("wedge.on_surface")));
  button(context, tr("wedge.on_surface"), "show_wedges", context.state.ui.pointing.wedges);
}

void draw_counts(const PanelContext& context) {
  std::size_t machine = 0, people = 0, deleted = 0;
  for (const MarkedWedge& marked : context.state.document.edition.wedges) {
    if (marked.deleted)
      ++deleted;
    else
      ++(marked.wedge.by == WedgeBy::kMachine ? machine : people);
  }
  std::string words = tr("wedge.by_machine", machine) + ", " + tr("wedge.by_people", people);
  if (deleted > 0) words += ", " + tr("wedge.deleted", deleted);
  say_dim(words);
}

void draw_chosen(const PanelContext& context, const ScriptWedge& wedge, std::size_t count) {
  const int number = wedge.order;
  ImGui::Separator();
  ImGui::Text("%d", number);
  ImGui::SameLine();
  say_dim(tr("wedge.place", tr_name("text_side", name_in(kTextSides, wedge.side)), wedge.line,
             tr_name("wedge_by", name_in(kWedgeBys, wedge.by))));
  say_dim(tr("wedge.figures", figure(wedge.depth_mm), figure(wedge.length_mm), figure(wedge.width_mm)));
  bool first = true;
  for (const auto& kind : kWedgeKinds) {
    const std::string label = tr_name("wedge_kind", kind.name);
    if (!first) next_in_row(button_width(label));
    first = false;
    button(context, label, fmt::format("wedge_kind {} {}", number, kind.name), wedge.kind == kind.value);
  }
  button(context, tr("wedge.earlier"), fmt::format("wedge_order {} {}", number, number - 1), false, number > 1);
  next_in_row(button_width(tr("wedge.later")));
  button(context, tr("wedge.later"), fmt::format("wedge_order {} {}", number, number + 1), false,
         static_cast<std::size_t>(number) < count);
  next_in_row(button_width(tr("wedge.line_up")));
  button(context, tr("wedge.line_up"), fmt::format("wedge_line {} {}", number, wedge.line - 1), false, wedge.line > 1);
  next_in_row(button_width(tr("wedge.line_down")));
  button(context, tr("wedge.line_down"), fmt::format("wedge_line {} {}", number, wedge.line + 1), false);
  button(context, tr("tool.wedge_move"), "tool wedge_move", context.state.ui.tool == "wedge_move");
  next_in_row(button_width(tr("wedge.delete")));
  button(context, tr("wedge.delete"), fmt::format("delete_wedge {}", number), false);
}

}  // namespace

void draw_wedges(const PanelContext& context) {
  const auto& all = context.state.document.edition.wedges;
  draw_search(context, !all.empty());
  if (all.empty()) return;
  draw_counts(context);
  button(context, tr("tool.wedge"), "tool wedge", context.state.ui.tool == "wedge");
  next_in_row(button_width(tr("tool.wedge_add")));
  button(context, tr("tool.wedge_add"), "tool wedge_add", context.state.ui.tool == "wedge_add");
  const std::vector<ScriptWedge> wedges = wedges_of(context.state.document);
  const std::size_t chosen = context.state.ui.pointing.wedge;
  if (chosen == 0 || chosen > wedges.size()) return say_dim(tr("wedge.hint_choose"));
  draw_chosen(context, wedges[chosen - 1], wedges.size());
}

}  // namespace dubsar::app
