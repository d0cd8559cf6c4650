#include "app/panels/help_columns.h"

#include <imgui.h>

#include <algorithm>
#include <optional>

#include "app/panels/panel_font.h"

namespace dubsar::app {
namespace {

constexpr float kAround = 12.0f, kHelpStepPx = kLinePx + 4.0f;
constexpr float kLargest = 1.6f, kSmallest = 0.45f, kScaleStep = 0.05f;
constexpr float kBar = 16.0f;                               // for the bar at the right, where there is one
constexpr std::size_t kMostColumns = 4, kLeastGlyphs = 24;  // of a column, behind what is pressed

std::size_t lines_of(const HelpSection& section, std::size_t glyphs, std::size_t second) {
  std::size_t lines = 2;
  for (const HelpRow& row : section.rows) {
    const std::size_t start = std::max(second, row.what.size() + 1), room = glyphs > start + 8 ? glyphs - start : 8;
    lines += row.does.size() <= room ? 1 : row.does.size() / (room - 4) + 1;  // words are not cut
  }
  return lines;
}

/// First sections of at most `columns` columns of `rows` lines; nothing when it
/// does not fit.
std::optional<std::vector<std::size_t>> fill(const std::vector<std::size_t>& lines, std::size_t columns,
                                             std::size_t rows) {
  std::vector<std::size_t> starts{0};
  std::size_t used = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (used > 0 && used + lines[i] > rows) {
      starts.push_back(i);
      used = 0;
    }
    used += lines[i];
    if (used > rows || starts.size() > columns) return std::nullopt;
  }
  return starts;
}

void draw_section(const HelpSection& section, float second, float width) {
  ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.45f, 1.0f), "%s", section.title.c_str());
  const float left = ImGui::GetCursorPosX(),
              column = ImGui::GetColumnOffset();  // of the window
  for (const HelpRow& row : section.rows) {
    ImGui::TextUnformatted(row.what.c_str());
    ImGui::SameLine(left - column +
                    std::max(second, ImGui::CalcTextSize((row.what + " ").c_str()).x));  // counts from the column
    ImGui::PushTextWrapPos(left + width);
    ImGui::TextColored(ImVec4(0.85f, 0.88f, 0.9f, 1.0f), "%s", row.does.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::Spacing();
}

std::vector<std::size_t> lines_in_columns(const std::vector<HelpSection>& help, float column_width, float scale,
                                          std::size_t second) {
  const auto glyphs = static_cast<std::size_t>(column_width / (kGlyphPx * scale));
  std::vector<std::size_t> lines;
  if (glyphs < second + kLeastGlyphs) return lines;
  for (const HelpSection& section : help) lines.push_back(lines_of(section, glyphs - 2, second));
  return lines;
}

}  // namespace

HelpColumns arrange_help(const std::vector<HelpSection>& help, float width, float height, float least) {
  HelpColumns out;
  for (const HelpSection& section : help)
    for (const HelpRow& row : section.rows)
      out.second = std::max(out.second, std::min<std::size_t>(row.what.size() + 2, 20));
  const float room = width - 4 * kAround;
  const auto lines = [&](std::size_t columns, float scale) {
    return lines_in_columns(help, out.column_width = room / static_cast<float>(columns), scale, out.second);
  };
  least = std::clamp(least, kSmallest, kLargest);
  for (out.scale = kLargest; out.scale >= least - 0.5f * kScaleStep; out.scale -= kScaleStep)
    for (std::size_t columns = 1; columns <= kMostColumns; ++columns) {
      const std::vector<std::size_t> needed = lines(columns, out.scale);
      const auto rows = static_cast<std::size_t>((height - 4 * kAround) / (kHelpStepPx * out.scale));
      auto starts = needed.empty() ? std::nullopt : fill(needed, columns, rows);
      if (!starts) continue;
      out.starts = *std::move(starts);
      out.fits = true;
      return out;
    }
  out.scale = least;
  std::size_t columns = kMostColumns;
  while (columns > 1 && lines(columns, out.scale).empty()) --columns;
  const std::vector<std::size_t> needed = lines(columns, out.scale);
  if (needed.empty()) return out;  // narrower than a line: one column
  std::size_t total = 0;
  for (const std::size_t n : needed) total += n;
  for (std::size_t rows = total / columns; rows <= total; ++rows)
    if (auto starts = fill(needed, columns, rows)) {
      out.starts = *std::move(starts);
      break;
    }
  return out;
}

void HelpScroll::by(float pixels) noexcept { at = std::clamp(at + pixels, 0.0f, most); }

void draw_help(const std::vector<HelpSection>& help, float width, float height, float least, HelpScroll& scroll) {
  HelpColumns layout = arrange_help(help, width, height, least);
  if (!layout.fits) layout = arrange_help(help, width - kBar, height, least);
  const float glyph = kGlyphPx * layout.scale;
  ImGui::SetNextWindowPos(ImVec2(kAround, kAround));
  ImGui::SetNextWindowSize(ImVec2(width - 2 * kAround, layout.fits ? 0.0f : height - 2 * kAround));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8.0f, (kHelpStepPx - kLinePx) * layout.scale));
  const ImGuiWindowFlags bar = ImGuiWindowFlags_AlwaysVerticalScrollbar | ImGuiWindowFlags_NoTitleBar |
                               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse;
  ImGui::Begin("help", nullptr,
               (layout.fits ? ImGuiWindowFlags_NoDecoration : bar) | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::SetWindowFontScale(layout.scale * kLinePx / kLargeFontPx);
  scroll.most = layout.fits ? 0.0f : ImGui::GetScrollMaxY();
  scroll.page = 0.85f * height;
  scroll.by(0.0f);
  ImGui::SetScrollY(scroll.at);
  ImGui::Columns(static_cast<int>(layout.starts.size()), "columns", false);
  for (std::size_t i = 0; i < help.size(); ++i) {
    if (i > 0 && std::find(layout.starts.begin(), layout.starts.end(), i) != layout.starts.end()) ImGui::NextColumn();
    draw_section(help[i], static_cast<float>(layout.second) * glyph, layout.column_width - 2 * glyph);
  }
  ImGui::Columns(1);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace dubsar::app
