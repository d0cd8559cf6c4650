#pragma once
// The colours of a surface as a picture shows them, for files that carry one colour a vertex.

#include "core/mesh/tri_mesh.h"
#include "display/render/mesh/surface_field.h"
#include "display/render/shading.h"

namespace dubsar::app {

/// Gives every vertex the colour that `style` has for it before the light falls on it: its map of shapes, ambient
/// occlusion, colours of its own. Vertices that only patches use (surface that the scan does not show) get the colour
/// of patches where the style marks them. Styles whose colours tell figures of the surface need `fields`, of this mesh.
void color_as_seen(TriMesh& mesh, const Style& style, const SurfaceFields* fields = nullptr);

/// Triangles that lie on the triangle of another part, turned the other way: patches that close both sides of a hole.
/// A format without parts (STL) cannot tell them apart.
std::int64_t coincident_triangles(const TriMesh& mesh);

}  // namespace dubsar::app
