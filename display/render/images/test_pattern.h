#pragma once
// Numbered views: each view carries its number and a colour of its own, so that what an eye sees tells which view
// reaches it. The aid for adjusting pitch, slope and centre of a lens sheet, and for finding swapped eyes.

#include "core/image_io/image.h"
#include "display/render/shading.h"

namespace dubsar {

/// Colour of view `index` of `count`: hue goes once round, so that neighbours differ and 0 is red.
Rgb8 pattern_color(int index, int count);

/// RGBA. A ground in the view's colour at half brightness, a white frame, a white line down the middle (straight on a
/// panel that is adjusted), and the view's number in the middle and, smaller, in the corners.
Image numbered_view(int width, int height, int index, int count);

}  // namespace dubsar
