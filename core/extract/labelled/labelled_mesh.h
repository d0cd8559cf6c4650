#pragma once
// The surface of a labelled volume as one dual mesh: between air and clay, and between the tablet's clay and the
// envelope's. The x-quads that have a label form a closed 2-manifold, whatever the labels (docs/manifold.md), and parts
// that touch share vertices and x-quads. What determines connectivity, places and triangles: labelled_surface.h.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/edge_index.h"
#include "core/extract/labelled/contact_edges.h"
#include "core/extract/labelled/point_labels.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// A cell with clay of both; cell (x, y, z) lies between the points x and x + 1 and so on, from -1 on.
struct MixedCell {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint32_t first_vertex = 0;
  std::uint16_t config = 0;  ///< LabelledCellTable::id
};

struct LabelledMesh {
  /// X-quads: those between clay and air in their order (build_quad_mesh()), then the contact's (ContactEdges).
  /// Vertices: those of cells without clay of both, in their order, then those of mixed cells. Polygons run
  /// counter-clockwise seen from the air, or from the tablet.
  QuadMesh mesh;
  std::uint32_t first_contact = 0;        ///< x-quad
  std::uint32_t first_mixed = 0;          ///< vertex
  std::vector<MixedCell> cells;           ///< order z, y, x
  std::vector<std::uint8_t> triple;       ///< of each vertex from first_mixed on: 1 where three labels meet at it
  std::vector<std::uint32_t> unlabelled;  ///< of each vertex below first_mixed: its number without labels
  std::vector<std::uint8_t> pairs;        ///< of each x-quad: label_pair()
  std::vector<GridEdge> edges;            ///< of each x-quad
  std::vector<glm::ivec3> vertex_cells;   ///< of each vertex (quad_edges.h)

  static constexpr std::uint8_t label_pair(PointLabel low, PointLabel high) noexcept {
    return static_cast<std::uint8_t>(static_cast<unsigned>(low) | static_cast<unsigned>(high) << 2);
  }
};

/// `samples` are of the same signs as the labels, and closed. `contact`: where the x-quads of the contact cross their
/// edges, as samples.offsets; empty: half-way. Faces that two labels share in turn: `samples.joined` for clay and air,
/// the tablet's points are joined against the envelope's. Without clay of both it is build_quad_mesh(), bit by bit.
/// Deterministic for any thread count. kUsage: open samples; kBadData: offsets of another number; and those of
/// build_quad_mesh(). Cost: that, and about 1 us a mixed cell.
Result<LabelledMesh> build_labelled_mesh(const SurfaceSamples& samples, const EdgeIndex& index,
                                         const PointLabels& labels, const ContactEdges& edges,
                                         const std::vector<std::uint16_t>& contact, Progress& progress);

}  // namespace dubsar
