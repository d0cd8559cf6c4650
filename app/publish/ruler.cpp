// The ruler of a fat-cross: centimetres dark and light by turns, millimetres as ticks, and its length in words.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/publish/fat_cross.h"

namespace dubsar::app {
namespace {

/// Letters as strokes in a box of 4 x 6 units, y down: enough for "10 cm".
struct Stroke {
  float x0, y0, x1, y1;
};
const std::vector<Stroke>& strokes_of(char letter) {
  static const std::array<std::vector<Stroke>, 6> table{{
      {{1, 1, 2, 0}, {2, 0, 2, 6}, {1, 6, 3, 6}},                                                          // 1
      {{0, 1, 1, 0}, {1, 0, 3, 0}, {3, 0, 4, 1}, {4, 1, 4, 2}, {4, 2, 0, 6}, {0, 6, 4, 6}},                // 2
      {{4, 0, 0, 0}, {0, 0, 0, 3}, {0, 3, 3, 3}, {3, 3, 4, 4}, {4, 4, 4, 5}, {4, 5, 3, 6}, {3, 6, 0, 6}},  // 5
      {{4, 2, 1, 2}, {1, 2, 0, 3}, {0, 3, 0, 5}, {0, 5, 1, 6}, {1, 6, 4, 6}},                              // c
      {{0, 6, 0, 2},
       {0, 2, 1.6f, 2},
       {1.6f, 2, 2, 3},
       {2, 3, 2, 6},
       {2, 3, 2.4f, 2},
       {2.4f, 2, 3.6f, 2},
       {3.6f, 2, 4, 3},
       {4, 3, 4, 6}},  // m
      {},              // space
  }};
  switch (letter) {
    case '1':
      return table[0];
    case '2':
      return table[1];
    case '5':
      return table[2];
    case 'c':
      return table[3];
    case 'm':
      return table[4];
    default:
      return table[5];
  }
}

void put(Image& image, int x, int y, const Rgb8& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy(color.begin(), color.end(), image.at(x, y));
}

void rectangle(Image& image, int x0, int y0, int x1, int y1, const Rgb8& color) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) put(image, x, y, color);
}

void write(Image& image, const std::string& text, float x, float y, float unit, const Rgb8& color) {
  const int half = std::max(1, static_cast<int>(0.35f * unit));
  for (const char letter : text) {
    for (const Stroke& s : strokes_of(letter)) {
      const float length = std::hypot(s.x1 - s.x0, s.y1 - s.y0) * unit;
      for (int k = 0; k <= static_cast<int>(length); ++k) {
        const float t = length > 0 ? static_cast<float>(k) / length : 0.0f;
        const int px = static_cast<int>(x + unit * (s.x0 + t * (s.x1 - s.x0)));
        const int py = static_cast<int>(y + unit * (s.y0 + t * (s.y1 - s.y0)));
        rectangle(image, px - half, py - half, px + half + 1, py + half + 1, color);
      }
    }
    x += 5.4f * unit;
  }
}

}  // namespace

int ruler_length_mm(double tablet_width_mm) {
  for (const int mm : {50, 20})
    if (tablet_width_mm >= mm) return mm;
  return 10;
}

Image draw_ruler(int mm, double dpi, const Rgb8& ground) {
  const double per_mm = dpi / 25.4;
  const int length = static_cast<int>(std::lround(mm * per_mm));
  const int bar = std::max(3, static_cast<int>(std::lround(1.5 * per_mm)));
  const auto unit = static_cast<float>(std::max(1.0, 0.5 * per_mm));
  Image image(length, bar + static_cast<int>(8 * unit), 3);
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
  write(image, std::to_string(mm / 10) + " cm", 0.5f * unit, static_cast<float>(bar) + 1.5f * unit, unit, ink);
  return image;
}

}  // namespace dubsar::app
