#pragma once
// Cells that hold several vertices of the dual mesh: the only ones at which its polygons can cross while vertices lie
// in their cells and triangles in their envelopes. Are there some that do?

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/extract/quad_cuts.h"

namespace dubsar {

/// The vertices of one cell: they follow one another.
struct CellPieces {
  std::uint32_t first = 0, count = 0;
};

/// Of the mesh as it lies, rising: neighbours in the order whose places lie in one cell, but not in one place.
std::vector<CellPieces> cells_of_several_pieces(const QuadMesh& mesh);

/// The places of a polygon, and whether its x-quad has a grid edge that a fan can start from.
struct PlacedPolygon {
  Polygon polygon;
  std::array<ExactPlace, 8> place;
  std::optional<QuadEdge> edge;

  std::span<const ExactPlace> places() const { return std::span(place).first(static_cast<std::size_t>(polygon.size)); }
  std::array<ExactPlace, 4> corners() const;  ///< the first vertex of each
  ExactPlace centre() const { return point_on_edge(places(), *edge); }
};
PlacedPolygon place_polygon(const QuadMesh& mesh, std::uint32_t quad);

/// How a polygon is cut while no face points are asked for.
QuadCut cut_of(const PlacedPolygon& placed);

/// A look at the triangles around the vertices of one cell.
class CellLook {
 public:
  /// `marked`: one a vertex, not 0 where sides across faces get points; or empty.
  CellLook(const QuadMesh& mesh, std::span<const std::uint8_t> marked) : mesh_(mesh), marked_(marked) {}

  /// True where triangles of x-quads at different pieces of the cell touch, or those of one that is a fan: whichever of
  /// two diagonals in the envelope is taken. Of fans only the triangles at vertices of the cell are looked at: others
  /// do not enter it.
  bool touches(const CellPieces& cell);

 private:
  /// How far a triangle reaches along the axes and the diagonals of the cell.
  struct Reach {
    std::array<std::int32_t, 7> low, high;
  };
  struct Member {
    ExactTriangle triangle;
    std::uint32_t quad = 0;
    std::uint32_t pieces = 0;  ///< mask
    bool fan = false;
  };
  void add_quad(const CellPieces& cell, std::uint32_t quad, std::uint32_t pieces);
  void add(const ExactTriangle& triangle, std::uint32_t quad, std::uint32_t pieces, bool fan);

  const QuadMesh& mesh_;
  std::span<const std::uint8_t> marked_;
  ExactPlace origin_{0};
  std::vector<Member> members_;
  std::vector<Reach> reaches_;  ///< of each member
  std::vector<std::uint32_t> quads_;
};

/// The point of the side between vertices a and b, both with the two x-quads beside it, or the three where three labels
/// meet: the mean of where they cross their edges; nothing where the side does not
/// cross a face or an x-quad has no fan.
std::optional<ExactPlace> face_point(const QuadMesh& mesh, std::uint32_t a, std::uint32_t b);

}  // namespace dubsar
