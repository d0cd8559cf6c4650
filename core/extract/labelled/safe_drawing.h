#pragma once
// Triangles of a dual mesh that do not cross or touch each other, by construction and checked exactly: a vertex stays
// inside its cell, a diagonal in its x-quad's envelope, else the polygon is a fan round its grid edge; where a cell of
// several pieces needs it, dual edges go through points of the cell's faces (docs/manifold.md).

#include <cstdint>
#include <span>
#include <vector>

#include "core/extract/labelled/labelled_mesh.h"
#include "core/extract/triangulate.h"
#include "core/mesh/exact_triangles.h"

namespace dubsar {

struct SafeDrawing {
  std::vector<ExactPlace> places;                 ///< of the vertices, then of added points
  std::vector<Triangle> triangles;                ///< ids of places
  std::vector<std::uint32_t> first_triangle;      ///< of x-quad q: [first_triangle[q], first_triangle[q + 1])
  std::int64_t edge_points = 0, face_points = 0;  ///< added
  std::int64_t fans_of_four = 0;                  ///< x-quads of four corners without a diagonal
  std::int64_t hard_cells = 0;                    ///< whose vertices had to leave the place that was asked for
  std::int64_t last_resorts = 0;                  ///< cells whose crossings were put in the middle of their edges
  std::int64_t crossing_pairs = 0;                ///< that are left; 0 unless this program is wrong
};

/// Distance that vertices keep from the walls of their cells: 2^-6 of a grid step.
inline constexpr std::int64_t kWallSteps = kExactSteps / 64;

/// `wanted`: where the vertices would be, grid coordinates; they are drawn back into their cells. `crossings`: of each
/// x-quad with its edge, grid coordinates. `preferred`: triangulate() of the mesh, whose diagonals are taken where they
/// may be. One thread but for the search of crossings; about 2 us a triangle.
SafeDrawing draw_safely(const LabelledMesh& labelled, std::span<const glm::vec3> wanted,
                        std::span<const glm::vec3> crossings, const Triangulation& preferred);

/// Where the x-quads of a labelled mesh cross their edges, grid coordinates. `contact` as build_labelled_mesh() has it.
std::vector<glm::vec3> crossings_of(const LabelledMesh& labelled, const SurfaceSamples& samples,
                                    const std::vector<std::uint16_t>& contact);

}  // namespace dubsar
