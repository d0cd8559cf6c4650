#pragma once
// How the x-quads of a mesh are cut into triangles such that none cross (docs/manifold.md): a diagonal in the envelope
// of the grid edge, else a fan from a point of the edge; and, in the few cells of several pieces where polygons would
// cross all the same, fans along points on the faces of the cell. A function of the places of the vertices, in
// integers.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/extract/quad_envelope.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

enum class QuadCut : std::uint8_t {
  kFree,    ///< a vertex lies outside its cell, or on a wall where no fan can start: nothing is promised
  kFirst,   ///< between corners 0 and 2
  kSecond,  ///< between corners 1 and 3
  kEither,  ///< both diagonals lie in the envelope
  kFan,     ///< from a point of the grid edge
};

/// The point at which a side of two x-quads passes the face between its cells.
struct FacePoint {
  std::uint32_t a = 0, b = 0;  ///< vertices of the side, a < b
  ExactPlace place{0};
  friend bool operator<(const FacePoint& x, const FacePoint& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
};

/// The number of the point on the side between two vertices.
std::optional<std::size_t> find_face_point(std::span<const FacePoint> points, std::uint32_t a, std::uint32_t b);

struct QuadCuts {
  std::vector<QuadCut> of_quad;
  std::vector<FacePoint> face_points;   ///< rising; x-quads with one are fans
  std::vector<std::uint32_t> pointed;   ///< first vertices of the cells at whose sides they are put, rising
  std::vector<std::uint32_t> touching;  ///< first vertices of cells whose polygons touch or cross all the same, rising
};

/// All threads, deterministic; about 40 ns an x-quad and thread, and 5 us a cell of several pieces.
QuadCuts find_cuts(const QuadMesh& mesh);

}  // namespace dubsar
