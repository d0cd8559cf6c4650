#pragma once
// The page of help as columns: all of it at once where it fits, else scrolled.

#include <cstddef>
#include <vector>

#include "app/panels/help_page.h"

namespace dubsar::app {

struct HelpColumns {
  float scale = 0.45f;  ///< of letters 13 pixels of the layout high
  float column_width = 0.0f;
  std::size_t second = 0;              ///< glyphs before the second word of a row
  std::vector<std::size_t> starts{0};  ///< first section of each column
  bool fits = false;                   ///< all of it is on the page
};

/// On a page of so many pixels of the layout: the largest letters with which all fits, but none below `least` (0: as
/// small as can be read). What does not fit with those goes on below the page, in as many columns as there is width
/// for.
HelpColumns arrange_help(const std::vector<HelpSection>& help, float width, float height, float least);

/// What of the page is seen. One thread.
struct HelpScroll {
  float at = 0.0f;  ///< pixels of the layout from the top
  float most = 0.0f;
  float page = 0.0f;  ///< one page down is so much
  void by(float pixels) noexcept;
};

/// Into the frame that Dear ImGui is at.
void draw_help(const std::vector<HelpSection>& help, float width, float height, float least, HelpScroll& scroll);

}  // namespace dubsar::app
