#pragma once
// Where a surface touches itself at a vertex, each of its sides gets the vertex for itself.

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/parts/triangle_soup.h"

namespace dubsar {

/// Gives every fan of triangles of one group around a border vertex its own copy of it: the first one, by group and
/// triangle, keeps the vertex. Copy i gets the id first_copy + i; the result holds the id that each copy stands for,
/// rising. Ids in the soup are below first_copy. O(n log n), whatever the triangles are; all threads, whose number
/// changes nothing. kCancelled.
Result<std::vector<std::uint32_t>> split_fans(TriangleSoup& soup, const std::vector<std::uint8_t>& border,
                                              std::uint32_t first_copy, const Progress* progress);

}  // namespace dubsar
