#pragma once
// Sums and morphology of height maps of which some places are not known (NaN).

#include <vector>

#include "core/mesh/writing/height_map.h"

namespace dubsar {

/// Means over squares of (2 reach + 1)^2 cells, of what is known in them; NaN where fewer than `least` of these cells
/// (0 to 1) are known.
std::vector<float> square_means(const std::vector<float>& values, int width, int height, int reach, double least);

/// How far each place stands out of what a paraboloid of this radius touches from below: an opening (R. van den
/// Boomgaard, A. Smeulders: The morphological structure of images, 1994), separable, over a reach of mm. What is not
/// known takes no part.
std::vector<float> stands_out(const HeightMap& map, double radius_mm, double reach_mm);

}  // namespace dubsar
