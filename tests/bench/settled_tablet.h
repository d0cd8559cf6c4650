#pragma once
// The tablet's error when it may be moved as a whole, and what noise alone made.

#include <glm/vec3.hpp>
#include <span>

#include "core/mesh/tri_mesh.h"
#include "core/phantom/phantom.h"

namespace dubsar {

struct SettledTablet {
  double rms = 0.0;        ///< of the distances to the tablet's true surface after the best shift, voxels of the scan
  glm::dvec3 shift{0.0};   ///< that lessens their squares most, voxels
  double noise_pores = 0;  ///< share of the vertices on small surfaces of their own, 1.5 voxels from any true one
};

/// `positions`: of the tablet's vertices in voxels of the scan. Judged are those of its large connected surfaces (a
/// twentieth of all and more) that are measured, not those of contact, and where the gap is as wide as a scan can see
/// (1.5 voxels).
SettledTablet settle_tablet(const phantom::Phantom& truth, const TriMesh& tablet, std::span<const glm::vec3> positions);

}  // namespace dubsar
