#pragma once
// What lies over the object in a gallery: one line at reading distance, a hand that shows what can be done, signs to
// rest a hand on, where one is in a tour, the operator's menu.

#include <optional>
#include <string>
#include <vector>

#include "app/kiosk/signs.h"
#include "app/kiosk/visit.h"

namespace dubsar::app {

struct GalleryPicture {
  std::string line;                 ///< one sentence; empty: none
  bool right_to_left = false;       ///< how it is set
  std::string title;                ///< of what is shown now; may be empty
  std::size_t step = 0, steps = 0;  ///< of a tour, counted from 1; 0: there is none
  std::optional<Lesson> lesson;
  double lesson_s = 0.0;           ///< how far its moving hand is
  double letter_mm = 8.0;          ///< height of the letters on the panel
  double dark = 0.0;               ///< 0..1: how much of the light is taken away
  std::vector<SignPicture> signs;  ///< that hands may rest on
  std::vector<std::string> menu;   ///< rows of the operator's menu; empty: closed
  friend bool operator==(const GalleryPicture&, const GalleryPicture&) = default;
};

/// Height of letters that are read with ease from a distance: 20 minutes of arc for a capital (ISO 9241-303:
/// 16 at least, 20 to 22 preferred).
double letter_height_mm(double reading_distance_m) noexcept;

/// Size of the font whose capitals are `letter_mm` high; small panels have smaller ones, so that the object keeps its
/// place: `height` is the panel's. All in one unit, such as pixels, of which `per_mm` are a millimetre of the panel.
double letters_size(double letter_mm, double height, double per_mm) noexcept;

/// A sentence as it is set: no smaller than 16 minutes of arc where letters_size() has 20, in as many lines as it
/// takes.
struct SetWords {
  double size = 0.0;
  double wide = 0.0, tall = 0.0;     ///< of all lines
  std::vector<std::string> lines{};  ///< as they are seen, of texts with letters from right to left; else none
};
/// Within a frame of Dear ImGui. `size` as of letters_size().
SetWords set_words(const std::string& words, double size, double width, bool right_to_left = false);

/// Within a frame of Dear ImGui of `width` x `height` pixels, of which `px_per_mm` are a millimetre of the panel.
void draw_gallery(const GalleryPicture& picture, float width, float height, float px_per_mm);

}  // namespace dubsar::app
