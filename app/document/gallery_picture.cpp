#include "app/document/gallery_picture.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace dubsar::app {

// Three of them in a row fit an upright panel.
double dwell_button_radius(double aspect) noexcept {
  return std::min(0.095, (upright_panel(aspect) ? 0.125 : 0.14) * aspect);
}

GalleryRoom gallery_room(double aspect) noexcept {
  constexpr double kWordsBelow = 0.3;  // a title, a tutorial or both above a sentence
  if (upright_panel(aspect)) return {.words = kWordsBelow};
  return {.sides = (2.0 * dwell_button_radius(aspect) + 2.0 * kDwellButtonMargin) / aspect};
}

std::vector<DwellButtonPicture> place_buttons(std::span<const DwellButton> buttons, double aspect) {
  std::vector<DwellButtonPicture> out;
  const double radius = dwell_button_radius(aspect), margin = kDwellButtonMargin;
  const double x = 0.5 - (radius + margin) / aspect;
  // What takes a button's place when it was chosen stands elsewhere: a hand that stays where it is chooses nothing
  // more.
  constexpr std::array<int, kDwellButtonCount> kRow{0, 1, 2, 0, 2};
  for (const DwellButton button : buttons) {
    const int row = kRow[static_cast<std::size_t>(button)];
    const double first = 0.5 - (radius + margin), along = row * (2.0 * radius + margin);
    const glm::dvec2 at = upright_panel(aspect) ? glm::dvec2(x - along / aspect, first) : glm::dvec2(x, first - along);
    out.push_back({button, at, radius, 0.0});
  }
  return out;
}

std::vector<DwellButtonPicture> buttons_on(std::span<const DwellButtonPicture> buttons, double aspect) {
  std::vector<DwellButton> kinds;
  for (const DwellButtonPicture& button : buttons) kinds.push_back(button.button);
  std::vector<DwellButtonPicture> out = place_buttons(kinds, aspect);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].filled = buttons[i].filled;
  return out;
}

double letter_height_mm(double reading_distance_m) noexcept {
  constexpr double kArcMinutes = 20.0;
  return 1e3 * reading_distance_m * kArcMinutes / 60.0 * std::numbers::pi / 180.0;
}

}  // namespace dubsar::app
