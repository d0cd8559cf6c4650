#pragma once
// How vertices would have to move so that noise of the surface goes and its shape stays: a low-pass whose pass band is
// level (Taubin 1995, "A Signal Processing Approach to Fair Surface Design").

#include <glm/vec3.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// A step puts each vertex at the mean of the centres of its x-quads: a Gauss along the surface, of kStepVariance times
/// the area of an x-quad there (1 on faces along the grid, .58 across its diagonal).
struct FairOptions {
  static constexpr double kStepVariance = 0.5;
  int near_steps = 3;  ///< of the surface that moves lead to
  int wide_steps = 9;  ///< of what that surface is sharpened against
  /// Squared grid steps by which a surface grows times its mean curvature: the variance of the blur that rounded it.
  float growth = 0.0f;
  float most_move = 0.5f;  ///< grid steps
};

/// One vector for each vertex, grid steps, along the mean normal of two steps: to N + b (N - W), N the surface after
/// near_steps, W after wide_steps, and b such that a ball of radius R grows by growth / R and a plane stays. The mesh
/// stays as it is. Bit-identical for any number of threads; exchanged axes change roundings of doubles, none of floats
/// but by accident. 48 bytes a vertex while it runs. Only error: cancelled.
Result<std::vector<glm::vec3>> fair_moves(const QuadMesh& mesh, const FairOptions& options, Progress& progress);

}  // namespace dubsar
