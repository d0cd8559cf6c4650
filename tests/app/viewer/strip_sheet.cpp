#include "tests/app/viewer/strip_sheet.h"

#include <algorithm>

namespace dubsar::testing {
namespace {

constexpr int kGap = 6;
constexpr std::uint8_t kPaper = 255;

}  // namespace

Image scaled(const Image& image, int width, int height) {
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = x * image.width / width, x1 = std::max(x0 + 1, (x + 1) * image.width / width);
      const int y0 = y * image.height / height, y1 = std::max(y0 + 1, (y + 1) * image.height / height);
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) sum += image.at(u, v)[c];
        const int mean = sum / ((x1 - x0) * (y1 - y0));
        out.at(x, y)[c] = static_cast<std::uint8_t>(std::min(255, (mean + 4) / 8 * 8));
      }
    }
  return out;
}

Image sheet(const std::vector<std::vector<Image>>& rows) {
  int width = 0, height = kGap;
  for (const auto& row : rows) {
    int across = kGap;
    for (const Image& image : row) across += image.width + kGap;
    width = std::max(width, across);
    height += row.front().height + kGap;
  }
  Image out(width, height, 3);
  std::fill(out.pixels.begin(), out.pixels.end(), kPaper);
  int top = kGap;
  for (const auto& row : rows) {
    int left = kGap;
    for (const Image& image : row) {
      for (int y = 0; y < image.height; ++y) std::copy_n(image.at(0, y), 3 * image.width, out.at(left, top + y));
      left += image.width + kGap;
    }
    top += row.front().height + kGap;
  }
  return out;
}

}  // namespace dubsar::testing
