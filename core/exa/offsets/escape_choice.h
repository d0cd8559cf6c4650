#pragma once
// Which vertices leave the place that their crossings give them, and by how few steps (docs/exa.md, "ESCP").

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/exa/offsets/settle.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// Moves those of `positions` that lie too far from the surface of `wanted` (with its vertex normals) by steps of
/// kEscapeStep: along one axis and by as few steps as bring them within half the bound, else to their own place. After
/// that none lies further than `bound` and 95 % lie within half of it. Fills the errors and the fraction in `stats`.
/// Deterministic for any thread count.
void let_escape(const QuadMesh& wanted, std::span<const glm::vec3> normals, double bound,
                std::vector<glm::vec3>& positions, SettleStats& stats);

}  // namespace dubsar
