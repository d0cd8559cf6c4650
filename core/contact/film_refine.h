#pragma once
// Films of air to a fraction of a voxel: the contact moves to where the scan is darkest, averaged along the contact
// itself and not over flat disks, which lift the tips of wedges.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/contact/clays.h"
#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/interface_rings.h"
#include "core/contact/rules.h"

namespace dubsar {

/// What each added vertex is to do.
struct Following {
  std::vector<bool> moves;
  std::vector<bool> step;  ///< to where one clay becomes the other, not to a dip
};
struct FollowOptions {
  float most = 3.0f;            ///< steps that a vertex is moved to dips: cuts stop short of the tips of wedges
  float blur_variance = 0.42f;  ///< of the scan
  std::optional<ClayContrast> clays = std::nullopt;
  ContactRules rules{};
};

/// Moves the added vertices. Dips that do not stand out of the noise, as parallel sheets in the clay on both sides show
/// it, move little, and the contact is smooth there. `dual_positions` are those of the surface beside the contact: they
/// stay. No triangle turns over. About 35 us a vertex; the same for any number of threads.
void follow_dips(InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<glm::vec3>& dual_positions,
                 const Following& follows, const BandDensity& density, const FollowOptions& options);

}  // namespace dubsar
