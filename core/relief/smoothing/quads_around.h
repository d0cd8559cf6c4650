#pragma once
// The x-quads around the vertices of a mesh, sixteen vertices with equally many at a time: what the passes of
// filter_face_normals() read.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/system/large_pages.h"
#include "core/extract/quad_mesh.h"
#include "core/relief/smoothing/scatter_blocks.h"

namespace dubsar {

/// Vertices with 2 to kMostAround x-quads stand in batches of kVertexBatch: [x-quad 0 .. around)[vertex], one size
/// after the other from 2 on; the last batch of a size repeats its last vertex.
struct AroundGroup {
  std::size_t begin = 0;  ///< of its batches, in QuadsAround::quads
  static constexpr std::size_t kMostAround = 8, kVertexBatch = 16;
  std::array<std::uint16_t, kMostAround + 1> vertices{};  ///< by the number of x-quads
  IdRange touched;                                        ///< x-quads
  std::vector<std::uint32_t> others;                      ///< vertices with more x-quads
};

/// Of a group the vertices with x-quads in [first, first + size), in the same order; `touched`: those x-quads. The
/// batches are appended to `quads`.
AroundGroup group_within(const QuadMesh& mesh, std::int64_t number, std::uint32_t first, std::uint32_t size,
                         std::vector<std::uint32_t>& quads);

/// Group g: vertices [g, g + 1) * kVertexGroup. Threads, deterministic.
struct QuadsAround {
  explicit QuadsAround(const QuadMesh& mesh);
  std::vector<AroundGroup> groups;
  LargeArray<std::uint32_t> quads;
};

}  // namespace dubsar
