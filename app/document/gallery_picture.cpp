#include "app/document/gallery_picture.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace dubsar::app {

double sign_radius(double aspect) noexcept { return std::min(0.095, 0.14 * aspect); }

std::vector<SignPicture> place_signs(std::span<const Sign> signs, double aspect) {
  std::vector<SignPicture> out;
  const double radius = sign_radius(aspect), margin = kSignMargin;
  const double x = 0.5 - (radius + margin) / aspect;
  // What takes a sign's place when it was chosen stands elsewhere: a hand that stays where it is chooses nothing more.
  constexpr std::array<int, kSignCount> kRow{0, 1, 2, 0, 2};
  for (const Sign sign : signs) {
    const int row = kRow[static_cast<std::size_t>(sign)];
    out.push_back({sign, {x, 0.5 - (radius + margin) - row * (2.0 * radius + margin)}, radius, 0.0});
  }
  return out;
}

std::vector<SignPicture> signs_on(std::span<const SignPicture> signs, double aspect) {
  std::vector<Sign> kinds;
  for (const SignPicture& sign : signs) kinds.push_back(sign.sign);
  std::vector<SignPicture> out = place_signs(kinds, aspect);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].filled = signs[i].filled;
  return out;
}

double letter_height_mm(double reading_distance_m) noexcept {
  constexpr double kArcMinutes = 20.0;
  return 1e3 * reading_distance_m * kArcMinutes / 60.0 * std::numbers::pi / 180.0;
}

}  // namespace dubsar::app
