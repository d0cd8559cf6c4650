#pragma once
// The traced contact in its final shape: which of it is a film, where its vertices lie.

#include <cstdint>
#include <vector>

#include "core/contact/interface_mesh.h"

namespace dubsar {

/// Evidence of the added vertices (evidence.h): film where the mean strength around them is at least `film_strength`,
/// else inferred. Films keep their places but for the noise; what is inferred becomes a membrane between them and the
/// surface, no farther than `most` steps from where it was.
std::vector<std::uint8_t> shape_interface(InterfaceMesh& mesh, const std::vector<glm::vec3>& dual_positions,
                                          float film_strength, float most);

}  // namespace dubsar
