#pragma once
// Does what was found inside an envelope fill it as a tablet would?

#include <vector>

#include "core/parts/face_graph.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Signed volume of each partition of a segmented model in grid steps cubed. Where a partition ends at another, fans
/// from the middles of its borders close it: both sides of a border by the same fan, so that what one gains the other
/// loses. One entry for each row of the table. Same bits for any thread count; one pass over the faces.
std::vector<double> enclosed_volumes(const SurfaceModel& model, const FaceGraph& graph);

/// An envelope was pressed on around its tablet, so that the tablet fills at least half of the cavity (0.84 on
/// phantoms); a brain in its skull, fibres and foams fill less, or have walls that enclose nothing.
bool plausible_enclosure(double tablet, double cavity, double outside) noexcept;

/// The same for the partitions tablet, envelope outside and envelope inside of a segmented model; true for a model that
/// does not have all three.
bool plausible_enclosure(const SurfaceModel& model, const FaceGraph& graph);

/// The same once the partitions were measured with all holes closed, so that nothing is estimated; and the tablet is a
/// lump: 36 pi V^2 / A^3 is 1 for a ball, 0.24 for phantoms of tablets, 0.11 for a plate of 8 x 8 x 1, and below 0.04
/// for a brain with its furrows or the fibres of a felt. True for a table that does not have all three.
bool plausible_enclosure(const PartitionTable& measured);

}  // namespace dubsar
