#include "input/tracking/vision/picture_crop.h"

#include <algorithm>
#include <cmath>

#include "core/base/result.h"

namespace dubsar {
namespace {

/// Mean of factor x factor pixels; a border that does not fill a block is left out.
void reduce(const PictureView& from, int x0, int y0, int width, int height, int factor, std::vector<std::uint8_t>& to) {
  to.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const unsigned area = static_cast<unsigned>(factor * factor);
  const unsigned inverse = (1u << 20) / area;  // sums are below 2^12 for factors up to 16: no overflow
  std::uint8_t* out = to.data();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, out += 3) {
      unsigned red = 0, green = 0, blue = 0;
      for (int dy = 0; dy < factor; ++dy) {
        const std::uint8_t* pixel =
            from.rgb + (static_cast<std::size_t>(y0 + y * factor + dy) * static_cast<std::size_t>(from.width) +
                        static_cast<std::size_t>(x0 + x * factor)) *
                           3;
        for (int dx = 0; dx < factor; ++dx, pixel += 3) {
          red += pixel[0];
          green += pixel[1];
          blue += pixel[2];
        }
      }
      const auto mean = [&](unsigned sum) {
        return static_cast<std::uint8_t>((std::uint64_t{sum} * inverse + (1u << 19)) >> 20);
      };
      out[0] = mean(red);
      out[1] = mean(green);
      out[2] = mean(blue);
    }
}

}  // namespace

glm::dvec2 SquareCrop::to_picture(const glm::dvec2& unit) const noexcept {
  const glm::dvec2 from_centre = (unit - 0.5) * side_px;
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return centre_px + glm::dvec2(c * from_centre.x - s * from_centre.y, s * from_centre.x + c * from_centre.y);
}

void PictureSampler::sample(const PictureView& picture, const SquareCrop& crop, int size, float scale, float offset,
                            std::span<float> planes) {
  const std::size_t plane = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  DUBSAR_CHECK(planes.size() == 3 * plane && picture.width > 0 && picture.height > 0);
  std::fill(planes.begin(), planes.end(), offset);
  if (!(crop.side_px > 0.0) || !(crop.side_px < 1e6) || !(std::abs(crop.centre_px.x) < 1e6) ||
      !(std::abs(crop.centre_px.y) < 1e6))
    return;

  // the part of the picture that the square touches
  const int factor = std::clamp(static_cast<int>(crop.side_px / size + 0.25), 1, 16);
  const double reach =
      0.5 * crop.side_px * (std::abs(std::cos(crop.turn_rad)) + std::abs(std::sin(crop.turn_rad))) + 2.0 * factor;
  const int x0 = std::max(0, static_cast<int>(std::floor(crop.centre_px.x - reach)));
  const int y0 = std::max(0, static_cast<int>(std::floor(crop.centre_px.y - reach)));
  const int x1 = std::min(picture.width, static_cast<int>(std::ceil(crop.centre_px.x + reach)));
  const int y1 = std::min(picture.height, static_cast<int>(std::ceil(crop.centre_px.y + reach)));
  if (x1 - x0 < factor || y1 - y0 < factor) return;
  PictureView from = picture;
  glm::dvec2 origin(0.0);
  if (factor > 1) {
    const int width = (x1 - x0) / factor, height = (y1 - y0) / factor;
    reduce(picture, x0, y0, width, height, factor, reduced_);
    from = {reduced_.data(), width, height};
    origin = {x0, y0};
  }

  const glm::dvec2 start = (crop.to_picture({0.5 / size, 0.5 / size}) - origin) / static_cast<double>(factor) - 0.5;
  const double step = crop.side_px / (size * factor);
  const glm::dvec2 along(step * std::cos(crop.turn_rad), step * std::sin(crop.turn_rad)), down(-along.y, along.x);
  const std::size_t stride = static_cast<std::size_t>(from.width) * 3;
  const std::uint8_t black[3] = {0, 0, 0};
  const auto pixel = [&](int x, int y) {
    return x >= 0 && x < from.width && y >= 0 && y < from.height
               ? from.rgb + static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x) * 3
               : black;
  };
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double x = start.x + column * along.x + row * down.x, y = start.y + column * along.y + row * down.y;
      if (x <= -1.0 || y <= -1.0 || x >= from.width || y >= from.height) continue;
      const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
      const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
      const std::uint8_t *a = pixel(left, top), *b = pixel(left + 1, top), *c = pixel(left, top + 1),
                         *d = pixel(left + 1, top + 1);
      float* out = planes.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                   static_cast<std::size_t>(column);
      for (int channel = 0; channel < 3; ++channel, out += plane) {
        const float upper = static_cast<float>(a[channel]) + u * static_cast<float>(b[channel] - a[channel]);
        const float lower = static_cast<float>(c[channel]) + u * static_cast<float>(d[channel] - c[channel]);
        *out = scale * (upper + v * (lower - upper)) + offset;
      }
    }
}

}  // namespace dubsar
