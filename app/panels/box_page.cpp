#include "app/panels/box_page.h"

#include <imgui.h>

#include <glm/geometric.hpp>

#include "app/panels/panel_kit.h"

namespace dubsar::app {
namespace {

constexpr ImU32 kEdge = IM_COL32(0xd9, 0xa4, 0x41, 0xc0), kHidden = IM_COL32(0xd9, 0xa4, 0x41, 0x48),
                kBorder = IM_COL32(0x17, 0x18, 0x1b, 0xff);
constexpr float kArrowPx = 20.0f, kArrowHeadPx = 5.0f;

}  // namespace

void draw_box(const BoxPicture& box, float width, float height) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto place = [&](const glm::dvec2& at) {
    return ImVec2(0.5f * width + static_cast<float>(at.x) * height, (0.5f - static_cast<float>(at.y)) * height);
  };
  for (const BoxEdge& edge : box.edges)
    list.AddLine(place(edge.from), place(edge.to), edge.before ? kEdge : kHidden, edge.before ? 1.5f : 1.0f);
  for (const bool before : {false, true})  // the nearer ones over the others
    for (const BoxHandle& handle : box.handles) {
      if (handle.before != before) continue;
      const ImVec2 at = place(handle.at);
      const float radius = handle.touched ? 1.4f * kHandlePx : kHandlePx;
      const double length = glm::length(handle.towards);
      if (length > 1e-4) {
        const glm::vec2 out(handle.towards.x / length, -handle.towards.y / length), across(-out.y, out.x);
        const float reach = radius + (handle.touched ? kArrowPx : 0.6f * kArrowPx);
        const glm::vec2 tip = glm::vec2(at.x, at.y) + reach * out, foot = tip - kArrowHeadPx * out;
        list.AddLine(at, ImVec2(foot.x, foot.y), before ? kAccent : kHidden, 2.0f);
        const glm::vec2 a = foot + kArrowHeadPx * across, b = foot - kArrowHeadPx * across;
        list.AddTriangleFilled(ImVec2(tip.x, tip.y), ImVec2(a.x, a.y), ImVec2(b.x, b.y), before ? kAccent : kHidden);
      }
      list.AddCircleFilled(at, radius + 1.5f, kBorder, 24);
      if (before || handle.touched)
        list.AddCircleFilled(at, radius, handle.touched ? kText : kAccent, 24);
      else
        list.AddCircle(at, radius - 1.0f, kAccent, 24, 1.5f);
    }
  for (const BoxHandle& handle : box.handles) {
    if (!handle.touched) continue;
    const ImVec2 at = place(handle.at), size = ImGui::CalcTextSize(handle.words.c_str());
    ImVec2 corner(at.x + 2.0f * kHandlePx + kArrowPx, at.y - 0.5f * size.y);
    if (corner.x + size.x + 8.0f > width) corner.x = at.x - 2.0f * kHandlePx - kArrowPx - size.x;
    list.AddRectFilled(ImVec2(corner.x - 6.0f, corner.y - 3.0f),
                       ImVec2(corner.x + size.x + 6.0f, corner.y + size.y + 3.0f), IM_COL32(0x1f, 0x21, 0x25, 0xeb),
                       3.0f);
    list.AddText(corner, kText, handle.words.c_str());
  }
}

}  // namespace dubsar::app
