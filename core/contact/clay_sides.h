#pragma once
// Whose clay is it? A minimum cut through the band between tablet and envelope: it runs through pockets of air for
// nothing, through films cheaply, and else as the patch does.

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/contact/clay_cavities.h"
#include "core/contact/cut/band_bricks.h"
#include "core/contact/cut/lattice_cut.h"
#include "core/contact/dips.h"

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

/// The cut. Borrows the band and the cavities. 28 bytes for each place of its bricks of 4x4x4, about 36 a node.
class ClayDivision {
 public:
  explicit ClayDivision(const ClayEvidence& evidence);
  ClayDivision(const ClayDivision&) = delete;
  ClayDivision& operator=(const ClayDivision&) = delete;

  /// Sides of all nodes, once. Every node hangs together with clay at the border of the band through nodes of its side,
  /// or is cut off by air and counts as the tablet's. kCancelled.
  Result<std::vector<ClaySide>> sides(Progress& progress);

 private:
  void add_points(const ClayEvidence& evidence);
  void add_hints(const std::vector<SurfaceHint>& hints);
  void add_steps(const Dips& dips);

  const ContactBand& band_;
  const std::vector<ClayCavity>& whole_;
  BandBricks bricks_;
  LatticeCut cut_;     ///< source side: tablet
  BrickBits certain_;  ///< points whose side is known
};

}  // namespace dubsar
