#include "tests/display/reference_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"
#include "display/optics/srgb.h"

namespace dubsar::testing {
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

/// Colour 0..255 of channel k of a view at (u, v), v up: bilinear, clamped to the edge, as GL samples a texture.
double sample_channel(const Image& view, double u, double v, int channel) noexcept {
  return bilinear(view, u, v, [&](int x, int y) { return static_cast<double>(view.at(x, y)[channel]); });
}

/// The same in linear light, 0..1.
double sample_light(const Image& view, double u, double v, int channel) noexcept {
  const auto& light = linear_of_byte();
  return bilinear(view, u, v, [&](int x, int y) { return light[view.at(x, y)[channel]]; });
}

std::uint8_t to_byte(double value) noexcept {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}

}  // namespace

double row_light(const LensSheet& sheet, std::int64_t y) noexcept {
  const bool dimmed = (y % 2 == 0) == (sheet.fringe > 0.0);
  return dimmed ? 1.0 - std::abs(sheet.fringe) : 1.0;
}

std::vector<ViewWeight> view_weights(double position, int views, ViewFilter filter, double sigma) {
  const double exact = position * views;
  const int near = nearest_view(position, views);
  if (filter == ViewFilter::kNearest) return {{near, 1.0}};
  if (filter == ViewFilter::kLinear) {
    const int next = std::min(near + 1, views - 1);
    const double mix = std::clamp(exact - near, 0.0, 1.0);
    return {{near, 1.0 - mix}, {next, mix}};
  }
  const int reach = filter == ViewFilter::kGaussian3 ? 1 : 10;
  const double width = sigma * views;  // in views
  std::vector<ViewWeight> weights;
  double sum = 0.0;
  for (int view = std::max(0, near - reach); view <= std::min(views - 1, near + reach); ++view) {
    const double distance = (view - exact) / width;
    weights.push_back({view, std::exp(-0.5 * distance * distance)});
    sum += weights.back().weight;
  }
  if (sum <= 0.0) return {{near, 1.0}};
  for (ViewWeight& weight : weights) weight.weight /= sum;
  return weights;
}

int interlace_parity(InterlacePattern pattern, int panel_x, int panel_y, int channel) noexcept {
  switch (pattern) {
    case InterlacePattern::kRows:
      return panel_y & 1;
    case InterlacePattern::kColumns:
      return panel_x & 1;
    case InterlacePattern::kCheckerboard:
      return (panel_x + panel_y) & 1;
    case InterlacePattern::kSubpixels:
      return (3 * panel_x + channel) & 1;
  }
  return 0;
}

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

Image weave_tracked(const Image& left, const Image& right, const TrackedPanel& panel, const EyePair& eyes) {
  Image woven(panel.width_px, panel.height_px, 3);
  parallel_for(panel.height_px, 16, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    const double v = 1.0 - (y + 0.5) / panel.height_px;
    for (int x = 0; x < panel.width_px; ++x) {
      const double u = (x + 0.5) / panel.width_px;
      for (int channel = 0; channel < 3; ++channel) {
        const int eye = subpixel_eye(panel, eyes, subpixel_mm(panel, x, y, channel));
        woven.at(x, y)[channel] = to_byte(sample_channel(eye == 0 ? left : right, u, v, channel));
      }
    }
  });
  return woven;
}

Image anaglyph_views(const Image& left, const Image& right, const AnaglyphVariant& variant) {
  Image out(left.width, left.height, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const std::uint8_t *l = left.at(x, y), *r = right.at(x, y);
      const glm::dvec3 sum =
          variant.left * glm::dvec3(linear_from_srgb(l[0]), linear_from_srgb(l[1]), linear_from_srgb(l[2])) +
          variant.right * glm::dvec3(linear_from_srgb(r[0]), linear_from_srgb(r[1]), linear_from_srgb(r[2]));
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = srgb_from_linear(sum[c]);
    }
  return out;
}

Image interlace_views(const Image& left, const Image& right, const Screen& screen, InterlacePattern pattern,
                      bool right_first) {
  Image out(screen.window_w, screen.window_h, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const int parity = interlace_parity(pattern, screen.window_x + x, screen.window_y + y, k);
        out.at(x, y)[k] = ((parity == 1) != right_first ? right : left).at(x, y)[k];
      }
  return out;
}

Image pack_views(const Image& left, const Image& right, PixelSize window, const Packing& packing) {
  const PixelSize size = packing.output_size(window);
  Image out(size.width, size.height, 3);
  for (int eye = 0; eye < 2; ++eye) {
    const Image& view = eye == 0 ? left : right;
    const PixelSize corner = packing.place(window, eye);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) std::copy_n(view.at(x, y), 3, out.at(corner.width + x, corner.height + y));
  }
  return out;
}

Image make_quilt(std::span<const Image> views, const QuiltLayout& layout) {
  DUBSAR_CHECK(static_cast<int>(views.size()) == layout.views());
  Image out(layout.width_px, layout.height_px, 3);
  for (int i = 0; i < layout.views(); ++i) {
    DUBSAR_CHECK(views[i].width == layout.tile_width() && views[i].height == layout.tile_height());
    const PixelSize corner = quilt_tile_corner(layout, i);
    const int top = layout.height_px - corner.height - layout.tile_height();
    for (int y = 0; y < views[i].height; ++y)
      for (int x = 0; x < views[i].width; ++x) std::copy_n(views[i].at(x, y), 3, out.at(corner.width + x, top + y));
  }
  return out;
}

}  // namespace dubsar::testing
