#pragma once
// The letters of the panels: a TrueType font of the build machine
// (cmake/Font.cmake says which), inside the program.

#include <cstdint>
#include <span>
#include <string_view>

struct ImFont;
struct ImFontAtlas;

namespace dubsar::app {

/// Adds it to an atlas, in this size and with these letters (panel_letters()).
ImFont* add_panel_font(ImFontAtlas& atlas, float size_px, const std::uint16_t* letters);

/// The serif of titles: added to an atlas as panels' fonts are, used while this lives, where it has all letters of
/// `words`.
ImFont* add_title_font(ImFontAtlas& atlas, float size_px);
class PushedTitleFont {
 public:
  explicit PushedTitleFont(std::string_view words, bool wanted = true);
  ~PushedTitleFont();
  PushedTitleFont(const PushedTitleFont&) = delete;
  PushedTitleFont& operator=(const PushedTitleFont&) = delete;

 private:
  bool pushed_ = false;
};

std::span<const unsigned char> panel_font();

/// Height of its capitals, of the size that text is set in (from the lowest to the highest letter).
double panel_capital() noexcept;

/// The letters that panels use of it, as ranges (first, last ... 0): those of European languages, of transliterations
/// of Akkadian and Sumerian, and digits above and below the line.
const std::uint16_t* panel_letters();

/// The same and those of Hebrew and Arabic, joined ones too (app/stage/right_to_left.h).
const std::uint16_t* panel_letters_of_all();

/// Pixels of the layout: the large font, sharp when it is halved; lines of the help and its like, and their usual
/// glyph.
inline constexpr float kLargeFontPx = 26.0f, kLinePx = 13.0f, kGlyphPx = 7.4f;

}  // namespace dubsar::app
