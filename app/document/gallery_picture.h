#pragma once
// What lies over the object in a gallery: one line at reading distance, a hand that shows what can be done, buttons to
// rest a hand on, where one is in a tour, the operator's menu. Plain values, between who leads and who draws.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dubsar::app {

/// Things a visitor may learn, in the order in which they are taught.
enum class Tutorial : std::uint8_t { kShowHand, kGrab, kTurn, kRest, kTwoHands, kSwipe };
inline constexpr std::size_t kTutorialCount = 6;

enum class DwellButton : std::uint8_t { kOpen, kClose, kTour, kNext, kLeave };
inline constexpr std::size_t kDwellButtonCount = 5;

/// Places are shares of the panel's width and height, from its middle, to the right and up; the radius is a share of
/// its height.
struct DwellButtonPicture {
  DwellButton button{};
  glm::dvec2 at{0.0};
  double radius = 0.09;
  double filled = 0.0;  ///< 0..1: how much of the rest is over
  friend bool operator==(const DwellButtonPicture&, const DwellButtonPicture&) = default;
};

/// Of a button on a panel that is `aspect` times as wide as high, and what is left free around it: shares of the
/// panel's height.
double dwell_button_radius(double aspect) noexcept;
inline constexpr double kDwellButtonMargin = 0.035;

/// The places of some buttons on a panel that is `aspect` times as wide as high: a column at the upper right, where
/// hands that play with the object rarely rest; on upright panels a row from there.
std::vector<DwellButtonPicture> place_buttons(std::span<const DwellButton> buttons, double aspect);

/// What is left free around the object, for words (app/panels/gallery_page.h), buttons and tutorials.
struct GalleryRoom {
  double words = 0.2;  ///< of the panel's height, above and below
  double sides = 0.0;  ///< of its width, left and right
};
/// Of a panel that is `aspect` times as wide as high. Upright panels have buttons in a row above the object and all
/// words below it; others have buttons and tutorials at its sides.
GalleryRoom gallery_room(double aspect) noexcept;
inline bool upright_panel(double aspect) noexcept { return aspect < 1.0; }

/// The same buttons on a panel of another shape, as full as they are.
std::vector<DwellButtonPicture> buttons_on(std::span<const DwellButtonPicture> buttons, double aspect);

struct GalleryPicture {
  bool blank = false;               ///< all is left room for, nothing is drawn there
  std::string line;                 ///< one sentence; empty: none
  bool right_to_left = false;       ///< how it is set
  std::string title;                ///< of what is shown now; may be empty
  std::size_t step = 0, steps = 0;  ///< of a tour, counted from 1; 0: there is none
  std::optional<Tutorial> tutorial;
  double tutorial_s = 0.0;                  ///< how far its moving hand is
  double letter_mm = 8.0;                   ///< height of the letters on the panel
  double dark = 0.0;                        ///< 0..1: how much of the light is taken away
  std::vector<DwellButtonPicture> buttons;  ///< that hands may rest on
  std::vector<std::string> menu;            ///< rows of the operator's page; empty: closed
  friend bool operator==(const GalleryPicture&, const GalleryPicture&) = default;
};

/// Height of letters that are read with ease from a distance: 20 minutes of arc for a capital (ISO 9241-303:
/// 16 at least, 20 to 22 preferred).
double letter_height_mm(double reading_distance_m) noexcept;

}  // namespace dubsar::app
