#pragma once
// Pictures that hold views already: quilts, side-by-side and top-bottom pictures, and plain ones; and how they are put
// into the layers that a display composes.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

class ViewArray;

struct PictureLayout {
  enum class Kind { kPlain, kSideBySide, kTopBottom, kQuilt, kSeparate };
  Kind kind = Kind::kPlain;
  bool half = false;          ///< pairs: each view is squeezed to half, so that both fill one picture of their shape
  bool right_first = false;   ///< pairs: the right eye's view is at the left or on top
  int columns = 1, rows = 1;  ///< kQuilt; kSeparate: columns pictures of one file, leftmost first
  std::optional<double> aspect{};  ///< kQuilt: of what is seen, width / height; none: that of a tile
  friend bool operator==(const PictureLayout&, const PictureLayout&) = default;

  int views() const noexcept {
    return kind == Kind::kPlain ? 1 : kind == Kind::kSideBySide || kind == Kind::kTopBottom ? 2 : columns * rows;
  }
};

/// What a file's name says before its extension, in any case and order, with '_', '-', '.' or blanks between:
/// qs8x6a0.75 (a quilt), sbs or lr, rl (right first), tb or ou, bt (right first), half; hsbs, htb, hou are halves.
/// Files called .jps or .pns are pairs side by side, right first (cross-eyed), as that format has them. kPlain when it
/// says nothing.
PictureLayout layout_of_name(std::string_view file_name);

/// The same from an option's text: "plain", or the words above with ',' between, such as "sbs,half" or "qs8x6a0.75".
/// kUsage for other words.
Result<PictureLayout> parse_picture_layout(std::string_view text);

/// Views of one size, leftmost camera first.
struct ViewPictures {
  std::vector<Image> views;  ///< 1: plain, 2: left and right, more: a quilt's
  double aspect = 1.0;       ///< of what is to be seen, width / height
  double cone_deg = 40.0;    ///< of more than two: the angle over all views
};

/// Cuts a picture up. kBadData when its size cannot hold the layout's views of 8 x 8 pixels at least.
Result<ViewPictures> split_picture(const Image& picture, const PictureLayout& layout);

/// Which picture a display's layer gets. A display of two views gets those of many that the viewer's eyes would see
/// from where they are; one of many gets a pair's left picture in the layers left of the middle; one of as many gets
/// each its own. Exchanged where viewer.swap_eyes says so and the display has two views.
int picture_for_layer(const ViewPictures& pictures, const SinkTraits& traits, int layer, const Observer& viewer);

/// The layer itself, traits.view pixels, RGBA: the picture as large as fits what is seen of it (black beside it; shapes
/// that differ by less than 1 % fill), moved and zoomed by traits.focus, resampled in linear light.
Image layer_of_picture(const Image& picture, double picture_aspect, const SinkTraits& traits, int layer);

/// Fills all layers of a display. GL thread.
Result<void> write_pictures(const ViewPictures& pictures, const SinkTraits& traits, const Observer& viewer,
                            ViewArray& layers);

}  // namespace dubsar
