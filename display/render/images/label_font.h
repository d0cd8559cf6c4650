#pragma once
// Letters for labels, as fields of distances to their outlines: sharp at every size, with a border for nothing more.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// One thread at a time.
class LabelFont {
 public:
  /// Pixels of the sheet; the letters' own height counts kEmPx.
  struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;  ///< in the sheet; no size: nothing to draw, such as a space
    double left = 0.0, top = 0.0;             ///< from the pen on the base line to its corner; top: upwards
    double advance = 0.0;                     ///< of the pen
  };
  static constexpr int kSide = 1024, kEmPx = 40, kSpreadPx = 6;

  /// `ttf`, a TrueType font, outlives this. kBadData when it is none.
  static Result<std::unique_ptr<LabelFont>> create(std::span<const unsigned char> ttf);
  ~LabelFont();
  LabelFont(const LabelFont&) = delete;
  LabelFont& operator=(const LabelFont&) = delete;

  /// Drawn at its first use (some .2 ms). A letter that the font does not have looks like its sign for that.
  const Glyph& glyph(unsigned code);
  /// Of a line of text, in heights of the letters.
  double width_em(std::string_view text);

  /// kSide x kSide distances: 128 on the outline, more inside, 128 / kSpreadPx for each pixel.
  std::span<const std::uint8_t> sheet() const noexcept { return sheet_; }
  /// Another one when the sheet has changed.
  std::uint64_t version() const noexcept { return version_; }

 private:
  struct Outlines;
  explicit LabelFont(std::unique_ptr<Outlines> outlines);
  std::unique_ptr<Outlines> outlines_;
  std::map<unsigned, Glyph> glyphs_;
  std::vector<std::uint8_t> sheet_;
  int row_y_ = 0, row_height_ = 0, next_x_ = 0;
  std::uint64_t version_ = 1;
};

}  // namespace dubsar
