#include "app/panels/film_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

constexpr const char* kDragged = "keyframe";
constexpr float kWidest = 1.7f, kFilmBar = 10.0f;
constexpr float kShortestS = 0.05f, kLongestS = 3600.0f;

/// What a press of the mouse says, once it is let go; dragged, the keyframe goes where another one is.
void draw_picture(const PanelContext& context, std::size_t i) {
  const auto aspect = static_cast<float>(context.state.thumbnail_aspect);
  const float height = kFilmPicture, width = height * std::min(aspect, kWidest);
  const float left = 0.5f - 0.5f * std::min(1.0f, kWidest / aspect);  // wider ones are cut at both sides
  const std::uint32_t texture = i < context.state.thumbnails.size() ? context.state.thumbnails[i] : 0;
  const std::string go = fmt::format("go_to_keyframe {}", i + 1);
  const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + width, at.y + height);
  if (ImGui::InvisibleButton("picture", ImVec2(width, height))) context.commands.push_back(go);
  const bool over = ImGui::IsItemHovered();
  explain(context, go);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, end, IM_COL32(0x18, 0x18, 0x1a, 0xff));
  if (texture != 0) list.AddImage(texture_id(texture), at, end, ImVec2(left, 0.0f), ImVec2(1.0f - left, 1.0f));
  list.AddRect(at, end, over ? kAccent : kLine);
  if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoHoldToOpenOthers)) {
    ImGui::SetDragDropPayload(kDragged, &i, sizeof i);
    ImGui::TextUnformatted(tr("film.keyframe", i + 1).c_str());
    ImGui::EndDragDropSource();
  }
}

void take_dropped(const PanelContext& context, std::size_t i) {
  if (!ImGui::BeginDragDropTarget()) return;
  if (const ImGuiPayload* const payload = ImGui::AcceptDragDropPayload(kDragged)) {
    const std::size_t from = *static_cast<const std::size_t*>(payload->Data);
    if (from != i) context.commands.push_back(fmt::format("move_keyframe {} {}", from + 1, i + 1));
  }
  ImGui::EndDragDropTarget();
}

/// How long it takes to the next one.
void draw_duration(const PanelContext& context, std::size_t i) {
  const auto& keys = context.state.document.keyframes;
  if (i + 1 >= keys.size()) return say_dim(tr("film.end"));
  auto seconds = static_cast<float>(keys[i + 1].time_s - keys[i].time_s);
  ImGui::SetNextItemWidth(72.0f);
  if (ImGui::DragFloat(tr("film.to_next").c_str(), &seconds, 0.05f, kShortestS, kLongestS, "%.2f s",
                       ImGuiSliderFlags_AlwaysClamp))
    context.commands.push_back(fmt::format("keyframe_seconds {} {:.4g}", i + 1, seconds));
  explain(context, "keyframe_seconds");
}

void draw_row(const PanelContext& context, std::size_t i) {
  const auto& keys = context.state.document.keyframes;
  ImGui::BeginGroup();
  draw_picture(context, i);
  ImGui::SameLine();
  ImGui::BeginGroup();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(4.0f, 1.0f));
  say_dim(local_figures(fmt::format("{}   {:.2f} s", i + 1, keys[i].time_s - keys.front().time_s)));
  draw_duration(context, i);
  const std::string number = std::to_string(i + 1);
  button(context, tr("film.play"), "play " + number, false, keys.size() > 1);
  ImGui::SameLine();
  button(context, tr("film.replace"), "replace_keyframe " + number, false);
  ImGui::SameLine();
  button(context, "x", "delete_keyframe " + number, false);
  ImGui::PopStyleVar();
  ImGui::EndGroup();
  ImGui::EndGroup();
  take_dropped(context, i);
}

}  // namespace

void draw_film(const PanelContext& context) {
  const auto& keys = context.state.document.keyframes;
  button(context, tr("film.add"), "keyframe", false);
  const std::string play = context.state.playing ? tr("film.stop") : tr("film.play");
  next_in_row(button_width(play));
  button(context, play, "play", context.state.playing, keys.size() > 1);
  if (keys.empty()) return say_dim(tr("film.none"));
  const auto rows = static_cast<float>(std::min<std::size_t>(keys.size(), kFilmRows));
  const float room = context.height - kTopLine - kStrip - 120.0f;
  const float words = std::max(72.0f + button_width(tr("film.to_next")),
                               button_width(tr("film.play")) + button_width(tr("film.replace")) + button_width("x"));
  const float width = std::max(ImGui::GetContentRegionAvail().x, kWidest * kFilmPicture + words + kFilmBar);
  ImGui::BeginChild("keyframes", ImVec2(width, std::min(rows * kFilmRow, room)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6.0f, kFilmRow - kFilmPicture));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    draw_row(context, i);
    ImGui::PopID();
  }
  ImGui::PopStyleVar();
  ImGui::EndChild();
  if (keys.size() > 1) say_dim(tr("film.hint"));
}

}  // namespace dubsar::app
