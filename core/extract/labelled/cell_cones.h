#pragma once
// Where the vertices of a cell of several pieces may stand: each is the tip of a cone over its curve on the walls of
// the cell, and the cones must not touch.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/exact_triangles.h"

namespace dubsar {

/// What one x-quad has at a vertex: triangles between it, the x-quad's point on its grid edge and the points before
/// and behind it, which lie on faces of the cell, or are the vertex at the other end of a chord.
struct ConePart {
  std::uint32_t edge_point = 0, next = 0, previous = 0;
  bool next_is_chord = false, previous_is_chord = false;
};

/// A drawing of a mesh in which all x-quads round the cell are fans, and all dual edges at it have face points.
class ConePlaces {
 public:
  virtual ~ConePlaces() = default;
  virtual std::vector<ExactPlace>& places() = 0;
  virtual ExactPlace cell_start(std::uint32_t vertex) const = 0;
  virtual void cone_of(std::uint32_t vertex, std::vector<ConePart>& parts) const = 0;
  /// The last resort: then every configuration has a place for its vertices.
  virtual void put_crossings_in_the_middle(std::span<const std::uint32_t> vertices) = 0;
};

enum class ConeResult { kAsWanted, kMoved, kLastResort, kNone };

/// Moves the vertices of a cell until their cones do not touch: the places that they have; the means of their
/// crossings; those drawn towards the chord; means with drawn weights; and all that once more with crossings in the
/// middle of their edges. Deterministic.
ConeResult place_cones(ConePlaces& drawing, std::span<const std::uint32_t> vertices);

}  // namespace dubsar
