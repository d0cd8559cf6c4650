#pragma once
// Cavities in the clay beside the contact: air, but no film.

#include <cstdint>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/dips.h"

namespace dubsar {

/// Points of clay at a closed cavity: nodes of a band, rising.
using ClayCavity = std::vector<std::uint32_t>;

/// Does a film go on around the cavity, which is then where the film is widest: at the tip of a wedge, mostly? A sheet
/// through it is a tenth of what lies around it and more; around a pore there is clay, or a stalk of straw. `strength`:
/// of the dips, of all nodes.
bool lies_in_film(const ContactBand& band, const std::vector<float>& strength, const ClayCavity& cavity);

/// Where a cavity has clay of both sides, the clay at it and that beside takes the side of most of it: the air of a
/// pore is no way from one side to the other. Has any changed?
bool keep_whole(const ContactBand& band, const std::vector<ClayCavity>& cavities, std::vector<ClaySide>& side);

}  // namespace dubsar
