#include "core/script/copy_text.h"

#include <algorithm>
#include <iterator>

namespace dubsar {
namespace {

// mm on paper.
constexpr double kCopyTextSize = 2.5, kCopyTextLine = 3.7, kCopyTextMargin = 8.0, kCopyTextNumber = 9.0;
constexpr double kCopyTextWide =
    0.52;  // width of a letter, of its size: of serif faces, and wide enough for most lines

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

}  // namespace

std::vector<TextSide> add_text(CopySheet& sheet, std::span<const CopyTextLine> lines) {
  std::vector<TextSide> differ;
  CopyLayer layer{"text", "transliteration", "text", {}, {}, {}};
  const double x = sheet.width_mm;
  double y = kCopyTextMargin + kCopyTextLine, widest = 0.0;
  for (std::size_t s = 0; s < kTextSideCount; ++s) {
    const auto side = static_cast<TextSide>(s);
    std::vector<CopyTextLine> here;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(here),
                 [&](const CopyTextLine& l) { return l.side == side; });
    if (here.empty()) continue;
    const std::string name(name_in(kTextSides, side));
    for (CopyLayer& numbers : sheet.layers) {
      if (numbers.id != name + "-numbers") continue;
      if (numbers.texts.size() != here.size()) {
        differ.push_back(side);
        continue;
      }
      for (std::size_t k = 0; k < here.size(); ++k) numbers.texts[k].text = here[k].number;  // both from the top
    }
    layer.texts.push_back({{x, y}, name, kCopyTextSize, CopyText::Anchor::kStart});
    y += kCopyTextLine;
    for (const CopyTextLine& line : here) {
      layer.texts.push_back({{x + kCopyTextNumber - 2.0, y}, line.number, kCopyTextSize, CopyText::Anchor::kEnd});
      layer.texts.push_back({{x + kCopyTextNumber, y}, line.text, kCopyTextSize, CopyText::Anchor::kStart});
      widest = std::max(widest, kCopyTextWide * kCopyTextSize * static_cast<double>(characters(line.text)));
      y += kCopyTextLine;
    }
    y += kCopyTextLine;
  }
  if (layer.texts.empty()) return differ;
  sheet.width_mm += kCopyTextNumber + widest + kCopyTextMargin;
  sheet.height_mm = std::max(sheet.height_mm, y + kCopyTextMargin);
  sheet.layers.push_back(std::move(layer));
  return differ;
}

}  // namespace dubsar
