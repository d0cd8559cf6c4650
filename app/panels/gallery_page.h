#pragma once
// How what lies over the object in a gallery is set and drawn.

#include <string>
#include <vector>

#include "app/document/gallery_picture.h"

namespace dubsar::app {

/// Lines that stand beside the object, and how much larger a title is set than a sentence.
inline constexpr double kSentenceLines = 3.0, kTitleLines = 2.0, kTitleLarger = 1.1;

/// Size of the font whose capitals are `letter_mm` high; small panels have smaller ones, so that the object keeps its
/// place: `height` is the panel's. All in one unit, such as pixels, of which `per_mm` are a millimetre of the panel.
double letters_size(double letter_mm, double height, double per_mm) noexcept;

/// A sentence as it is set: no smaller than 16 minutes of arc where letters_size() has 20, in as many lines as it
/// takes.
struct SetWords {
  double size = 0.0;
  double wide = 0.0, tall = 0.0;     ///< of all lines
  std::vector<std::string> lines{};  ///< as they are seen
};
/// Within a frame of Dear ImGui. `size` as of letters_size().
SetWords set_words(const std::string& words, double size, double width, bool right_to_left = false);

/// Within a frame of Dear ImGui of `width` x `height` pixels, of which `px_per_mm` are a millimetre of the panel.
void draw_gallery(const GalleryPicture& picture, float width, float height, float px_per_mm);

}  // namespace dubsar::app
