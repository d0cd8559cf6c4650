#pragma once
// Dents of the traced contact that look like wedges: are they there, or did the contact follow the noise?

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/interface_rings.h"
#include "core/contact/rules.h"

namespace dubsar {

/// How many steps each added vertex lies below a sheet that spans dents some 12 steps wide, towards the envelope. The
/// same for any number of threads.
std::vector<float> dent_depths(const InterfaceMesh& mesh, const InterfaceRings& rings,
                               const std::vector<glm::vec3>& dual_positions);

/// Added vertices in dents, more than 1.2 steps below a sheet that spans them towards the envelope, whose dips do not
/// stand out of what chance makes of clay: the nearest 64 vertices of the dent, or all where it has fewer, have a
/// log_likelihood_of_film() below 3.1 (of 64: a mean below 2.5 deviations above that of `plain` clay, of fewer more).
/// What touches such vertices is doubtful, too. `film`: of each added vertex; others are no part of a dent. The same
/// for any number of threads.
std::vector<bool> doubtful_dents(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                 const std::vector<glm::vec3>& dual_positions, const std::vector<bool>& film,
                                 const PlainClay& plain = {}, ContactRules rules = {});

}  // namespace dubsar
