#pragma once
// Segmentation: which x-quads belong to the hidden tablet, to the outside and the inside of its envelope, or
// to loose pieces (paper section 3.4.3; docs/method.md, 8).

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/parts/face_graph.h"
#include "core/parts/surface_model.h"

namespace dubsar {

enum class SegmentMethod {
  kNested,     ///< exterior and depth of the air, then an exact minimum cut along concave creases
  kConcavity,  ///< the paper's: cut where the smallest principal curvature falls below a threshold, take
               ///< components
  kBodies,     ///< closed bodies as they are, nothing is separated
  kNone,       ///< one partition
};

inline constexpr EnumName<SegmentMethod> kSegmentMethods[] = {{SegmentMethod::kNested, "nested"},
                                                              {SegmentMethod::kConcavity, "concavity"},
                                                              {SegmentMethod::kBodies, "bodies"},
                                                              {SegmentMethod::kNone, "none"}};
static_assert(names_all(kSegmentMethods, static_cast<std::size_t>(SegmentMethod::kNone) + 1));

struct SegmentOptions {
  SegmentMethod method = SegmentMethod::kNested;
  float concavity = -0.2f;        ///< kConcavity: cut at k_min below this, per grid step; -0.1 to -0.3 work on phantoms
  int dilate_rings = 1;           ///< kConcavity: rings of vertices added to the cut; 0 leaks
  int largest_crack_radius = 8;   ///< widest crack in the envelope that can be closed is 2 r + 1 grid steps
  double smallest_area = 0.001;   ///< pieces below this share of the whole area are merged
  double smallest_volume = 64.0;  ///< and closed pieces below this volume, voxels of the processed grid
};

struct SegmentReport {
  bool nested = false;  ///< a body was found inside another: partitions "tablet", "envelope outside", "... inside"
  bool enclosure_refused = false;  ///< one was found, but it does not fill its cavity as a tablet would (enclosure.h)
  int crack_radius = 0;            ///< of the exterior that was used
  std::int64_t components = 0;     ///< connected surfaces before segmentation
  std::int64_t small_pieces = 0;   ///< components in the partition "pores and crumbs"
  double cut_length = 0.0;         ///< length of the borders between parts, grid steps
};

/// Sets quad_partition and partitions (ids and names; measure_partitions() or fill_holes() adds the figures)
/// and drops old patches. A nested object gets "tablet" 0, "envelope outside" 1 and "envelope inside" 2 (the
/// last two are the part "envelope"), any other object "object" 0 (kNested: also one whose inner body is no tablet);
/// then follow "fragment 1", ... by falling volume, and last "pores and crumbs" with all closed small pieces and the
/// cavities inside the clay. At most 8 partitions. Needs smoothed positions; kConcavity also vertex normals (kBadData
/// without them). Deterministic for any thread count. kCancelled. Cost: about 1.5 us a face on one core; memory about
/// 150 bytes a face and 2 bits a grid point.
Result<SegmentReport> segment(SurfaceModel& model, const SegmentOptions& options, Progress& progress);
/// The same with the graph of the model's faces; keeps none of it.
Result<SegmentReport> segment(SurfaceModel& model, const FaceGraph& graph, const SegmentOptions& options,
                              Progress& progress);

}  // namespace dubsar
