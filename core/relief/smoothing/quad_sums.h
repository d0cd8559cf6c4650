#pragma once
// What x-quads give to their vertices, sixteen at a time: the kernels behind face_normals(), vertex_normals()
// (smooth.h) and the fit of principal_curvatures() (curvature.h).

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "core/extract/quad_mesh.h"

namespace dubsar {

/// The sums of vertices [first, first + size); one row more behind them takes those of all others.
struct VertexSums {
  const QuadMesh* mesh;
  const float* faces;    ///< face_normals(), four floats each; for normals
  const float* normals;  ///< of vertices, three floats each; for curvatures
  float* rows;           ///< kNormalFloats or kFitFloats each
  std::uint32_t first, size;
};
inline constexpr std::size_t kNormalFloats = 4, kFitFloats = 12;

/// Unit normal and area of x-quads [begin, end), begin a multiple of 16.
void quad_normals(const QuadMesh& mesh, std::int64_t begin, std::int64_t end, glm::vec4* faces);

/// Adds the normals of the x-quads of a group (scatter_blocks.h), weighted at each corner (corner_weights.h).
void add_corner_normals(const VertexSums& sums, std::uint32_t group);
/// The unit vectors of the sums, to the vertices from `first` on; (0, 0, 1) where there is none.
void finish_normals(const VertexSums& sums, glm::vec3* normals);

/// Adds the moments of the differences of positions and normals between opposite corners: u.u (xx yy zz xy xz yz) and
/// u.d + d.u, halved (the same six).
void add_fit_moments(const VertexSums& sums, std::uint32_t group);
/// Eigenvalues of the shape operator that fits the moments best, to the vertices from `first` on.
void finish_fit(const VertexSums& sums, float* k_min, float* k_max);

}  // namespace dubsar
