#include "app/panels/panel_font.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string_view>
#include <vector>

#include "display/render/images/utf8.h"

// The file goes into the program as it is; the assembler reads it, which takes
// no time for a compiler.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".globl dubsar_panel_font\n"
    "dubsar_panel_font:\n"
    ".incbin \"" DUBSAR_PANEL_FONT
    "\"\n"
    ".globl dubsar_panel_font_end\n"
    "dubsar_panel_font_end:\n"
    ".byte 0\n"
    ".balign 16\n"
    ".globl dubsar_title_font\n"
    "dubsar_title_font:\n"
    ".incbin \"" DUBSAR_TITLE_FONT
    "\"\n"
    ".globl dubsar_title_font_end\n"
    "dubsar_title_font_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {  // NOLINTBEGIN(readability-identifier-naming): the assembler's names
extern const unsigned char dubsar_panel_font[];
extern const unsigned char dubsar_panel_font_end[];
extern const unsigned char dubsar_title_font[];
extern const unsigned char dubsar_title_font_end[];
}  // NOLINTEND(readability-identifier-naming)

namespace dubsar::app {

std::span<const unsigned char> panel_font() { return {dubsar_panel_font, dubsar_panel_font_end}; }

/// From the font's own tables: "OS/2" tells capitals, "hhea" the size.
ImFont* add_panel_font(ImFontAtlas& atlas, float size_px, const std::uint16_t* letters) {
  ImFontConfig font;
  font.FontDataOwnedByAtlas = false;
  const std::span<const unsigned char> data = panel_font();
  // ImGui does not write to what it does not own.
  return atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(data.data()), static_cast<int>(data.size()), size_px,
                                    &font, letters);
}

namespace {
constexpr const char* kTitleFontName = "dubsar title";
}

ImFont* add_title_font(ImFontAtlas& atlas, float size_px) {
  ImFontConfig font;
  font.FontDataOwnedByAtlas = false;
  std::snprintf(font.Name, sizeof(font.Name), "%s", kTitleFontName);
  return atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(dubsar_title_font),
                                    static_cast<int>(dubsar_title_font_end - dubsar_title_font), size_px, &font,
                                    panel_letters());
}

PushedTitleFont::PushedTitleFont(std::string_view words, bool wanted) {
  if (!wanted) return;
  const std::vector<unsigned> letters = code_points(std::string(words));
  for (ImFont* const font : ImGui::GetIO().Fonts->Fonts) {
    if (std::string_view(font->GetDebugName()) != kTitleFontName) continue;
    pushed_ = std::all_of(letters.begin(), letters.end(), [&](unsigned code) {
      return code <= ' ' || (code <= 0xFFFF && font->FindGlyphNoFallback(static_cast<ImWchar>(code)) != nullptr);
    });
    if (pushed_) ImGui::PushFont(font);
    return;
  }
}
PushedTitleFont::~PushedTitleFont() {
  if (pushed_) ImGui::PopFont();
}

double panel_capital() noexcept {
  const std::span<const unsigned char> font = panel_font();
  const auto word = [&](std::size_t at) {
    return at + 2 <= font.size() ? static_cast<std::int16_t>(font[at] << 8 | font[at + 1]) : std::int16_t{0};
  };
  const auto table = [&](std::string_view tag) {
    constexpr std::size_t kFirst = 12, kEach = 16;
    for (std::size_t i = 0; i < static_cast<std::uint16_t>(word(4)); ++i) {
      const std::size_t row = kFirst + kEach * i;
      if (row + kEach > font.size()) break;
      if (std::equal(tag.begin(), tag.end(), font.begin() + static_cast<std::ptrdiff_t>(row)))
        return static_cast<std::size_t>(static_cast<std::uint16_t>(word(row + 8))) << 16 |
               static_cast<std::uint16_t>(word(row + 10));
    }
    return font.size();
  };
  const std::size_t metrics = table("OS/2"), lines = table("hhea");
  constexpr std::size_t kCapital = 88, kAscent = 4, kDescent = 6;
  const double size = word(lines + kAscent) - word(lines + kDescent);
  constexpr double kUsual = 0.626;  // DejaVu Sans, whose table is too old to tell
  const bool tells = word(metrics) >= 2 && size > 0;
  const double capital = tells ? word(metrics + kCapital) / size : 0.0;
  return capital > 0.3 && capital < 1.0 ? capital : kUsual;
}

const std::uint16_t* panel_letters() {
  static constexpr std::array<std::uint16_t, 13> kLetters{0x20,   0x17f,  0x1e00, 0x1eff, 0x2b0,  0x2ff, 0x2070,
                                                          0x209f, 0x2010, 0x203a, 0x2190, 0x21ff, 0};
  return kLetters.data();
}

const std::uint16_t* panel_letters_of_all() {
  static constexpr std::array<std::uint16_t, 19> kLetters{0x20,   0x17f,  0x2b0,  0x2ff,  0x590,  0x6ff,  0x1e00,
                                                          0x1eff, 0x2010, 0x203a, 0x2070, 0x209f, 0x2190, 0x21ff,
                                                          0xfb1d, 0xfbff, 0xfe70, 0xfefc, 0};
  return kLetters.data();
}

}  // namespace dubsar::app
