#pragma once
// How much the normal of an x-quad counts at each of its corners (smooth.h, vertex_normals()).

#include <array>
#include <cstdint>
#include <vector>

#include "core/extract/quad_mesh.h"

namespace dubsar {

/// sin(angle) / (|a| |b|) for the two edges of polygon `quad` that meet at `vertex`.
float corner_weight(const QuadMesh& mesh, std::uint32_t quad, std::uint32_t vertex);

/// The same for the four corners of every x-quad; of those with doubled corners it means nothing. Threads.
std::vector<std::array<float, 4>> corner_weights(const QuadMesh& mesh);

}  // namespace dubsar
