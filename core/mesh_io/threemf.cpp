// 3MF (3D Manufacturing Format, core specification 1.3; materials and properties extension 1.2.1).

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <map>

#include "core/base/text/markup_text.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "core/mesh_io/progress_step.h"
#include "core/mesh_io/zip_writer.h"

namespace dubsar {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr int kColours = 1;  // id of the colour group; objects come after

constexpr std::string_view kTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
constexpr std::string_view kRelations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";
constexpr std::string_view kModelHead =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
<metadata name="Application">dubsar</metadata>
<resources>
)";

/// Entry 3D/3dmodel.model, in pieces.
class ModelWriter {
 public:
  ModelWriter(ZipWriter& zip, const TriMesh& mesh, Progress& progress)
      : zip_(zip),
        mesh_(mesh),
        progress_(progress),
        space_(mesh.frame, MeshUnits::kMm),
        origin_(space_.told_origin(mesh, "3mf")),
        colors_(output_colors(mesh)) {}

  Result<void> write() {
    DUBSAR_TRY(zip_.begin("3D/3dmodel.model"));
    text_ = kModelHead;
    write_colours();
    std::vector<PartitionId> bodies;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const PartitionId body = body_of(t);
      if (std::find(bodies.begin(), bodies.end(), body) == bodies.end()) bodies.push_back(body);
    }
    std::sort(bodies.begin(), bodies.end());
    progress_.begin("write 3mf", static_cast<std::int64_t>(mesh_.triangles.size()), "triangle");
    for (std::size_t k = 0; k < bodies.size(); ++k)
      DUBSAR_TRY(write_object(bodies[k], static_cast<int>(k) + kColours + 1));
    text_ += "</resources>\n<build>\n";
    for (std::size_t k = 0; k < bodies.size(); ++k)  // where a printer has its bed: nothing below 0
      text_ += fmt::format("<item objectid=\"{}\" transform=\"1 0 0 0 1 0 0 0 1 {} {} {}\"/>\n", k + kColours + 1,
                           -least_.x, -least_.y, -least_.z);
    text_ += "</build>\n</model>\n";
    DUBSAR_TRY(zip_.write(text_));
    return zip_.end();
  }

 private:
  PartitionId body_of(std::size_t triangle) const { return mesh_.partitions.body_of(mesh_.partition_of(triangle)); }

  Result<void> spill() {
    if (text_.size() < kPiece) return {};
    DUBSAR_TRY(zip_.write(text_));
    text_.clear();
    return progress_.cancelled() ? cancelled_error() : Result<void>();
  }

  void write_colours() {
    if (colors_.rgb.empty()) return;
    std::map<std::array<std::uint8_t, 3>, std::uint32_t> known;
    text_ += fmt::format("<m:colorgroup id=\"{}\">\n", kColours);
    color_of_.reserve(colors_.rgb.size());
    for (const auto& rgb : colors_.rgb) {
      const auto [found, is_new] = known.emplace(rgb, static_cast<std::uint32_t>(known.size()));
      if (is_new) text_ += fmt::format("<m:color color=\"#{:02X}{:02X}{:02X}\"/>\n", rgb[0], rgb[1], rgb[2]);
      color_of_.push_back(found->second);
    }
    text_ += "</m:colorgroup>\n";
  }

  Result<void> write_object(PartitionId body, int id) {
    const Partition* const row = mesh_.partitions.find(body);
    text_ += fmt::format("<object id=\"{}\" type=\"model\" name=\"{}\"{}>\n<mesh>\n<vertices>\n", id,
                         markup_text(row != nullptr ? row->body_name() : "object"),
                         color_of_.empty() ? "" : fmt::format(" pid=\"{}\" pindex=\"0\"", kColours));
    constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> local(mesh_.positions.size(), kUnused);
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (body_of(t) != body) continue;
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (local[v] != kUnused) continue;
        local[v] = count++;
        const glm::vec3 p(space_.exact_position(mesh_.positions[v]) - origin_);
        least_ = glm::min(least_, p);
        fmt::format_to(std::back_inserter(text_), "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p.x, p.y, p.z);
      }
      DUBSAR_TRY(spill());
    }
    text_ += "</vertices>\n<triangles>\n";
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (body_of(t) != body) continue;
      const Triangle& v = mesh_.triangles[t];
      fmt::format_to(std::back_inserter(text_), "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"", local[v[0]], local[v[1]],
                     local[v[2]]);
      if (!color_of_.empty())
        fmt::format_to(std::back_inserter(text_), " pid=\"{}\" p1=\"{}\" p2=\"{}\" p3=\"{}\"", kColours,
                       color_of_[v[0]], color_of_[v[1]], color_of_[v[2]]);
      text_ += "/>\n";
      if (t % kProgressStep == 0) progress_.advance(kProgressStep);
      DUBSAR_TRY(spill());
    }
    text_ += "</triangles>\n</mesh>\n</object>\n";
    return {};
  }

  ZipWriter& zip_;
  const TriMesh& mesh_;
  Progress& progress_;
  OutputSpace space_;
  glm::dvec3 origin_;
  VertexColors colors_;
  std::vector<std::uint32_t> color_of_;  ///< of each vertex: its place in the colour group
  glm::vec3 least_{std::numeric_limits<float>::max()};
  std::string text_;
};

}  // namespace

Result<void> write_3mf(const std::filesystem::path& path, const TriMesh& mesh, const MeshWriteOptions&,
                       Progress& progress) {
  DUBSAR_TRY(check_tri_mesh(mesh));
  if (mesh.triangles.empty()) return fail(ErrorKind::kUsage, "3mf: the surface has no triangles, expected some");
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path));
  ZipWriter zip(file);
  for (const auto& [name, text] : {std::pair{"[Content_Types].xml", kTypes}, {"_rels/.rels", kRelations}}) {
    DUBSAR_TRY(zip.begin(name));
    DUBSAR_TRY(zip.write(text));
    DUBSAR_TRY(zip.end());
  }
  ModelWriter model(zip, mesh, progress);
  DUBSAR_TRY(model.write());
  DUBSAR_TRY(zip.finish());
  DUBSAR_TRY(file.commit());
  progress.end();
  return {};
}

Result<TriMesh> parse_3mf(std::string_view, Progress&) {
  return fail(ErrorKind::kBadData, "3mf: files for printers are written, not read; expected PLY, OBJ, STL or GLB");
}

}  // namespace dubsar
