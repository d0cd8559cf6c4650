#pragma once
// Opens a closed mesh at the volume boundary.

#include <cstdint>
#include <span>

#include "core/extract/quad_mesh.h"

namespace dubsar {

/// Drops every x-quad with a corner in the virtual layer (`in_layer`: 1 per such vertex), then doubles the vertices
/// whose remaining x-quads form several fans, first fan = lowest x-quad, and drops those without any. Order of
/// vertices and x-quads is kept. `mesh` must have its incidence; the result has, too.
QuadMesh open_at_boundary(const QuadMesh& mesh, std::span<const std::uint8_t> in_layer);

}  // namespace dubsar
