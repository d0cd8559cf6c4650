#pragma once
// How much the normal of an x-quad counts at each of its corners (smooth.h, vertex_normals()).

#include <cstdint>

#include "core/extract/quad_mesh.h"

namespace dubsar {

/// sin(angle) / (|a| |b|) for the two edges of polygon `quad` that meet at `vertex`.
float corner_weight(const QuadMesh& mesh, std::uint32_t quad, std::uint32_t vertex);

}  // namespace dubsar
