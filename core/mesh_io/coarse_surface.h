#pragma once
// What a large mesh file looks like, before all of it is read.

#include <functional>
#include <optional>
#include <string_view>

#include "core/mesh/tri_mesh.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar {

/// A surface of some ten thousand vertices that shows the same: vertices of one cell of a grid become one, and
/// triangles that lose their size go (J. Rossignac, P. Borrel: Multi-resolution 3D approximations for rendering complex
/// scenes, 1993). Positions and triangles only, in the file's numbers. For OBJ and binary STL, which take long to read;
/// nothing for other formats, for files of fewer than kCoarseFrom bytes, and for what is not as it should be: reading
/// all of it says what is wrong. Cost: about a fifth of reading.
std::optional<TriMesh> coarse_surface(MeshFormat format, std::string_view bytes);
inline constexpr std::size_t kCoarseFrom = std::size_t{16} << 20;

}  // namespace dubsar
