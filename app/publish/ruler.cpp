// The ruler of a fat-cross: centimetres dark and light by turns, millimetres as ticks, and its length in words.

#include <algorithm>
#include <cmath>
#include <string>

#include "app/publish/fat_cross.h"
#include "display/render/images/label_text.h"

namespace dubsar::app {
namespace {

constexpr double kRulerLettersMm = 3.0;  // as high as on museums' rulers

void put(Image& image, int x, int y, const Rgb8& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy(color.begin(), color.end(), image.at(x, y));
}

void rectangle(Image& image, int x0, int y0, int x1, int y1, const Rgb8& color) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) put(image, x, y, color);
}

}  // namespace

int ruler_length_mm(double tablet_width_mm) {
  for (const int mm : {50, 20})
    if (tablet_width_mm >= mm) return mm;
  return 10;
}

Image draw_ruler(int mm, double dpi, const Rgb8& ground, LabelFont* font) {
  const double per_mm = dpi / 25.4;
  const int length = static_cast<int>(std::lround(mm * per_mm));
  const int bar = std::max(3, static_cast<int>(std::lround(1.5 * per_mm)));
  const double letters = std::max(10.0, kRulerLettersMm * per_mm);
  Image image(length, bar + static_cast<int>(std::lround(1.3 * letters)), 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) put(image, x, y, ground);
  const bool dark_ground = ground[0] + ground[1] + ground[2] < 384;
  const Rgb8 ink = dark_ground ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0},
             other = dark_ground ? Rgb8{90, 90, 90} : Rgb8{170, 170, 170};
  for (int k = 0; k < mm; ++k) {  // the first centimetre in millimetres, then whole ones
    const bool fine = k < 10;
    const bool inked = fine ? k % 2 == 0 : (k / 10) % 2 == 1;
    rectangle(image, static_cast<int>(std::lround(k * per_mm)), 0, static_cast<int>(std::lround((k + 1) * per_mm)), bar,
              inked ? ink : other);
  }
  if (font != nullptr) write_text(image, *font, std::to_string(mm / 10) + " cm", 0.0, bar + letters, letters, ink);
  return image;
}

}  // namespace dubsar::app
