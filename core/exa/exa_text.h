#pragma once
// The text blocks of an EXA file: the JSON header and the partition table.

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct ExaHeader {
  GridFrame frame;
  Dims dims;
  float isovalue = 0.0f;
  int offset_bits = 4;
  bool closed = true;
  std::int64_t vertices = 0, quads = 0;
  std::uint64_t mesh_sum = 0;  ///< mesh_checksum() of the mesh that was written
};

/// kBadData when a number is not finite (JSON cannot hold it).
Result<std::string> exa_header_json(const ExaHeader& header);
/// kBadData: missing or wrong members, dimensions out of bounds.
Result<ExaHeader> parse_exa_header(std::string_view text);

Result<std::string> exa_partitions_json(const PartitionTable& partitions);
Result<PartitionTable> parse_exa_partitions(std::string_view text);

/// Over positions, quads and doubled corners: tells a reader that builds another mesh from the same samples.
std::uint64_t mesh_checksum(const QuadMesh& mesh);

}  // namespace dubsar
