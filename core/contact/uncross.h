#pragma once
// No place where the shaped contact runs through itself or through the surface beside it.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/interface_mesh.h"
#include "core/contact/pockets.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Moves the added vertices of triangles that cross others back towards `home`, where they were before they were
/// shaped: inside their cells. Returns how many triangles crossed others at first. Deterministic.
std::int64_t uncross(const SurfaceModel& model, const std::vector<BandFace>& faces, const std::vector<glm::vec3>& home,
                     InterfaceMesh& mesh);

}  // namespace dubsar
