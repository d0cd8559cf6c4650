#pragma once
// How much of a tablet's true surface a mesh shows, and what it shows where it does not.

#include <glm/vec3.hpp>
#include <span>

#include "core/mesh/tri_mesh.h"
#include "core/phantom/phantom.h"

namespace dubsar {

/// Shares of the true surface of the tablet where the gap is as wide as a scan can see (1.5 voxels).
struct TabletCover {
  double measured = 0.0;  ///< within a voxel of a vertex of the tablet that is measured
  double patch = 0.0;     ///< else within a voxel of one of contact
  double envelope = 0.0;  ///< else within a voxel of the envelope
  double off = 0.0;       ///< else within three voxels of either
  double nothing = 0.0;   ///< else
};

/// `tablet` and `envelope` with their vertices in voxels of the scan. About 4 us a place of the surface.
TabletCover cover_tablet(const phantom::Phantom& truth, const TriMesh& tablet, std::span<const glm::vec3> of_tablet,
                         std::span<const glm::vec3> of_envelope);

}  // namespace dubsar
