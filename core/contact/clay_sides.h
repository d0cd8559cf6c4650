#pragma once
// Whose clay is it? A minimum cut through the band between tablet and envelope: it runs through pockets of air for
// nothing, through films cheaply, and else as the patch does.

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/contact/clay_cavities.h"
#include "core/contact/dips.h"
#include "core/contact/lattice_cut.h"

namespace dubsar {

/// What a face of the surface says about the clay behind it.
struct SurfaceHint {
  std::uint32_t node = 0;
  ClaySide side = ClaySide::kTablet;
  float weight = 0.0f;  ///< faces; from kCertain on it is obeyed
};
inline constexpr float kCertain = 1e6f;

/// What decides on which side the clay is. `votes`: of each node, faces of the cut that its density is worth to the
/// tablet (clays.h), or empty. The cut goes round each of `whole`.
struct ClayEvidence {
  const ContactBand& band;
  const Dips& dips;
  const std::vector<SurfaceHint>& hints;
  const std::vector<float>& votes;
  const std::vector<ClayCavity>& whole;
};

/// The cut. Borrows the band. 70 bytes a node.
class ClayDivision {
 public:
  explicit ClayDivision(const ClayEvidence& evidence);

  /// Sides of all nodes. Every node hangs together with clay at the border of the band through nodes of its side, or is
  /// cut off by air and counts as the tablet's. kCancelled.
  Result<std::vector<ClaySide>> sides(Progress& progress);

 private:
  const ContactBand& band_;
  std::vector<ClayCavity> whole_;
  LatticeCut cut_;
  std::vector<bool> certain_;
};

/// Removes points of a grid face that belong to tablet, envelope, tablet, envelope in turn.
void unpinch_sides(const ContactBand& band, std::vector<ClaySide>& side);

}  // namespace dubsar
