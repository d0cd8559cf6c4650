#pragma once
// The formats behind the door. Parsers take bytes that nobody vouches for: they may refuse, never read outside.

#include <filesystem>
#include <string_view>

#include "core/mesh_io/mesh_io.h"

namespace dubsar {

/// PLY 1.0: ascii, binary little and big endian; any order and type of properties, faces or strips.
Result<TriMesh> parse_ply(std::string_view bytes, Progress& progress);
/// Binary little endian: x y z [nx ny nz] [red green blue] [partition] [k_min k_max] [shape] [ao] [quality], where
/// quality is the mean curvature; faces are uchar/int lists.
Result<void> write_ply(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress);

/// Begins with "solid", in letters of any size.
bool starts_like_stl(std::string_view bytes);
/// STL, binary and ascii. Corners with equal coordinates become one vertex.
Result<TriMesh> parse_stl(std::string_view bytes, Progress& progress);
/// Binary; the 80-byte header names the unit and never starts with "solid".
Result<void> write_stl(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress);

/// Wavefront OBJ: v (with optional colour), vn, f with positive and negative indices, polygons, line continuation.
Result<TriMesh> parse_obj(std::string_view bytes, Progress& progress);
/// v with colours (x y z r g b, as most programs read them), vn and f a//a; one group per partition.
Result<void> write_obj(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress);

/// How glTF counts; positions of its meshes are in mm.
inline constexpr std::string_view kGltfMetres = "glTF is in metres";
inline constexpr double kMmPerGltfUnit = 1000.0;
/// glTF 2.0 binary: triangles, strips and fans in the node tree, instances, points; plain, quantised, sparse and
/// EXT_meshopt_compression data, all in the file. Photographs (base colour) become colours of the vertices.
Result<TriMesh> parse_glb(std::string_view bytes, Progress& progress, const MeshReadOptions& options = {});
/// One named node, mesh and primitive per partition below a root node that turns millimetres, z up, into metres, y up.
/// For the web: KHR_mesh_quantization and EXT_meshopt_compression. All parts share one grid of 1/16 grid step (coarser
/// where 16 bits do not reach), so that what mates still does. Normals of 8 bits.
Result<void> write_compressed_glb(const std::filesystem::path& path, const TriMesh& mesh,
                                  const MeshWriteOptions& options, Progress& progress);
Result<void> write_glb(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress);

/// 3D Manufacturing Format 1.3: one object a body in millimetres, colours by the materials extension.
Result<void> write_3mf(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                       Progress& progress);
/// Always kBadData: 3MF is written for printers, not read.
Result<TriMesh> parse_3mf(std::string_view bytes, Progress& progress);

}  // namespace dubsar
