#pragma once
// What stands in a JPEG file beside its pixels: which way up it was taken, whether it is a pair, further pictures.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/budget.h"
#include "core/image_io/image.h"

namespace dubsar {

/// The descriptor of JPS pictures (marker APP3).
struct JpsPair {
  bool top_bottom = false, half = false, right_first = true;
};

struct JpegMarkers {
  int orientation = 1;  ///< EXIF tag 274, 1 to 8
  std::optional<JpsPair> pair;
  struct Picture {
    std::uint32_t kind = 0;  ///< MP type code: 0x020002 disparity, 0x030000 baseline, 0 not said
    std::size_t offset = 0, bytes = 0;
  };
  std::vector<Picture> pictures;  ///< of a multi-picture file (MPO, CIPA DC-007), this one first; else empty
};

/// Damaged markers count as absent. Reads no pixels.
JpegMarkers read_jpeg_markers(std::span<const std::byte> bytes);

/// The picture as it is to be seen, for rows and columns that begin as EXIF's and TIFF's tag 274 say.
Image upright(Image image, int orientation);

/// All views of a file that is a set of them, leftmost first, upright: those of MP type disparity, or the two of one
/// size of a file called .mpo. Empty: it is none, or no JPEG. kBadData, kTryAgain of its pictures. `others` counts
/// further pictures of the file that are no views.
Result<std::vector<Image>> read_jpeg_views(const std::filesystem::path& path, int& others, const Budget& budget = {});

}  // namespace dubsar
