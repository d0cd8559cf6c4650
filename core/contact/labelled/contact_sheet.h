#pragma once
// The contact as a sheet that has moved to where the scan shows it: which clay is on which side of it, and where it
// crosses the grid. A move beyond the end of a grid edge changes labels, not places (docs/manifold.md).

#include <cstdint>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/interface_mesh.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct ContactSheet {
  InterfaceMesh mesh;
  std::vector<glm::vec3> dual_positions;  ///< of vertices that belong to the surface of the air, too
  std::vector<std::uint8_t> evidence;     ///< of the added vertices (evidence.h)
};

/// The fill patches between tablet and envelope: all of it is inferred.
ContactSheet sheet_of_patches(const SurfaceModel& model);

/// Of each node of the band: its distance from the sheet, positive on the envelope's side; NaN where it is far;
/// infinity where the nearest place is the sheet's rim, beyond which there is no other side.
std::vector<float> distances_from_sheet(const ContactBand& band, const InterfaceMesh& sheet,
                                        const std::vector<glm::vec3>& dual_positions);

/// Sides as the sheet has them: of nodes near it by their distance; what lies between it and where it was, within
/// `reach` steps of these, goes with them. Clay beside air, or beside what is not in the band, keeps its side: of that
/// the faces of the surface have told more than the sheet can, whose rim is their work. What comes loose of its clay,
/// in pieces of fewer than `least` nodes or such that nowhere reach the end of the band, stays as it was.
void follow_sheet(const ContactBand& band, const std::vector<float>& distances, int reach, std::size_t least,
                  std::vector<ClaySide>& side);

}  // namespace dubsar
