#pragma once
// From the places that a foreign file tells to the vertices of a mesh.

#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// No coordinate is infinite or NaN.
bool is_finite_place(const glm::vec3& place) noexcept;

/// Gives the mesh these places, in its file's units: as they are, or, where they are so far from the file's origin that
/// float would lose the shape (survey coordinates), beside a whole number of units that goes into frame.origin_vox.
/// Call it when the frame of the mesh is known.
void set_places(TriMesh& mesh, const std::vector<glm::dvec3>& places);

/// Vertices at equal places become one, in the order of their first ones, where the surface is more closed then than it
/// was: files without indices, and seams of texture. Normals become their mean direction, colours their mean. A mesh
/// that is closed already, or that would not gain by it, stays as it is. Not for our own files, whose parts share no
/// vertices on purpose.
void join_equal_places(TriMesh& mesh);

}  // namespace dubsar
