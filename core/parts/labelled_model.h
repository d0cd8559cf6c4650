#pragma once
// A labelled mesh as the surface of a model: what lies at the air is its mesh, the contact its first patch, and both
// share vertices (docs/manifold.md).

#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Puts the vertices and x-quads of a labelled mesh in place of the model's own. Vertices at the air, rising, become
/// the model's, and take the attributes of LabelledMesh::unlabelled; the others, rising, become those of the first
/// patch, with the evidence of model.labelled, which must be there. X-quads at the air keep their numbers and
/// partitions. Other patches go. The contact lies between tablet and inside of the envelope.
Result<void> put_labelled_mesh(SurfaceModel& model, const LabelledMesh& labelled);

/// Has `mesh` the vertices, in number, and the x-quads that such a model gets?
bool is_mesh_at_air(const QuadMesh& mesh, const LabelledMesh& labelled);

/// The triangles of such a model: triangulate() of all its x-quads together, guided by the model's normals where it has
/// any. Points that are added in the contact are known as the first vertex of their x-quad that is not at the air.
/// `labelled` has the same places as the model. `cuts`: find_cuts() of it, where it is known.
void draw_labelled_mesh(SurfaceModel& model, LabelledMesh labelled, std::optional<QuadCuts> cuts = std::nullopt);

/// The places of the vertices of the labelled mesh of such a model, in their order.
std::vector<glm::vec3> labelled_places(const SurfaceModel& model, const LabelledMesh& labelled);

}  // namespace dubsar
