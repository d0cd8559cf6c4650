#include "app/panels/overlay.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <optional>

#include "display/render/gl_objects.h"
#include "display/render/view_array.h"

namespace dubsar::app {
namespace {

constexpr float kFontPx = 26.0f;  // twice the bitmap font's own size: sharp when it is halved
constexpr float kLinePx = 13.0f;
constexpr float kGlyphPx = 7.0f;        // its width, at kLinePx
constexpr double kLeastHeight = 540.0;  // of the layout; smaller views show it smaller
constexpr double kMostHeight = 900.0;   // larger ones larger
constexpr float kMargin = 12.0f;

constexpr float kLineStepPx = kLinePx + 4.0f;
constexpr float kLargest = 1.6f, kSmallest = 0.45f, kScaleStep = 0.05f;

struct Layout {
  float scale = kSmallest, column_width = 0.0f;
  std::size_t second = 0;              ///< glyphs before the second word of a row
  std::vector<std::size_t> starts{0};  ///< first section of each column
};

std::size_t lines_of(const HelpSection& section, std::size_t glyphs, std::size_t second) {
  std::size_t lines = 2;
  for (const HelpRow& row : section.rows) {
    const std::size_t start = std::max(second, row.what.size() + 1), room = glyphs > start + 8 ? glyphs - start : 8;
    lines += row.does.size() <= room ? 1 : row.does.size() / (room - 4) + 1;  // words are not cut
  }
  return lines;
}

/// First sections of at most `columns` columns of `rows` lines; nothing when it does not fit.
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

/// The largest text with which all sections fit.
Layout arrange(const std::vector<HelpSection>& help, float width, float height) {
  Layout best;
  for (const HelpSection& section : help)
    for (const HelpRow& row : section.rows)
      best.second = std::max(best.second, std::min<std::size_t>(row.what.size() + 2, 20));
  best.column_width = width - 4 * kMargin;
  for (float scale = kLargest; scale >= kSmallest; scale -= kScaleStep)
    for (std::size_t columns = 1; columns <= 4; ++columns) {
      const float column_width = (width - 4 * kMargin) / static_cast<float>(columns);
      const auto glyphs = static_cast<std::size_t>(column_width / (kGlyphPx * scale));
      if (glyphs < best.second + 24) continue;
      std::vector<std::size_t> lines;
      for (const HelpSection& section : help) lines.push_back(lines_of(section, glyphs - 2, best.second));
      if (auto starts = fill(lines, columns, static_cast<std::size_t>((height - 4 * kMargin) / (kLineStepPx * scale))))
        return {scale, column_width, best.second, *std::move(starts)};
    }
  return best;
}

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav;

void draw_section(const HelpSection& section, float second, float width) {
  ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.45f, 1.0f), "%s", section.title.c_str());
  const float left = ImGui::GetCursorPosX(), column = ImGui::GetColumnOffset();  // of the window
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

void draw_help(const std::vector<HelpSection>& help, float width, float height) {
  const Layout layout = arrange(help, width, height);
  const float glyph = kGlyphPx * layout.scale;
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowSize(ImVec2(width - 2 * kMargin, 0.0f));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8.0f, (kLineStepPx - kLinePx) * layout.scale));
  ImGui::Begin("help", nullptr, kPlain);
  ImGui::SetWindowFontScale(layout.scale * kLinePx / kFontPx);
  ImGui::Columns(static_cast<int>(layout.starts.size()), "columns", false);
  for (std::size_t i = 0; i < help.size(); ++i) {
    if (i > 0 && std::find(layout.starts.begin(), layout.starts.end(), i) != layout.starts.end()) ImGui::NextColumn();
    draw_section(help[i], static_cast<float>(layout.second) * glyph, layout.column_width - 2 * glyph);
  }
  ImGui::Columns(1);
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_notice(const std::string& notice, double opacity, float width, float height) {
  const float scale = std::min(1.4f, (width - 4 * kMargin) / (static_cast<float>(notice.size() + 2) * kGlyphPx));
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, static_cast<float>(std::clamp(opacity, 0.0, 1.0)));
  ImGui::SetNextWindowPos(ImVec2(0.5f * width, height - kMargin), ImGuiCond_Always, ImVec2(0.5f, 1.0f));
  ImGui::SetNextWindowBgAlpha(0.7f);
  ImGui::Begin("notice", nullptr, kPlain | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::SetWindowFontScale(std::max(scale, 0.7f) * kLinePx / kFontPx);
  ImGui::PushTextWrapPos(width - 4 * kMargin);
  ImGui::TextUnformatted(notice.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create() {
  DUBSAR_CHECK(ImGui::GetCurrentContext() == nullptr);
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.DeltaTime = 1.0f / 60.0f;
  ImFontConfig font;
  font.SizePixels = kFontPx;
  io.Fonts->AddFontDefault(&font);
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowBorderSize = 0.0f;
  ImGui::GetStyle().WindowRounding = 4.0f;
  if (!ImGui_ImplOpenGL3_Init("#version 430")) {
    ImGui::DestroyContext();
    return fail(ErrorKind::kUnavailable, "overlay: Dear ImGui found no OpenGL library that it can use");
  }
  return std::unique_ptr<Overlay>(new Overlay());
}

Overlay::~Overlay() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

Result<void> Overlay::paint(ViewArray& layers, const glm::dvec2& window_mm) {
  if (text_.empty()) return {};
  const double height = std::clamp(static_cast<double>(layers.height()), kLeastHeight, kMostHeight);
  const double width = height * window_mm.x / window_mm.y;
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DisplayFramebufferScale =
      ImVec2(static_cast<float>(layers.width() / width), static_cast<float>(layers.height() / height));
  ImGui_ImplOpenGL3_NewFrame();
  for (int pass = 0; pass < 2; ++pass) {  // sizes that follow from text are known in the second
    ImGui::NewFrame();
    if (!text_.help.empty()) draw_help(text_.help, io.DisplaySize.x, io.DisplaySize.y);
    if (!text_.notice.empty()) draw_notice(text_.notice, text_.notice_opacity, io.DisplaySize.x, io.DisplaySize.y);
    ImGui::Render();
  }
  const GlFramebuffer target = make_framebuffer();
  for (int layer = 0; layer < layers.layers(); ++layer) {
    glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, layers.coded(), 0, layer);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("drawing the overlay");
}

}  // namespace dubsar::app
