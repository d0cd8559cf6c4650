#pragma once
// All views of a light field panel in one picture, as tiles: view 0, the leftmost camera, at the lower left, then to
// the right, then upwards. The file's name carries the layout: NAME_qs8x6a0.75.png has 8 columns, 6 rows, aspect 0.75.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image.h"
#include "display/panels/panel_profile.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

struct QuiltName {
  int columns = 0, rows = 0;
  std::optional<double> aspect;  ///< of the picture on the panel, not of the tile
};

/// "_qs8x6a0.75"
std::string quilt_suffix(int columns, int rows, double aspect);

/// `path` with a display's file suffix before the extension; quilts' suffixes that stand in it already are taken
/// away, so that there is one.
std::filesystem::path name_with_suffix(const std::filesystem::path& path, std::string_view suffix);

/// Finds "_qs<columns>x<rows>[a<aspect>]" in a file's name; the last one counts. Nothing when there is none or it is
/// out of range (1 to 100 a side, aspect 0.05 to 20).
std::optional<QuiltName> parse_quilt_name(std::string_view file_name);

/// Lower left corner of a view's tile, from the lower left of the quilt. What does not divide is left black at the
/// right and on top.
PixelSize quilt_tile_corner(const QuiltLayout& layout, int view) noexcept;

/// The tiles of a quilt as views, RGB.
std::vector<Image> split_quilt(const Image& quilt, const QuiltLayout& layout);

/// Options: PROFILE or panel=, calibration=FILE, columns= rows= width= height= aspect= cone=, focus= and zoom=
/// (ViewFocus).
Result<std::unique_ptr<OutputSink>> make_quilt_sink(SinkOptions options);

}  // namespace dubsar
