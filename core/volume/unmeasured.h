#pragma once
// Voxels that are no measurement: what a reconstruction writes outside its field of view, and into slices without data.

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Which grey values are no measurement. NaN and Inf never are one.
struct IgnoredValues {
  bool search = true;         ///< looks for a field of view, see find_unmeasured()
  std::vector<float> values;  ///< are no measurement wherever they occur; then nothing is looked for
};

/// "none", or a number for each text. kUsage.
Result<IgnoredValues> parse_ignored(const std::vector<std::string>& texts);

struct Unmeasured {
  std::vector<float> outside;  ///< found: no measurement from either end of a row to the first other value
  bool each_slice = false;     ///< each slice has another such value, SliceBorder::padding(); `outside` has examples
  std::vector<float> ignored;  ///< given: no measurement anywhere
  bool at_rim = false;         ///< whether `fill` was found at the rim of the field of view
  double share = 0.0;          ///< of the voxels in the slices that were looked at, or of all: NaN and Inf too
  /// What such voxels count as: the median of the first voxels behind the rim (its very first and fourth left out),
  /// where these are air; else the 5 % quantile of all others, as a scan shows more air than that. It has 18
  /// significant bits, the last one set: sums with binary weights, as of filters, leave it as it is, and measured
  /// values hardly ever have it, so that statistics can leave it out.
  float fill = 0.0f;

  /// `fill`, where there are such voxels, for statistics.
  std::optional<float> left_out() const noexcept { return share > 0.0 ? std::optional<float>(fill) : std::nullopt; }
};

/// A value within 2^-17 of it (relative) that has 18 significant bits, the last one set; for 0 a very small one.
float fill_value(float value) noexcept;

/// For people, without a full stop: "15.4 % of the voxels lie outside the field of view (0) and are no measurement:
/// they left out of all estimates and taken as 109, the median of the air at its rim".
std::string describe(const Unmeasured& unmeasured);

/// Looks for a value outside the field of view in three to seven whole slices, the first and the last among them: an
/// exact value at their border that is constant up to a convex region (a circle, a rectangle, in each slice its own),
/// or fills slices (one for all, or another one in each slice; up to 32 whole numbers beside each other or two to six
/// such paddings that meet, where these are far from the air), where what begins behind it is air: level there, and the
/// darker of what the region holds. So neither air that is clipped, nor a background that somebody masked, nor that of
/// a scan without noise is taken for it. `fill` is found in any case. Memory: one slice and some bytes a pixel. Errors:
/// those of the source, kBadData where no voxel of these slices is a measurement.
Result<Unmeasured> find_unmeasured(SlabSource& scan, const IgnoredValues& options);

}  // namespace dubsar
