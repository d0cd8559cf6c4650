#pragma once
// The x-quads as nodes of a graph: which faces lie across which side, how large they are and where they look.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// One face of the graph.
struct FaceNode {
  int sides = 0;
  std::array<std::uint32_t, 8> neighbour;  ///< across each of them, as in FaceGraph
  glm::vec3 centre, normal;
  float area;
};

/// What FaceGraph has of an x-quad, without the others.
FaceNode face_node(const QuadMesh& mesh, std::uint32_t quad);

struct FaceGraph {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Side i of face q runs from polygon(q).vertex[i] to the next; the face across is neighbour[first_side[q]
  /// + i], or kNone at an open boundary.
  std::vector<std::uint32_t> first_side;
  std::vector<std::uint32_t> neighbour;
  std::vector<glm::vec3> centre;  ///< mean of the polygon's vertices
  std::vector<glm::vec3> normal;  ///< unit, towards the air; zero for a face without area
  std::vector<float> area;        ///< grid steps squared

  std::uint32_t faces() const noexcept { return static_cast<std::uint32_t>(centre.size()); }

  /// Same result for any thread count. About 50 bytes a face. kCancelled.
  static Result<FaceGraph> build(const QuadMesh& mesh, Progress& progress);

  /// Curvature between two faces that share a side, (n2 - n1).(c2 - c1) / |c2 - c1|^2: concave < 0.
  float curvature(std::uint32_t a, std::uint32_t b) const noexcept;
};

}  // namespace dubsar
