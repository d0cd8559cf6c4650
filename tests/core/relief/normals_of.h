#pragma once
// Unit normals of vertices, as the stages before the relief give them.

#include <vector>

#include "core/relief/smoothing/smooth.h"

namespace dubsar::test {

inline std::vector<glm::vec3> normals_of(const QuadMesh& mesh) { return vertex_normals(mesh, face_normals(mesh)); }

}  // namespace dubsar::test
