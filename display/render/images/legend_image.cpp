#include "display/render/images/legend_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "display/render/images/label_text.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar {
namespace {

constexpr double kBarEm = 13.0, kTallEm = 0.8, kPadEm = 0.7, kLineEm = 1.25, kTickEm = 0.25;

void fill(Image& image, double x0, double y0, double x1, double y1, const Rgb8& color) {
  const auto pixel = [](double at, int most) { return std::clamp(static_cast<int>(std::lround(at)), 0, most); };
  for (int y = pixel(y0, image.height); y < pixel(y1, image.height); ++y)
    for (int x = pixel(x0, image.width); x < pixel(x1, image.width); ++x)
      std::copy(color.begin(), color.end(), image.at(x, y));
}

}  // namespace

std::string legend_number(double value) {
  const std::string text = fmt::format("{:.3g}", value);
  return text == "-0" ? "0" : text;
}

Result<Image> legend_image(const Style& style, LabelFont& font, int letter_px, const LegendInk& ink) {
  if (!is_field(style.map))
    return fail(ErrorKind::kUsage,
                "legend: this style's colours tell no figure, expected msii, mean-curvature, gaussian-curvature, "
                "shape-index or curvedness");
  const FieldScale scale = field_scale(style);
  const auto colors = field_colors(style);
  const double em = letter_px;
  const double side = 2.0 * em;  // numbers at the ends stand over the bar's
  Image out(static_cast<int>((kBarEm + 2 * kPadEm) * em + 2 * side),
            static_cast<int>((2 * kPadEm + 2 * kLineEm + kTallEm + kTickEm) * em), 3);
  fill(out, 0, 0, out.width, out.height, ink.ground);
  const double left = kPadEm * em + side, base = (kPadEm + 0.85) * em, top = (kPadEm + kLineEm) * em;
  write_text(out, font, scale.unit.empty() ? std::string(scale.name) : fmt::format("{}, {}", scale.name, scale.unit),
             left, base, letter_px, ink.letters);
  const double bar = kBarEm * em, below = top + kTallEm * em;
  for (int x = 0; x < static_cast<int>(bar); ++x) {
    const auto at = static_cast<std::size_t>(std::lround(x / (bar - 1.0) * (kShapeRows - 1)));
    fill(out, left + x, top, left + x + 1, below, colors[at]);
  }
  for (int tick = 0; tick < kLegendTicks; ++tick) {
    const double part = tick / (kLegendTicks - 1.0), x = left + part * (bar - 1);
    const std::string number = legend_number(scale.from + part * (scale.to - scale.from));
    fill(out, x, below, x + std::max(1.0, em / 12), below + kTickEm * em, ink.letters);
    write_text(out, font, number, x - 0.5 * em * font.width_em(number), below + (kTickEm + 0.9) * em, letter_px,
               ink.letters);
  }
  return out;
}

Image evidence_legend(const Style& style, const std::string& figures, LabelFont& font, int letter_px,
                      const LegendInk& ink) {
  const double em = letter_px, swatch = 2.6 * em, left = kPadEm * em, text = left + swatch + kPadEm * em;
  const std::string words = "no surface in the scan here: closed";
  const double longest = std::max(font.width_em(words), font.width_em(figures)) * em;
  Image out(static_cast<int>(text + longest + kPadEm * em), static_cast<int>((2 * kPadEm + 2 * kLineEm) * em), 3);
  fill(out, 0, 0, out.width, out.height, ink.ground);
  const double top = (kPadEm + 0.1) * em, below = out.height - top, stripe = 0.28 * em;
  for (int y = static_cast<int>(top); y < static_cast<int>(below); ++y)
    for (int x = static_cast<int>(left); x < static_cast<int>(left + swatch); ++x) {
      const bool dark = std::fmod((x + y) / stripe, 2.0) >= 1.0;
      fill(out, x, y, x + 1, y + 1, dark ? style.hatch.stripe : style.hatch.ground);
    }
  write_text(out, font, words, text, (kPadEm + 0.9) * em, letter_px, ink.letters);
  write_text(out, font, figures, text, (kPadEm + kLineEm + 0.9) * em, letter_px, ink.letters);
  return out;
}

void put_into_corner(const Image& what, Image& into, int margin_px) {
  const int top = into.height - margin_px - what.height;
  for (int y = 0; y < what.height; ++y)
    for (int x = 0; x < what.width; ++x) {
      const int px = margin_px + x, py = top + y;
      if (px >= into.width || py < 0 || py >= into.height) continue;
      std::copy_n(what.at(x, y), 3, into.at(px, py));
      if (into.channels == 4) into.at(px, py)[3] = 255;
    }
}

}  // namespace dubsar
