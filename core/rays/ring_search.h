#pragma once
// Finds the rings that uneven detector pixels leave, and tells them from what is round in the object.

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/rays/curve_search.h"
#include "core/rays/ring_field.h"

namespace dubsar {

struct RingsLook {
  glm::dvec2 centre{0.0};  ///< x and y of the axis, voxels
  double alike = 0.0;      ///< correlation of rings in clay and in air at the same distance: 1 for a scanner's
  std::optional<std::int64_t> half_turn;  ///< sector (PolarSlice) from which on half rings are other ones
};

struct RingsReport {
  RingsLook look;
  double deviation = 0.0;  ///< of clay less air, over the distances at which clay or air are seen
  double strongest = 0.0;  ///< the same
  double rings = 0.0;      ///< of a slice, in the mean
};

struct FoundRings {
  RingField field;
  RingsReport report;
};

/// "rings of uneven detector pixels about x 127.5, y 79.5: 4.1 % of the contrast, the strongest 22 %; taken off"
std::string describe(const RingsReport& rings);
/// What will be done.
std::string describe(const RingsLook& look);

/// What is the same over all angles about an axis along z that stands within two voxels of the middle, in clay and in
/// air alike: at one distance from the axis the object is clay here and air there, a detector pixel adds the same to
/// both. In scans of half a turn a pixel makes half a ring: where halves of the turn differ, the line between them is
/// looked for, to a sixteenth of the turn, and they are measured apart. Nothing where clay and air do not agree, or
/// where they agree about other centres as well; nothing, then, for a body of revolution about the axis, which has no
/// distance with both. Within a voxel of half the resolution of a surface nothing is looked at.
///
/// `half` is the scan after 2:1 (core/filter/resample.h), `levels` of air and clay. Reads eight slices. Memory: 16
/// slices. The same for any number of threads. Errors of the sources, kCancelled.
Result<std::optional<RingsLook>> look_for_rings(SlabSource& scan, SlabSource& half, const GreyLevels& levels,
                                                Progress& progress);

/// The same, and what they are in each slice. All of the scan is read once, and where it has at most 192 slices, twice.
/// Each stands out of the noise, in the mean of all slices, of 16, or in one slice.
Result<std::optional<FoundRings>> find_rings(SlabSource& scan, SlabSource& half, const GreyLevels& levels,
                                             Progress& progress);

}  // namespace dubsar
