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
};
constexpr int highest_label(ExaLabel label) {
  return label == ExaLabel::kShape ? 126 : label == ExaLabel::kLight ? 63 : PartitionTable::kHighest;
}

/// One chunk for 65,536 items of the mesh, whose incidence must be there. Labels must not exceed highest_label(). All
/// threads; the same bytes for any number of them.
std::vector<std::string> encode_labels(ExaLabel label, const QuadMesh& mesh, std::span<const std::uint8_t> values,
                                       Progress& progress);
/// kBadData: wrong number of chunks, a label out of range.
Result<std::vector<std::uint8_t>> decode_labels(ExaLabel label, const QuadMesh& mesh,
                                                std::span<const std::string_view> chunks, Progress& progress);

}  // namespace dubsar
