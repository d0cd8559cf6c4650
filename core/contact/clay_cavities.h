#pragma once
// Cavities in the clay beside the contact: air, but no film.

#include <cstdint>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/dips.h"

namespace dubsar {

/// Points of clay at a closed cavity, or in one that the surface does not show: nodes of a band, rising.
using ClayCavity = std::vector<std::uint32_t>;

/// Cavities without a surface: at the scan's resolution a pore near the threshold has none where half of it shows
/// nothing (core/refine). Pieces of the band's clay whose density is less than `isovalue`, that touch no air which
/// `inside` knows, and are farther from every patch than they reach across the contact: a film, or a wedge under one,
/// begins at the patch.
std::vector<ClayCavity> unseen_cavities(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                                        float isovalue);

/// Dips near the cavities may be those of their air, and count as no sign of a film.
void blind_fringes(const ContactBand& band, const std::vector<ClayCavity>& cavities, Dips& dips);

/// Where a cavity has clay of both sides, the clay at it and that beside takes the side of most of it: the air of a
/// pore is no way from one side to the other. Has any changed?
bool keep_whole(const ContactBand& band, const std::vector<ClayCavity>& cavities, std::vector<ClaySide>& side);

}  // namespace dubsar
