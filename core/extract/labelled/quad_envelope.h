#pragma once
// May an x-quad be two triangles? Only if both stay in its envelope, the four tetrahedra between its grid edge and
// neighbouring corners: the envelopes of different grid edges have no inside in common ([Ju 2006];
// docs/manifold.md).

#include <array>

#include "core/mesh/exact_triangles.h"

namespace dubsar {

/// `corners`: in their turn round the edge, each strictly inside its cell. The edge goes from `start` one grid step
/// along `axis`. Diagonal between corners 0 and 2, or 1 and 3. Exact.
bool diagonal_in_envelope(const std::array<ExactPlace, 4>& corners, const ExactPlace& start, int axis,
                          bool first_diagonal) noexcept;

}  // namespace dubsar
