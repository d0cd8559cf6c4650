#pragma once
// What plain and compressed GLB have in common: parts with vertices of their own, the scene around them, the container.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/files/buffered_writer.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

inline constexpr int kGlFloat = 5126, kGlUint = 5125, kGlUshort = 5123, kGlByte = 5120;
inline constexpr int kGlArrayBuffer = 34962, kGlElementArrayBuffer = 34963;

/// One partition with vertices of its own.
struct GlbPart {
  PartitionId id = 0;
  std::vector<std::uint32_t> vertices;  ///< ids in the mesh
  std::vector<Triangle> triangles;      ///< local ids
};
std::vector<GlbPart> glb_parts(const TriMesh& mesh);

/// glTF vertex colours are linear light, our bytes are sRGB.
std::uint16_t linear_u16(std::uint8_t srgb);

/// Asset, scene, material and one node: "scan", grid millimetres with z up to metres with y up.
nlohmann::json glb_scene(const TriMesh& mesh, bool derived_colors);

/// Writes the container: the JSON text, and `binary_bytes` that write_binary() writes. kUsage beyond 4 GiB.
Result<void> write_glb_file(const std::filesystem::path& path, const nlohmann::json& json, std::uint64_t binary_bytes,
                            const std::function<Result<void>(BufferedWriter&)>& write_binary);

}  // namespace dubsar
