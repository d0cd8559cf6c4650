#include "core/mesh_io/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"

namespace dubsar {
namespace {
constexpr std::string_view kMaker = "made by dubsar";
constexpr std::string_view kUnitMm = "units mm";
constexpr std::string_view kUnitVox = "units voxel (input voxel coordinates, voxel centres at integers)";
constexpr std::string_view kVoxelSize = "voxel_size_mm ";
constexpr std::string_view kVoxelUnknown = "voxel_size unknown, 1 voxel = 1 mm assumed";
constexpr std::string_view kVoxelProvenance = "voxel_size_from ";
constexpr std::string_view kColors = "colors computed from shape and ao";
constexpr std::string_view kPartition = "partition ";
constexpr std::string_view kProvenance = "provenance ";
constexpr std::size_t kPiece = 200;  // some readers keep lines in fixed buffers

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return line;
}

/// `text` as ASCII JSON on one line, whatever it was: JSON text is compacted, other text becomes a JSON string.
std::string ascii_json(const std::string& text) {
  const auto json = parse_json(text, "provenance");
  return dump_json(json ? *json : nlohmann::json(text));
}

std::string one_ascii_line(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}
}  // namespace

std::vector<std::string> mesh_text_lines(const TriMesh& mesh, const MeshWriteOptions& options, bool colors_derived) {
  const VoxelSize& voxel = mesh.frame.input_voxel;
  std::vector<std::string> lines{std::string(kMaker)};
  lines.emplace_back(options.units == MeshUnits::kMm ? kUnitMm : kUnitVox);
  if (voxel.known()) {
    lines.push_back(fmt::format("{}{} {} {}", kVoxelSize, voxel.mm.x, voxel.mm.y, voxel.mm.z));
    lines.push_back(std::string(kVoxelProvenance) + one_line(voxel.provenance));
  } else {
    lines.emplace_back(kVoxelUnknown);
  }
  if (colors_derived) lines.emplace_back(kColors);
  for (const Partition& partition : mesh.partitions)
    lines.push_back(std::string(kPartition) + one_ascii_line(partition_json(partition)));
  if (!mesh.provenance.empty()) {
    const std::string text = ascii_json(mesh.provenance);
    for (std::size_t at = 0; at < text.size(); at += kPiece)
      lines.push_back(std::string(kProvenance) + text.substr(at, kPiece));
  }
  return lines;
}

void MeshTextReader::line(std::string_view text) {
  const auto rest_after = [&](std::string_view key) { return text.substr(key.size()); };
  if (text == kMaker) ours_ = true;
  if (!ours_) return;
  if (text == kUnitMm) unit_mm_ = true;
  if (text == kUnitVox) unit_vox_ = true;
  if (text == kColors) colors_derived_ = true;
  if (text.starts_with(kVoxelSize)) {
    std::string_view rest = rest_after(kVoxelSize);
    glm::dvec3 size(0.0);
    bool good = true;
    for (int axis = 0; axis < 3; ++axis) {
      while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
      const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), size[axis]);
      good = good && error == std::errc() && std::isfinite(size[axis]) && size[axis] > 0.0;
      rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    }
    if (good) {
      voxel_mm_ = size;
      size_known_ = true;
    }
  }
  if (text.starts_with(kVoxelProvenance)) voxel_provenance_ = rest_after(kVoxelProvenance);
  if (text.starts_with(kPartition) && partitions_.size() < 256) partitions_.emplace_back(rest_after(kPartition));
  if (text.starts_with(kProvenance)) provenance_ += rest_after(kProvenance);
}

Result<void> MeshTextReader::apply(TriMesh& mesh) const {
  mesh.frame = GridFrame{};
  if (unit_mm_ && size_known_) mesh.frame.input_voxel.provenance = "file unit mm";
  if (unit_vox_ && size_known_) {
    mesh.frame.input_voxel.mm = voxel_mm_;
    mesh.frame.input_voxel.provenance = voxel_provenance_.empty() ? "mesh file" : voxel_provenance_;
  }
  for (const std::string& text : partitions_) {
    DUBSAR_ASSIGN(const nlohmann::json row, parse_json(text, "partition table"));
    DUBSAR_ASSIGN(Partition partition, parse_partition(row));
    DUBSAR_TRY(mesh.partitions.insert(std::move(partition)));
  }
  mesh.provenance = provenance_;
  return {};
}

}  // namespace dubsar
