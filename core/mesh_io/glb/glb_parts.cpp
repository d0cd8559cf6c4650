#include "core/mesh_io/glb/glb_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_text.h"
#include "core/mesh_io/glb/glb_words.h"
#include "core/mesh_io/mesh_io.h"
#include "core/mesh_io/mesh_text.h"

namespace dubsar {
namespace {
using Json = nlohmann::json;
}  // namespace

std::vector<GlbPart> glb_parts(const TriMesh& mesh) {
  std::vector<GlbPart> parts;
  std::vector<std::uint32_t> local(mesh.positions.size());
  for (PartitionId id = 0; id < PartitionTable::kMost; ++id) {
    std::fill(local.begin(), local.end(), std::numeric_limits<std::uint32_t>::max());
    GlbPart part;
    part.id = id;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (mesh.partition_of(i) != id) continue;
      const Triangle& t = mesh.triangles[i];
      Triangle moved;
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t& slot = local[t[c]];
        if (slot == std::numeric_limits<std::uint32_t>::max()) {
          slot = static_cast<std::uint32_t>(part.vertices.size());
          part.vertices.push_back(t[c]);
        }
        moved[c] = slot;
      }
      part.triangles.push_back(moved);
    }
    if (!part.triangles.empty()) parts.push_back(std::move(part));
    if (mesh.triangle_partition.empty()) break;
  }
  return parts;
}

std::uint16_t linear_u16(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(linear * 65535.0));
}

Json glb_scene(const TriMesh& mesh, bool derived_colors) {
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "dubsar"}};
  json["asset"]["extras"] = {{"dubsar", mesh_text_lines(mesh, {MeshUnits::kMm}, derived_colors)}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", {0}}}});
  // Grid millimetres with z up to metres with y up, as glTF wants; the data keep millimetres.
  Json root{
      {"name", "scan"}, {"scale", {0.001, 0.001, 0.001}}, {"rotation", {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}};
  json["materials"] = Json::array({{{"name", "clay"},
                                    {"doubleSided", true},
                                    {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}}});
  json["nodes"] = Json::array({std::move(root)});
  return json;
}

Result<void> write_glb_file(const std::filesystem::path& path, const Json& json, std::uint64_t binary_bytes,
                            const std::function<Result<void>(BufferedWriter&)>& write_binary) {
  std::string text = dump_json(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + text.size() + (binary_bytes == 0 ? 0 : 8 + binary_bytes);
  if (total > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::kUsage, "glb: {} bytes do not fit the 4 GiB of the format; export one partition or use PLY",
                total);
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path, static_cast<std::int64_t>(total)));
  BufferedWriter out(file);
  for (const std::uint32_t word : {kGlbMagic, std::uint32_t{2}, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(text.size()), kGlbJsonChunk})
    out.little(word);
  out.text(text);
  if (binary_bytes > 0) {
    out.little(static_cast<std::uint32_t>(binary_bytes));
    out.little(kGlbBinChunk);
  }
  DUBSAR_TRY(write_binary(out));
  DUBSAR_TRY(out.flush());
  return file.commit();
}

}  // namespace dubsar
