#pragma once
// Folds: triangles with two corners at one place, and two of one part that lie on each other, turned opposite ways.

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Leaves out folds, which enclose nothing. Tiny triangles become folds when their corners are rounded to the steps of
/// a file; a mesh with corners of their own stays closed with them, a format that joins equal points (STL) only
/// without. Returns how many triangles went. Vertices stay, used or not.
std::int64_t remove_folds(TriMesh& mesh);

}  // namespace dubsar
