#pragma once
// Shape classes, ambient light and partitions, coded after the values of neighbours (docs/exa.md, "Attributes").

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"
#include "core/mesh/partition_table.h"

namespace dubsar {

enum class ExaLabel {
  kShape,      ///< per vertex, 0..126
  kLight,      ///< per vertex, 0..63
  kPartition,  ///< per x-quad, 0..7
  kEnum,       ///< per vertex, any 0..7
};
constexpr int highest_label(ExaLabel label) {
  return label == ExaLabel::kShape ? 126 : label == ExaLabel::kLight ? 63 : PartitionTable::kHighest;
}

/// Ambient light is stored in steps of this many levels when all of it can be: settle_light() sees to that.
inline constexpr int kLightStep = 3;

/// Moves each level to the nearest that is a whole number of kLightStep from what its neighbours let expect: by
/// kLightStep / 2 at most, a 63rd of full light. Twice is the same as once. The same for any number of threads.
void settle_light(const QuadMesh& mesh, std::span<std::uint8_t> light, Progress& progress);

/// One chunk for 65,536 items of the mesh, whose incidence must be there. Labels must not exceed highest_label(). All
/// threads; the same bytes for any number of them.
std::vector<std::string> encode_labels(ExaLabel label, const QuadMesh& mesh, std::span<const std::uint8_t> values,
                                       Progress& progress);
/// kBadData: wrong number of chunks, a label out of range. `items`: how many, if not one for each of the mesh.
Result<std::vector<std::uint8_t>> decode_labels(ExaLabel label, const QuadMesh& mesh,
                                                std::span<const std::string_view> chunks, Progress& progress,
                                                std::int64_t items = -1);

}  // namespace dubsar
