#include "app/panels/text_ruler.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <vector>

#include "app/panels/gallery_page.h"
#include "app/panels/panel_font.h"
#include "app/stage/right_to_left.h"
#include "display/render/images/utf8.h"

namespace dubsar::app {
namespace {

constexpr double kRulerPx = 1080.0;  // the panel's height; only shares of it matter

}  // namespace

TextRuler::TextRuler(double width_mm, double height_mm, double reading_distance_m)
    : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()), width_px_(kRulerPx * width_mm / height_mm) {
  ImGui::SetCurrentContext(own_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = ImVec2(static_cast<float>(width_px_), static_cast<float>(kRulerPx));
  io.DeltaTime = 1.0f / 60.0f;
  add_panel_font(*io.Fonts, kLargeFontPx, panel_letters_of_all());
  add_title_font(*io.Fonts, kLargeFontPx);
  unsigned char* pixels = nullptr;
  int wide = 0, high = 0;
  io.Fonts->GetTexDataAsAlpha8(&pixels, &wide, &high);
  ImGui::NewFrame();
  size_ = letters_size(letter_height_mm(reading_distance_m), kRulerPx, kRulerPx / height_mm);
}

TextRuler::~TextRuler() {
  ImGui::EndFrame();
  ImGui::DestroyContext(own_);
  ImGui::SetCurrentContext(before_);
}

std::string TextRuler::wrong(const std::string& text, bool title) const {
  std::string missing;
  for (const unsigned code : code_points(as_seen(text, false)))
    if (code > ' ' && (code > 0xFFFF || ImGui::GetFont()->FindGlyphNoFallback(static_cast<ImWchar>(code)) == nullptr)) {
      const std::string one = fmt::format("U+{:04X}", code);
      if (missing.find(one) == std::string::npos) missing += (missing.empty() ? "" : ", ") + one;
    }
  if (!missing.empty())
    return fmt::format("letters that the font lacks ({}) are shown as ?; write it without", missing);
  const double size = title ? kTitleLarger * size_ : size_;
  const PushedTitleFont serif(text, title);
  const SetWords set = set_words(text, size, width_px_, has_right_to_left(text));
  const double lines = std::round(set.tall / set.size), most = title ? kTitleLines : kSentenceLines;
  if (lines <= most) return {};
  const auto letters = code_points(text).size();
  return fmt::format(
      "a text of {} letters takes {:.0f} lines of this panel, where {:.0f} stand beside the object; "
      "shorten it to some {:.0f} letters",
      letters, lines, most, std::floor(0.9 * static_cast<double>(letters) * most / lines));
}

}  // namespace dubsar::app
