#pragma once
// The triangles of a patch around their vertices: what lies beyond an edge, fans, rims, closed pieces.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A vertex at which several fans of triangles meet, as where two holes touch, is as many corners: so each lies on one
/// rim at most, once. About 50 bytes and 150 ns a triangle.
class PatchFans {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Vertices of `triangles`, which must outlive it, are below `vertices`.
  PatchFans(std::span<const Triangle> triangles, std::uint32_t vertices);
  /// False: an edge has two triangles on one side, or a triangle a vertex twice; then nothing else may be asked.
  bool manifold() const noexcept { return manifold_; }
  /// Vertices by corner; corners of the triangles.
  const std::vector<std::uint32_t>& vertices() const noexcept { return vertices_; }
  const Triangle& corners(std::uint32_t triangle) const { return corners_[triangle]; }
  /// The triangle with this directed edge between vertices, or kNone.
  std::uint32_t triangle(std::uint32_t from, std::uint32_t to) const;
  /// The triangle behind `t` around one of its vertices, or kNone.
  std::uint32_t next_around(std::uint32_t t, std::uint32_t vertex) const {
    return beyond_[t][(place(t, vertex) + 2) % 3];
  }
  /// Rims as corners: each begins with its lowest edge of vertices, the rim with the lowest of all first. A rim with
  /// an inner vertex between its edges, or an open one, cannot be.
  std::vector<std::vector<std::uint32_t>> rims() const;
  /// Corners at vertices below `end` that no rim has, by their vertices.
  std::vector<std::uint32_t> inside(std::uint32_t end, std::span<const std::uint32_t> on_rims) const;
  /// Of each piece that has no rim the first triangle without vertices below `end`; kNone where there is none.
  std::vector<std::uint32_t> closed_pieces(std::uint32_t end) const;

 private:
  struct Edge {
    std::uint32_t to, triangle;
  };
  std::span<const Edge> edges_from(std::uint32_t vertex) const {
    return std::span(edges_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  void list_edges();
  bool sort_edges();
  std::size_t place(std::uint32_t t, std::uint32_t vertex) const {
    return triangles_[t][0] == vertex ? 0 : triangles_[t][1] == vertex ? 1 : 2;
  }
  void name_fan(std::uint32_t first, std::uint32_t vertex);

  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> first_;  ///< of each vertex in edges_, and the end
  std::vector<Edge> edges_;           ///< from each vertex, by their ends
  std::vector<Triangle> beyond_;      ///< the edges from each corner of a triangle, or kNone
  std::vector<Triangle> corners_;
  std::vector<std::uint32_t> vertices_;
  bool manifold_ = false;
};

}  // namespace dubsar
