#pragma once
// Which x-quads touch which, laid out for filters that treat many faces at once: sliced ELLPACK (Kreutzer et al.
// 2014) with slices of 16 faces, sorted by the number of neighbours inside chunks of 1024 faces.

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

class FaceNeighbours {
 public:
  static constexpr int kLanes = 16;  ///< faces in a slice: a multiple of every SIMD width
  static constexpr int kChunkFaces = 1024;
  static constexpr int kSlices = kChunkFaces / kLanes;
  static constexpr std::uint32_t kIndexBits = 30;  ///< entry = weight << 30 | face
  static constexpr std::uint32_t kIndexMask = (1u << kIndexBits) - 1;

  /// Faces [1024 i, 1024 (i + 1)) of the mesh. Lane l of slice s treats face order[16 s + l]; its j-th neighbour is
  /// entries[first_row[s] * 16 + 16 j + l], j < first_row[s + 1] - first_row[s]. Missing neighbours and lanes have
  /// weight 0 and name a valid face.
  struct Chunk {
    std::array<std::uint32_t, kChunkFaces> order;
    std::array<std::uint32_t, kSlices + 1> first_row{};
    int faces = 0;
    std::vector<std::uint32_t> entries;
  };

  /// All faces that share a vertex with a face; the weight is the number of shared vertices, 1..3 (3 and more: 3):
  /// usually 1 for neighbours across a vertex and 2 across an edge. kTryAgain beyond 2^30 faces. About 40 bytes a face.
  /// Same result for any thread count.
  static Result<FaceNeighbours> build(const QuadMesh& mesh, Progress& progress);

  const std::vector<Chunk>& chunks() const noexcept { return chunks_; }
  std::int64_t face_count() const noexcept { return faces_; }

 private:
  std::vector<Chunk> chunks_;
  std::int64_t faces_ = 0;
};

}  // namespace dubsar
