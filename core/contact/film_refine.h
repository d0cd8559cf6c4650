#pragma once
// Films of air to a fraction of a voxel: the contact moves to where the scan is darkest, averaged along the contact
// itself and not over flat disks, which lift the tips of wedges.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/interface_rings.h"

namespace dubsar {

/// Moves the added vertices by at most `most` steps; `follows` is the share of every move that each makes, 0..1.
/// `dual_positions` are those of the surface beside the contact; they stay, and so do vertices beside them. No triangle
/// turns over. About 20 us a vertex;
/// the same for any number of threads.
void follow_dips(InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<glm::vec3>& dual_positions,
                 const std::vector<float>& follows, const BandDensity& density, float most);

}  // namespace dubsar
