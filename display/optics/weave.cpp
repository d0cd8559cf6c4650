#include "display/optics/weave.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "display/optics/srgb.h"

namespace dubsar {

namespace {

/// Bilinear mean of value(x, y) around (u, v), v up, clamped to the edge.
template <class Value>
double bilinear(const Image& view, double u, double v, const Value& value) noexcept {
  const double x = u * view.width - 0.5;
  const double y = (1.0 - v) * view.height - 0.5;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const auto column = [&](double c) { return std::clamp(static_cast<int>(c), 0, view.width - 1); };
  const auto row = [&](double r) { return std::clamp(static_cast<int>(r), 0, view.height - 1); };
  const int x0 = column(std::floor(x)), x1 = column(std::floor(x) + 1.0);
  const int y0 = row(std::floor(y)), y1 = row(std::floor(y) + 1.0);
  return (1.0 - fy) * ((1.0 - fx) * value(x0, y0) + fx * value(x1, y0)) +
         fy * ((1.0 - fx) * value(x0, y1) + fx * value(x1, y1));
}

}  // namespace

double sample_channel(const Image& view, double u, double v, int channel) noexcept {
  return bilinear(view, u, v, [&](int x, int y) { return static_cast<double>(view.at(x, y)[channel]); });
}

double sample_light(const Image& view, double u, double v, int channel) noexcept {
  const auto& light = linear_of_byte();
  return bilinear(view, u, v, [&](int x, int y) { return light[view.at(x, y)[channel]]; });
}

double subpixel_view(const LensSheet& sheet, int views, int column, int row_from_top, int channel) noexcept {
  return lens_position(sheet, column, sheet.height_px - 1 - row_from_top, channel) * views;
}

namespace {
std::uint8_t to_byte(double value) noexcept {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}
}  // namespace

Image weave_views(std::span<const Image> views, const LensSheet& sheet, const WeaveOptions& options) {
  DUBSAR_CHECK(!views.empty() && sheet.width_px > 0 && sheet.height_px > 0);
  const int count = static_cast<int>(views.size());
  Image panel(sheet.width_px, sheet.height_px, 3);
  parallel_for(sheet.height_px, 16, [&](std::int64_t row) {
    const double v = 1.0 - (static_cast<double>(row) + 0.5) / sheet.height_px;
    const double dimmed = row_light(sheet, sheet.height_px - 1 - row);
    for (int column = 0; column < sheet.width_px; ++column) {
      const double u = (column + 0.5) / sheet.width_px;
      for (int channel = 0; channel < 3; ++channel) {
        const double position = lens_position(sheet, column, sheet.height_px - 1 - row, channel);
        double sum = 0.0;
        for (const auto& [view, weight] : view_weights(position, count, options.filter, options.gaussian_sigma))
          sum += weight * sample_light(views[static_cast<std::size_t>(view)], u, v, channel);
        panel.at(column, static_cast<int>(row))[channel] = to_byte(255.0 * dimmed * coded_from_linear(sum));
      }
    }
  });
  return panel;
}

glm::dvec2 subpixel_mm(const TrackedPanel& panel, int column, int row_from_top, int channel) noexcept {
  const glm::dvec2 offset = panel.subpixels.offset_px(column, panel.height_px - 1 - row_from_top, channel);
  return {(column + 0.5 + offset.x - 0.5 * panel.width_px) * panel.lens.pixel_mm.x,
          (0.5 * panel.height_px - row_from_top - 0.5 + offset.y) * panel.lens.pixel_mm.y};
}

int subpixel_eye(const TrackedPanel& panel, const EyePair& eyes, const glm::dvec2& point_mm, bool exact) noexcept {
  const double left = std::abs(eye_phase(panel.lens, eyes.left_mm, point_mm, exact));
  const double right = std::abs(eye_phase(panel.lens, eyes.right_mm, point_mm, exact));
  return right < left ? 1 : 0;
}

Image weave_tracked(const Image& left, const Image& right, const TrackedPanel& panel, const EyePair& eyes, bool exact) {
  Image woven(panel.width_px, panel.height_px, 3);
  parallel_for(panel.height_px, 16, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    const double v = 1.0 - (y + 0.5) / panel.height_px;
    for (int x = 0; x < panel.width_px; ++x) {
      const double u = (x + 0.5) / panel.width_px;
      for (int channel = 0; channel < 3; ++channel) {
        const int eye = subpixel_eye(panel, eyes, subpixel_mm(panel, x, y, channel), exact);
        woven.at(x, y)[channel] = to_byte(sample_channel(eye == 0 ? left : right, u, v, channel));
      }
    }
  });
  return woven;
}

}  // namespace dubsar
