#pragma once
// Faces of the surface beside the contact: what they say about the clay behind them, and whose they are once the clay
// is divided. Closed pockets of air that lie on the contact become relief of tablet and envelope.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/contact/clay_sides.h"
#include "core/extract/edge_index.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct BandFace {
  std::uint32_t quad = 0;
  std::uint32_t node = 0;  ///< the point of clay behind it
};

/// All x-quads whose point of clay is in the band, by node.
std::vector<BandFace> faces_of_band(const SurfaceModel& model, const EdgeIndex& index, const ContactBand& band);

/// A closed piece of the surface that is neither tablet nor envelope: around a cavity in the clay, or a crumb of it.
struct RestPiece {
  std::vector<std::uint32_t> quads;
  std::vector<std::uint32_t> first_side{0}, beside;  ///< of each of them, the x-quads beside it
  double volume = 0.0;                               ///< below 0: of air
};
struct RestPieces {
  struct Face {
    std::uint32_t piece, place;  ///< in its quads
  };
  std::unordered_map<std::uint32_t, Face> face_of;  ///< by quad
  std::vector<RestPiece> all;
};

/// Those that have faces in the band.
RestPieces rest_pieces(const SurfaceModel& model, const std::vector<BandFace>& faces);

/// Closed cavities that do not open to the contact: pores of the clay. The mouth of a pocket lies where the clays meet,
/// and the patches miss that by less than the pocket is deep; a cavity that is farther from every patch than it
/// reaches across the contact is none, unless it lies in a film. `strength`: of the dips, of all nodes. By their first
/// nodes; the same for any number of threads.
std::vector<ClayCavity> cavities_off_contact(const RestPieces& pieces, const ContactBand& band,
                                             const std::vector<BandFace>& faces, const std::vector<float>& strength);

/// Faces of tablet and envelope away from the rim of the patches are certain; those at the rim and those of closed
/// pockets vote by where they look. Those of cavities off the contact say nothing.
std::vector<SurfaceHint> hints_of_faces(const SurfaceModel& model, const ContactBand& band,
                                        const std::vector<BandFace>& faces, const std::vector<ClayCavity>& off_contact);

/// Gives the faces the sides of their clay, and pockets with faces of both sides to tablet and envelope. Returns the
/// number of such pockets.
std::int64_t relabel_faces(SurfaceModel& model, const RestPieces& pieces, const std::vector<BandFace>& faces,
                           const std::vector<ClaySide>& side);

}  // namespace dubsar
