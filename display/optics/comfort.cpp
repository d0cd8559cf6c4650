#include "display/optics/comfort.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kNearestMm = 1.0;

/// How far away two eyes converge by this angle.
double converge_mm(double apart_mm, double angle_rad) {
  return angle_rad > 0 ? apart_mm / (2.0 * std::tan(0.5 * angle_rad)) : std::numeric_limits<double>::infinity();
}

double angle_rad(double apart_mm, double away_mm) { return 2.0 * std::atan2(0.5 * apart_mm, away_mm); }

}  // namespace

double parallax_deg(const EyesBefore& eyes, double z_mm) noexcept {
  return kDegPerRad * (angle_rad(eyes.apart_mm, eyes.distance_mm - z_mm) - angle_rad(eyes.apart_mm, eyes.distance_mm));
}

EasyDepths easy_depth(const EyesBefore& eyes, double most_deg) noexcept {
  const double most = most_deg / kDegPerRad, panel = angle_rad(eyes.apart_mm, eyes.distance_mm);
  return {eyes.distance_mm - converge_mm(eyes.apart_mm, panel + most),
          eyes.distance_mm - converge_mm(eyes.apart_mm, panel - most)};
}

EyesBefore eyes_before(std::span<const View> views, double apart_mm) noexcept {
  EyesBefore out{std::numeric_limits<double>::infinity(), views.size() > 2 ? apart_mm : 0.0};
  const auto eye = [](const View& view) { return glm::dvec3(glm::inverse(view.view_from_world)[3]); };
  for (const View& view : views) out.distance_mm = std::min(out.distance_mm, std::max(eye(view).z, kNearestMm));
  if (views.size() == 2) out.apart_mm = glm::distance(eye(views[0]), eye(views[1]));
  return out;
}

double easy_depth_factor(const EyesBefore& eyes, double front_mm, double back_mm, double most_deg) noexcept {
  if (!(eyes.apart_mm > 0) || !std::isfinite(eyes.distance_mm)) return 1.0;
  const EasyDepths easy = easy_depth(eyes, most_deg);
  double factor = 1.0;
  if (front_mm > easy.front_mm) factor = std::min(factor, easy.front_mm / front_mm);
  if (back_mm < easy.back_mm) factor = std::min(factor, easy.back_mm / back_mm);
  return factor;
}

}  // namespace dubsar
