#include "display/optics/optics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"
#include "display/optics/srgb.h"

namespace dubsar {
namespace {

/// Second antiderivative of a Gaussian of width sigma: x Phi(x / sigma) + sigma phi(x / sigma).
double ramp(double x, double sigma) noexcept {
  if (sigma <= 0.0) return std::max(0.0, x);
  const double t = x / sigma;
  const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * std::numbers::pi);
  const double distribution = 0.5 * std::erfc(-t / std::numbers::sqrt2);
  return x * distribution + sigma * density;
}

/// Two boxes of widths a and b (area 1 each) and a Gaussian, convolved, at x.
double spot(double x, double a, double b, double sigma) noexcept {
  const double sum = 0.5 * (a + b), difference = 0.5 * (a - b);
  return (ramp(x + sum, sigma) - ramp(x + difference, sigma) - ramp(x - difference, sigma) + ramp(x - sum, sigma)) /
         (a * b);
}

}  // namespace

double visibility(const LensOptics& lens, double phase) noexcept {
  constexpr double kLeastWidth = 1e-4;  // keeps the quotient of spot() well conditioned for upright lenses
  const double width = std::max(kLeastWidth, lens.pixel_mm.x / 3.0 / lens.pitch_mm);
  const double height = std::max(kLeastWidth, lens.pixel_mm.y * std::abs(lens.tan_slant) / lens.pitch_mm);
  double sum = 0.0;
  for (const double turn : {-1.0, 0.0, 1.0}) sum += spot(phase + turn, width, height, lens.spot_sigma_periods);
  return sum * std::max(width, height);
}

Image see(const Image& panel_image, const TrackedPanel& panel, const glm::dvec3& eye_mm) {
  DUBSAR_CHECK(panel_image.width == panel.width_px && panel_image.height == panel.height_px);
  const int reach = std::max(1, static_cast<int>(std::ceil(panel.lens.pitch_mm / panel.lens.pixel_mm.x)));
  Image seen(panel_image.width, panel_image.height, 3);
  const auto& linear = linear_of_byte();
  parallel_for(panel_image.height, 4, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    std::vector<double> light(static_cast<std::size_t>(panel_image.width));
    for (int channel = 0; channel < 3; ++channel) {
      for (int x = 0; x < panel_image.width; ++x)
        light[static_cast<std::size_t>(x)] =
            visibility(panel.lens, eye_phase(panel.lens, eye_mm, subpixel_mm(panel, x, y, channel)));
      for (int x = 0; x < panel_image.width; ++x) {
        double sum = 0.0, total = 0.0;
        for (int c = std::max(0, x - reach); c <= std::min(panel_image.width - 1, x + reach); ++c) {
          sum += light[static_cast<std::size_t>(c)] * linear[panel_image.at(c, y)[channel]];
          total += light[static_cast<std::size_t>(c)];
        }
        seen.at(x, y)[channel] = srgb_from_linear(total > 0.0 ? sum / total : 0.0);
      }
    }
  });
  return seen;
}

Crosstalk wrong_eye_light(const TrackedPanel& panel, const EyePair& woven_for, const EyePair& true_eyes,
                          bool exact_weave, int step_px) {
  // Whole lens periods are visited around each grid point, else the sample would favour some phases.
  const int run = 4 * std::max(1, static_cast<int>(std::ceil(panel.lens.pitch_mm / panel.lens.pixel_mm.x)));
  struct Light {
    std::array<double, 2> wrong{}, total{};
  };
  const auto of_rows = [&](std::int64_t begin, std::int64_t end) {
    Light out;
    for (std::int64_t row = begin; row < end; ++row) {
      const int y = step_px / 2 + static_cast<int>(row) * step_px;
      for (int x0 = step_px / 2; x0 < panel.width_px; x0 += std::max(step_px, run))
        for (int x = x0; x < std::min(panel.width_px, x0 + run); ++x)
          for (int channel = 0; channel < 3; ++channel) {
            const glm::dvec2 point = subpixel_mm(panel, x, y, channel);
            const int shown = subpixel_eye(panel, woven_for, point, exact_weave);
            for (int eye = 0; eye < 2; ++eye) {
              const glm::dvec3& place = eye == 0 ? true_eyes.left_mm : true_eyes.right_mm;
              const double light = visibility(panel.lens, eye_phase(panel.lens, place, point));
              out.total[static_cast<std::size_t>(eye)] += light;
              if (shown != eye) out.wrong[static_cast<std::size_t>(eye)] += light;
            }
          }
    }
    return out;
  };
  const auto add = [](Light a, const Light& b) {
    for (std::size_t eye = 0; eye < 2; ++eye) a.wrong[eye] += b.wrong[eye], a.total[eye] += b.total[eye];
    return a;
  };
  const std::int64_t rows = std::max(0, (panel.height_px - step_px / 2 + step_px - 1) / step_px);
  const Light sum = parallel_reduce(rows, 4, Light{}, of_rows, add);
  return {sum.total[0] > 0.0 ? sum.wrong[0] / sum.total[0] : 0.0,
          sum.total[1] > 0.0 ? sum.wrong[1] / sum.total[1] : 0.0};
}

std::vector<double> view_shares(const LensSheet& sheet, const TrackedPanel& panel, int views, const glm::dvec3& eye_mm,
                                int step_px) {
  std::vector<double> shares(static_cast<std::size_t>(views), 0.0);
  double total = 0.0;
  for (int y = step_px / 2; y < panel.height_px; y += step_px)
    for (int x = 0; x < panel.width_px; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const double light = visibility(panel.lens, eye_phase(panel.lens, eye_mm, subpixel_mm(panel, x, y, channel)));
        const int view = nearest_view(subpixel_view(sheet, views, x, y, channel) / views, views);
        shares[static_cast<std::size_t>(view)] += light;
        total += light;
      }
  for (double& share : shares) share /= total;
  return shares;
}

EyeLight light_at(const PanelLight& light, const glm::dvec3& eye_mm, int step_px) {
  EyeLight out;
  if (light.sheet) {
    out.shares = view_shares(*light.sheet, light.panel, light.views, eye_mm, step_px);
  } else {
    const Crosstalk wrong = wrong_eye_light(light.panel, light.woven_for, {eye_mm, eye_mm}, true, step_px);
    out.shares = {1.0 - wrong.left, wrong.left};
  }
  out.main_view = static_cast<int>(std::max_element(out.shares.begin(), out.shares.end()) - out.shares.begin());
  for (int view = 0; view < light.views; ++view)
    if (std::abs(view - out.main_view) > light.own_views) out.crosstalk += out.shares[static_cast<std::size_t>(view)];
  return out;
}

TrackedPanel optics_of_sheet(const LensSheet& sheet, double width_mm, double view_cone_rad, double distance_mm,
                             double refractive_index, double spot_sigma_periods) {
  TrackedPanel panel;
  panel.width_px = sheet.width_px;
  panel.height_px = sheet.height_px;
  panel.subpixels = sheet.subpixels;
  LensOptics& lens = panel.lens;
  lens.pixel_mm = glm::dvec2(width_mm / sheet.width_px);
  lens.refractive_index = refractive_index;
  lens.spot_sigma_periods = spot_sigma_periods;
  const double pattern_pitch_mm = width_mm / sheet.periods;
  // Half a period of shift at half the cone, by exact refraction.
  const double tangent = std::tan(0.5 * view_cone_rad);
  const double n = refractive_index;
  lens.reduced_gap_mm = 0.5 * pattern_pitch_mm * std::sqrt(1.0 + (1.0 - 1.0 / (n * n)) * tangent * tangent) / tangent;
  lens.pitch_mm = pattern_pitch_mm * (1.0 - lens.reduced_gap_mm / distance_mm);
  lens.tan_slant = sheet.tilt * sheet.width_px / sheet.height_px;
  const double phase_at_centre = 0.5 * (1.0 + sheet.tilt) * sheet.periods - sheet.centre;
  lens.phase0 = 0.5 - phase_at_centre;
  return panel;
}

}  // namespace dubsar
