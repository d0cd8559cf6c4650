#pragma once
// Does the contact lie where it lies for a reason? Where weakening its own dips a little moves it elsewhere, chance
// chose the place.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/contact/clay_sides.h"
#include "core/contact/dips.h"

namespace dubsar {

/// Divides the clay once more, with the dips within 2 steps of the contact weaker by 1/2 deviation where they are
/// within 32 steps of one of the places `asked`, and some farther ones. Nodes that change sides, 3 steps from it and
/// farther. `division`: that found `side`, and was not asked since. kCancelled.
Result<std::vector<bool>> find_unfirm(const ContactBand& band, ClayDivision& division,
                                      const std::vector<ClaySide>& side, std::span<const glm::vec3> asked,
                                      Progress& progress);

/// What is a film within 4.5 steps of nodes that are unfirm becomes inferred. `cut`: where the contact was before its
/// vertices moved; `evidence` of each (core/mesh/evidence.h).
void doubt_unfirm(const ContactBand& band, const std::vector<bool>& unfirm, std::span<const glm::vec3> cut,
                  std::vector<std::uint8_t>& evidence);

}  // namespace dubsar
