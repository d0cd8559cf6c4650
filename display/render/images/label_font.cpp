#include "display/render/images/label_font.h"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <imgui/imstb_truetype.h>

#include <algorithm>

#include "display/render/images/utf8.h"

namespace dubsar {

struct LabelFont::Outlines {
  stbtt_fontinfo info{};
  float scale = 1.0f;
};

LabelFont::LabelFont(std::unique_ptr<Outlines> outlines)
    : outlines_(std::move(outlines)), sheet_(static_cast<std::size_t>(kSide) * kSide, 0) {}
LabelFont::~LabelFont() = default;

Result<std::unique_ptr<LabelFont>> LabelFont::create(std::span<const unsigned char> ttf) {
  auto outlines = std::make_unique<Outlines>();
  constexpr std::size_t kLeast = 12;  // of a font's table of contents
  if (ttf.size() < kLeast || stbtt_GetFontOffsetForIndex(ttf.data(), 0) != 0 ||
      stbtt_InitFont(&outlines->info, ttf.data(), 0) == 0)
    return fail(ErrorKind::kBadData, "labels: {} bytes found that are no TrueType font", ttf.size());
  outlines->scale = stbtt_ScaleForPixelHeight(&outlines->info, static_cast<float>(kEmPx));
  return std::unique_ptr<LabelFont>(new LabelFont(std::move(outlines)));
}

const LabelFont::Glyph& LabelFont::glyph(unsigned code) {
  if (const auto found = glyphs_.find(code); found != glyphs_.end()) return found->second;
  Glyph out;
  int advance = 0, bearing = 0, width = 0, height = 0, left = 0, top = 0;
  stbtt_GetCodepointHMetrics(&outlines_->info, static_cast<int>(code), &advance, &bearing);
  out.advance = static_cast<double>(outlines_->scale) * advance;
  unsigned char* const distances =
      stbtt_GetCodepointSDF(&outlines_->info, outlines_->scale, static_cast<int>(code), kSpreadPx, 128,
                            128.0f / kSpreadPx, &width, &height, &left, &top);
  if (distances != nullptr && width < kSide && height < kSide) {
    if (next_x_ + width > kSide) {
      row_y_ += row_height_;
      row_height_ = next_x_ = 0;
    }
    if (row_y_ + height > kSide) {  // full: what is needed now is drawn again
      glyphs_.clear();
      std::fill(sheet_.begin(), sheet_.end(), std::uint8_t{0});
      row_y_ = row_height_ = next_x_ = 0;
    }
    out.x = next_x_;
    out.y = row_y_;
    out.width = width;
    out.height = height;
    out.left = left;
    out.top = -top;
    for (int y = 0; y < height; ++y)
      std::copy_n(distances + static_cast<std::ptrdiff_t>(y) * width, width,
                  sheet_.begin() + static_cast<std::ptrdiff_t>(row_y_ + y) * kSide + next_x_);
    next_x_ += width;
    row_height_ = std::max(row_height_, height);
    ++version_;
  }
  if (distances != nullptr) stbtt_FreeSDF(distances, nullptr);
  return glyphs_.emplace(code, out).first->second;
}

double LabelFont::width_em(std::string_view text) {
  double out = 0.0;
  for (const unsigned code : code_points(text)) out += glyph(code).advance;
  return out / kEmPx;
}

}  // namespace dubsar
