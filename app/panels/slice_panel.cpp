#include "app/panels/slice_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panel_kit.h"
#include "app/stage/ground_color.h"

namespace dubsar::app {
namespace {

constexpr float kBetween = 4.0f, kHead = 58.0f, kFoot = 22.0f;
constexpr ImU32 kSurface = IM_COL32(0xe8, 0xb4, 0x4c, 0xff), kPatch = IM_COL32(0x56, 0xb4, 0xff, 0xff),
                kNothing = IM_COL32(kGroundColor[0], kGroundColor[1], kGroundColor[2], 0xff),
                kCross = IM_COL32(0xe8, 0xe4, 0xdc, 0x70);
constexpr float kCrossGap = 7.0f, kOutline = 1.4f, kPatchOutline = 3.0f;
constexpr double kWheelMm = 0.1, kNearer = 1.25, kContrastPx = 200.0, kSamePx = 0.25;
constexpr double kBarPx = 80.0;

std::string place_text(const glm::dvec3& mm) { return fmt::format("{:.6f},{:.6f},{:.6f}", mm.x, mm.y, mm.z); }

/// What is still to be known of a picture that is not exact.
std::string slice_state(const SlicePane& pane) {
  if (!pane.picture || pane.picture->frame != pane.wanted || pane.picture->image.values.empty())
    return tr("slice.reading");
  if (pane.picture->done) return tr("slice.coarse");
  return tr("slice.share", fmt::format("{:.0f}", 100.0 * pane.picture->image.known));
}

/// From pixels of a picture to places of the layout.
struct Placed {
  ImVec2 corner;
  float scale;  ///< of the layout, for a pixel of the picture
  ImVec2 at(const glm::dvec2& px) const {
    return {corner.x + scale * static_cast<float>(px.x), corner.y + scale * static_cast<float>(px.y)};
  }
  glm::dvec2 px(const ImVec2& at) const {
    return {static_cast<double>((at.x - corner.x) / scale), static_cast<double>((at.y - corner.y) / scale)};
  }
};

void draw_picture(const SlicePane& pane, const Placed& placed) {
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  if (!pane.picture) return;
  const SlicePicture& picture = *pane.picture;
  const auto here = [&](const glm::dvec2& px) { return placed.at(pane.wanted.px_at(picture.frame.mm_at(px))); };
  if (pane.texture != 0 && !picture.image.values.empty())
    draw->AddImage(texture_id(pane.texture), here({0, 0}), here({picture.frame.width, picture.frame.height}));
  for (const OutlinePiece& piece : picture.outline)
    draw->AddLine(here(piece.a), here(piece.b), piece.inferred ? kPatch : kSurface,
                  piece.inferred ? kPatchOutline : kOutline);
}

void draw_cross(const ImVec2& at, const PanelRect& rect, const ImVec2& corner) {
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  draw->AddLine(ImVec2(corner.x, at.y), ImVec2(at.x - kCrossGap, at.y), kCross);
  draw->AddLine(ImVec2(at.x + kCrossGap, at.y), ImVec2(corner.x + rect.width, at.y), kCross);
  draw->AddLine(ImVec2(at.x, corner.y), ImVec2(at.x, at.y - kCrossGap), kCross);
  draw->AddLine(ImVec2(at.x, at.y + kCrossGap), ImVec2(at.x, corner.y + rect.height), kCross);
}

/// Left sets the place, the wheel goes through the scan, with control it is nearer; the right button makes it lighter
/// and darker, the middle one moves the picture.
void use_mouse(const PanelContext& context, std::size_t which, const SlicePane& pane, const Placed& placed) {
  const ImGuiIO& io = ImGui::GetIO();
  const ScanView& scan = context.state.document.scan;
  const glm::dvec3 pointed = pane.wanted.mm_at(placed.px(io.MousePos));
  const bool active = ImGui::IsItemActive(), shift = io.KeyShift;
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
    context.commands.push_back(fmt::format("slice_large {}", kSliceNames[which]));
  if (active && io.MouseDown[0] && !shift &&
      glm::distance(pane.wanted.px_at(scan.cursor_mm), pane.wanted.px_at(pointed)) > kSamePx)
    context.commands.push_back("slice_at " + place_text(pointed));
  const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
  if (active && moved != glm::dvec2(0.0) && (io.MouseDown[2] || (io.MouseDown[0] && shift))) {
    const double mm = pane.wanted.mm_per_px / static_cast<double>(placed.scale);
    context.commands.push_back(
        "slice_centre " + place_text(scan.centre_mm - mm * (moved.x * pane.wanted.right + moved.y * pane.wanted.down)));
  }
  if (active && moved != glm::dvec2(0.0) && io.MouseDown[1]) {
    const double black = context.state.slices.black, white = context.state.slices.white;
    const double half = 0.5 * (white - black) * std::exp(moved.x / kContrastPx);
    const double middle = 0.5 * (white + black) + (white - black) * moved.y / kContrastPx;
    context.commands.push_back(fmt::format("slice_grey {:.6g} {:.6g}", middle - half, middle + half));
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
    const auto notches = static_cast<double>(io.MouseWheel);
    context.commands.push_back(
        io.KeyCtrl ? fmt::format("slice_zoom {:.6g}",
                                 std::clamp(100.0 * scan.zoom * std::pow(kNearer, notches), 20.0, 20000.0))
                   : fmt::format("slice_step {} {:.6g}", kSliceNames[which], kWheelMm * notches));
  }
}

void draw_labels(const SlicePane& pane, std::size_t which, const ScanView& scan, const PanelRect& rect,
                 const Placed& placed) {
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  std::string label = tr_name("which", kSliceNames[which]);
  if (which < 3) label += local_figures(fmt::format("  {:.2f} mm", scan.cursor_mm[static_cast<int>(which)]));
  if (!pane.ready()) label += "   " + slice_state(pane);
  const ImVec2 at(placed.corner.x + 6, placed.corner.y + 3);
  draw->AddText(ImVec2(at.x + 1, at.y + 1), kNothing, label.c_str());
  draw->AddText(at, kText, label.c_str());
  const double mm_per_unit = pane.wanted.mm_per_px / static_cast<double>(placed.scale);
  const double mm = scale_bar_mm(mm_per_unit, kBarPx);
  const auto length = static_cast<float>(mm / mm_per_unit);
  const std::string bar = local_figures(fmt::format("{:g} mm", mm));
  const ImVec2 end(placed.corner.x + rect.width - 8, placed.corner.y + rect.height - 7);
  const ImVec2 size = ImGui::CalcTextSize(bar.c_str());
  draw->AddRectFilled(ImVec2(end.x - std::max(length, size.x) - 5, end.y - size.y - 4), ImVec2(end.x + 5, end.y + 5),
                      IM_COL32(0x17, 0x18, 0x1b, 0xb0), 3.0f);  // over clay, too, it is read
  draw->AddLine(ImVec2(end.x - length, end.y), end, kText, 2.0f);
  draw->AddText(ImVec2(end.x - 0.5f * (length + size.x), end.y - size.y - 2), kText, bar.c_str());
}

void draw_head(const PanelContext& context) {
  const SlicePanelState& slices = context.state.slices;
  for (const char* name : {"all", "x", "y", "z", "free"}) {
    const int large = context.state.document.scan.large;
    const bool active =
        name == (large == 0 ? std::string_view("all") : kSliceNames[static_cast<std::size_t>(large - 1)]);
    button(context, tr_name("which", name), std::string("slice_large ") + name, active);
    ImGui::SameLine();
  }
  button(context, tr("slice.here"), "tool slice", context.state.ui.tool == "slice");
  ImGui::SameLine();
  button(context, tr("slice.turn"), "slice_turn", false);
  ImGui::SameLine();
  button(context, "+", "slice_nearer", false);
  ImGui::SameLine();
  button(context, "-", "slice_farther", false);
  ImGui::SameLine();
  button(context, tr("slice.grey"), "slice_grey auto", false);
  const glm::dvec3& at = context.state.document.scan.cursor_mm;
  std::string line = fmt::format("{:.2f}; {:.2f}; {:.2f} mm", at.x, at.y, at.z);
  if (slices.value) line += "   " + tr("slice.value", fmt::format("{:.4g}", *slices.value));
  ImGui::TextColored(ImColor(kDim), "%s", local_figures(std::move(line)).c_str());
}

}  // namespace

std::array<PanelRect, kSlices> slice_rects(float width, float height, int large) noexcept {
  const float panel = slices_width(width);
  const PanelRect all{width - kTab - panel, kTopLine + kGap + kHead, panel - kGap,
                      height - kTopLine - kStrip - 2 * kGap - kHead - kFoot};
  std::array<PanelRect, kSlices> out{};
  if (large > 0) {
    out[static_cast<std::size_t>(large - 1)] = all;
    return out;
  }
  const float w = 0.5f * (all.width - kBetween), h = 0.5f * (all.height - kBetween);
  constexpr std::array<std::array<int, 2>, kSlices> kPlaces{{{0, 1}, {1, 0}, {0, 0}, {1, 1}}};  // z, y above; x, free
  for (std::size_t i = 0; i < kSlices; ++i)
    out[i] = {all.x + static_cast<float>(kPlaces[i][0]) * (w + kBetween),
              all.y + static_cast<float>(kPlaces[i][1]) * (h + kBetween), w, h};
  return out;
}

void draw_slices(const PanelContext& context) {
  const float panel = slices_width(context.width);
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0f);
  ImGui::SetNextWindowPos(ImVec2(context.width - kTab - panel - kGap, kTopLine + kGap));
  ImGui::SetNextWindowSize(ImVec2(panel + kGap - 2.0f, context.height - kTopLine - kStrip - 2 * kGap));
  ImGui::Begin("slices", nullptr, kFixed | ImGuiWindowFlags_NoScrollWithMouse);
  draw_head(context);
  const SlicePanelState& slices = context.state.slices;
  const auto rects = slice_rects(context.width, context.height, context.state.document.scan.large);
  ImDrawList* const draw = ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < kSlices; ++i) {
    const PanelRect& rect = rects[i];
    const SlicePane& pane = slices.panes[i];
    if (!rect.shown() || pane.wanted.width == 0) continue;
    const ImVec2 corner(rect.x, rect.y), end(rect.x + rect.width, rect.y + rect.height);
    const Placed placed{corner, rect.width / static_cast<float>(pane.wanted.width)};
    ImGui::SetCursorScreenPos(corner);
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton(
        "slice", ImVec2(rect.width, rect.height),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    use_mouse(context, i, pane, placed);
    ImGui::PopID();
    draw->PushClipRect(corner, end, true);
    draw->AddRectFilled(corner, end, kNothing);
    draw_picture(pane, placed);
    draw_cross(placed.at(pane.wanted.px_at(context.state.document.scan.cursor_mm)), rect, corner);
    draw_labels(pane, i, context.state.document.scan, rect, placed);
    draw->PopClipRect();
  }
  const std::string& words = !slices.note.empty() ? slices.note
                             : !slices.scan       ? tr("slice.no_scan")
                                                  : tr("slice.inferred");
  ImGui::SetCursorScreenPos(
      ImVec2(rects[2].shown() ? rects[2].x : context.width - kTab - panel, context.height - kStrip - kGap - kFoot + 2));
  say_fitted(slices.note.empty() && slices.scan ? kPatch : kDim, words,
             context.width - kTab - 2.0f * kGap - ImGui::GetCursorScreenPos().x);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace dubsar::app
