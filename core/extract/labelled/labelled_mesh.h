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

/// The x-quads of the contact alone, in the order of ContactEdges, among the vertices of the mixed cells.
struct ContactQuads {
  std::vector<MixedCell> cells;      ///< order z, y, x; first_vertex counts from 0
  QuadMesh mesh;                     ///< vertices of all mixed cells, also those that have no x-quad of the contact
  std::vector<std::uint8_t> triple;  ///< of each vertex: 1 where three labels meet at it
  std::vector<std::uint8_t> at_air;  ///< of each vertex: 1 if an x-quad between clay and air has it
};

struct LabelledMesh {
  /// X-quads: those between clay and air in their order (build_quad_mesh()), then the contact's (ContactEdges).
  /// Vertices: those of cells without clay of both, in their order, then those of mixed cells. Polygons run
  /// counter-clockwise seen from the air, or from the tablet.
  QuadMesh mesh;
  std::uint32_t first_contact = 0;   ///< x-quad
  std::uint32_t first_mixed = 0;     ///< vertex
  std::vector<MixedCell> cells;      ///< order z, y, x
  std::vector<std::uint8_t> triple;  ///< of each vertex from first_mixed on: 1 where three labels meet at it
  std::vector<std::uint8_t> at_air;  ///< of each vertex from first_mixed on: 1 if it has an x-quad at the air
  std::vector<glm::vec3> extracted;  ///< of each vertex from first_mixed on: where the samples have it
  /// Of each vertex: that of the mesh without labels in its place, which has some of its crossings; kNoVertex: none.
  std::vector<std::uint32_t> unlabelled;

  static constexpr std::uint32_t kNoVertex = 0xffffffffu;
  bool is_at_air(std::size_t vertex) const noexcept {
    return vertex < first_mixed || at_air[vertex - first_mixed] != 0;
  }
};

/// `samples` are of the same signs as the labels, and closed. `contact`: where the x-quads of the contact cross their
/// edges, as samples.offsets; empty: half-way. Faces that two labels share in turn: `samples.joined` for clay and air,
/// the tablet's points are joined against the envelope's. A vertex lies at the mean of its crossings between clay and
/// air, if it has any, so that the surface is where it would be without labels; else at that of all. Deterministic for
/// any thread count. kBadData: offsets of another number. Cost: a pass over the bits, and about 1 us a mixed cell.
Result<ContactQuads> build_contact_quads(const SurfaceSamples& samples, const EdgeIndex& index,
                                         const PointLabels& labels, const ContactEdges& edges,
                                         const std::vector<std::uint16_t>& contact);

/// Labels in a mesh without them: build_quad_mesh() of the samples, perhaps with other places, which are kept where no
/// cell is mixed. Without clay of both it comes back as it was. kUsage: open samples; kTryAgain: too many vertices.
Result<LabelledMesh> put_labels(QuadMesh unlabelled, ContactQuads contact, const SurfaceSamples& samples,
                                const EdgeIndex& index, const PointLabels& labels);

/// Both, from the samples.
Result<LabelledMesh> build_labelled_mesh(const SurfaceSamples& samples, const EdgeIndex& index,
                                         const PointLabels& labels, const ContactEdges& edges,
                                         const std::vector<std::uint16_t>& contact, Progress& progress);

}  // namespace dubsar
