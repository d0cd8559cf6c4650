#pragma once
// A surface with a photograph on it: how its vertices are coloured, and made finer where they cannot hold what the
// photograph shows.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"
#include "core/mesh_io/glb/glb_photo.h"

namespace dubsar {

struct PaintedMesh {
  std::vector<glm::dvec3> places;    ///< mm
  std::vector<glm::dvec3> normals;   ///< unit, or 0 where the file has none
  std::vector<glm::dvec4> own;       ///< linear colours of the vertices
  std::vector<glm::dvec2> uv;        ///< of the file
  std::vector<std::uint32_t> paint;  ///< of each vertex: into `paints`
  std::vector<GlbPaint> paints;
  std::vector<Triangle> triangles;
  std::vector<PartitionId> partitions;  ///< of each triangle
};

/// Pixels of photographs that lie on the surface.
double photo_pixels(const PaintedMesh& mesh);

/// Divides each triangle into equal ones until there are about as many vertices as pixels of the photograph, at most
/// `most` triangles and 16 x 16 in place of one. The surface stays where it is; equal places of two edges stay equal.
void refine_to_photo(PaintedMesh& mesh, std::size_t most);

/// sRGB of each vertex, the mean of the pixels around it.
std::vector<std::array<std::uint8_t, 3>> painted_colors(const PaintedMesh& mesh);

}  // namespace dubsar
