#include "app/kiosk/dwell_buttons.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace dubsar::app {
namespace {

constexpr TimestampNs kBegins = 250'000'000;    // a hand that passes fills nothing
constexpr TimestampNs kFills = 2'000'000'000;   // a hand that ends there by chance has mostly left by then
constexpr TimestampNs kForgives = 300'000'000;  // a tremble over the edge, or a hand that is lost for a moment
constexpr TimestampNs kSignGone = 1'000'000'000;
constexpr double kEdge = 1.25;  // of the radius, for a hand that is on the button already

/// In the column of buttons, or in their row, whether or not one is shown there now.
bool in_their_column(const glm::dvec2& at, double aspect) {
  if (upright_panel(aspect)) return at.y > 0.5 - (kEdge * 2.0 * dwell_button_radius(aspect) + kDwellButtonMargin);
  return at.x > 0.5 - (kEdge * 2.0 * dwell_button_radius(aspect) + kDwellButtonMargin) / aspect;
}

}  // namespace

std::optional<DwellButton> button_at(const glm::dvec2& at, std::span<const DwellButtonPicture> buttons, double aspect) {
  for (const DwellButtonPicture& button : buttons) {
    const glm::dvec2 apart = at - button.at;
    if (glm::length(glm::dvec2(apart.x * aspect, apart.y)) <= button.radius) return button.button;
  }
  return std::nullopt;
}

double DwellTimer::filled(DwellButton button) const noexcept { return rests_[static_cast<std::size_t>(button)].filled; }

std::optional<DwellButton> DwellTimer::update(TimestampNs now, std::span<const DwellHand> hands,
                                              std::span<const DwellButtonPicture> buttons, double aspect) {
  std::optional<DwellButton> chosen;
  std::array<bool, kDwellButtonCount> there{};
  const bool any =
      std::any_of(hands.begin(), hands.end(), [&](const DwellHand& hand) { return in_their_column(hand.at, aspect); });
  for (const DwellButtonPicture& button : buttons) {
    Rest& rest = rests_[static_cast<std::size_t>(button.button)];
    there[static_cast<std::size_t>(button.button)] = true;
    const double radius = button.radius * (rest.since >= 0 ? kEdge : 1.0);
    bool on = false;
    for (const DwellHand& hand : hands) {
      const glm::dvec2 apart = hand.at - button.at;
      const double far = glm::length(glm::dvec2(apart.x * aspect, apart.y));
      if (far > kEdge * button.radius) continue;
      if (!hand.free) waits_ = true;
      on = on || far <= radius;
    }
    if (waits_ || (!on && rest.since >= 0 && now - rest.seen > kForgives)) {
      rest = {};
    } else if (on) {
      rest.seen = now;
      if (rest.since < 0) rest.since = now;
    }
    if (rest.since < 0) continue;
    rest.filled =
        std::clamp(static_cast<double>(rest.seen - rest.since - kBegins) / static_cast<double>(kFills), 0.0, 1.0);
    if (rest.filled < 1.0 || chosen) continue;
    chosen = button.button;
  }
  for (std::size_t s = 0; s < kDwellButtonCount; ++s)
    if (!there[s] || chosen) rests_[s] = {};
  if (!hands.empty()) hands_seen_ = now;
  const bool left = hands.empty() ? now - hands_seen_ > kSignGone : !any;
  waits_ = chosen.has_value() || (waits_ && !left);
  return chosen;
}

}  // namespace dubsar::app
