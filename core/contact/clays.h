#pragma once
// Clay of the tablet and clay of the envelope, where one is denser than the other: what lies between them is seen as a
// step of the density, with or without air.

#include <optional>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/dips.h"

namespace dubsar {

struct ClayContrast {
  float tablet = 0.0f, envelope = 0.0f;  ///< density of each
  float deviation = 0.0f;                ///< of the noise in BandDensity
  float white_deviation = 0.0f;  ///< of noise that voxels do not share, which adds up to the same over large volumes

  float middle() const noexcept { return 0.5f * (tablet + envelope); }
  float step() const noexcept { return envelope - tablet; }
};

/// Compares clay on both sides of the patches, piece by piece of them, away from air. Nothing where the difference is
/// not significant (5 standard errors of the pieces' mean), or no more than what a gradient in the tablet's own clay
/// explains, or smaller than the noise of single points. `blur_variance`: of the scan, voxels squared.
std::optional<ClayContrast> compare_clays(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                                          float blur_variance);

/// Of each node: how clearly its density is that of one clay, in faces of the cut (clay_sides.h), positive for the
/// tablet's; 0 where air is near.
std::vector<float> clay_votes(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                              const ClayContrast& contrast);

}  // namespace dubsar
