#include "core/exa/exa_decode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/base/system/budget.h"
#include "core/exa/exa_blocks.h"
#include "core/exa/labels/labelled_code.h"
#include "core/exa/offsets/offsets.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/patches/patches.h"
#include "core/exa/signs/sign_brick.h"
#include "core/exa/values/attributes.h"
#include "core/exa/values/exact.h"
#include "core/extract/extract.h"
#include "core/mesh/evidence.h"
#include "core/parts/labelled_model.h"
#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {
/// For ExaReader::chunks(): those that are not lost; all of them where nothing is.
std::function<bool(std::size_t)> all_but(const std::vector<std::uint8_t>& lost) {
  if (lost.empty()) return {};
  return [&lost](std::size_t i) { return i >= lost.size() || lost[i] == 0; };
}

std::span<float> floats_of(std::vector<glm::vec3>& items) {
  return {reinterpret_cast<float*>(items.data()), items.size() * 3};
}

Result<void> decode_positions(const ExaReader& reader, SurfaceModel& model, Progress& progress) {
  if (reader.has("ESCP")) {
    DUBSAR_ASSIGN(const ExaChunks escapes, reader.chunks("ESCP", kCodec));
    DUBSAR_TRY(decode_escapes(escapes.chunks, model.mesh, progress));
  }
  if (reader.has("POSN")) {
    DUBSAR_ASSIGN(const ExaChunks exact, reader.chunks("POSN", kCodec));
    DUBSAR_TRY(decode_floats(exact.chunks, 3, "positions", floats_of(model.mesh.positions), progress));
    for (const glm::vec3& p : model.mesh.positions)
      if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthestPlace))
        return fail(ErrorKind::kBadData, "exa: a vertex at {:g} {:g} {:g} found, expected at most {:g} grid steps", p.x,
                    p.y, p.z, kFarthestPlace);
  }
  return {};
}

Result<void> decode_normals(const ExaReader& reader, const ExaHeader& header, SurfaceModel& model, Progress& progress) {
  VertexAttributes& a = model.attributes;
  const std::size_t vertices = model.mesh.positions.size();
  if (header.normals == ExaNormals::kRecomputed) {
    DUBSAR_ASSIGN(a.normals, recomputed_normals(model.mesh, progress));
    if (!header.curvatures) return {};
    DUBSAR_ASSIGN(Curvatures k, principal_curvatures(model.mesh, a.normals, header.curvature, progress));
    a.k_min = std::move(k.k_min);
    a.k_max = std::move(k.k_max);
    return {};
  }
  if (reader.has("NORM")) {
    DUBSAR_ASSIGN(const ExaChunks normals, reader.chunks("NORM", kCodec));
    a.normals.resize(vertices);
    DUBSAR_TRY(decode_floats(normals.chunks, 3, "normals", floats_of(a.normals), progress));
  }
  if (reader.has("CURV")) {
    DUBSAR_ASSIGN(const ExaChunks curvatures, reader.chunks("CURV", kCodec));
    std::vector<float> pairs(2 * vertices);
    DUBSAR_TRY(decode_floats(curvatures.chunks, 2, "curvatures", pairs, progress));
    a.k_min.resize(vertices);
    a.k_max.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      a.k_min[v] = pairs[2 * v];
      a.k_max[v] = pairs[2 * v + 1];
    }
  }
  return {};
}

Result<void> decode_attributes(const ExaReader& reader, const ExaHeader& header, SurfaceModel& model,
                               Progress& progress) {
  const auto labels = [&](const char* type, ExaLabel label, std::vector<std::uint8_t>& out) -> Result<void> {
    if (!reader.has(type)) return {};
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks(type, kCodec));
    DUBSAR_ASSIGN(out, decode_labels(label, model.mesh, chunks.chunks, progress));
    return {};
  };
  if (header.shapes && !model.attributes.k_min.empty()) {
    model.attributes.shape = shape_classes(model.attributes.k_min, model.attributes.k_max);
  } else if (!header.shapes) {
    DUBSAR_TRY(labels("SHAP", ExaLabel::kShape, model.attributes.shape));
  }
  DUBSAR_TRY(labels("AMBO", ExaLabel::kLight, model.attributes.ao));
  DUBSAR_TRY(labels("EVID", ExaLabel::kEnum, model.attributes.evidence));
  std::uint8_t highest = 0;
  for (const std::uint8_t evidence : model.attributes.evidence) highest = std::max(highest, evidence);
  if (highest >= kEvidenceCount)
    return fail(ErrorKind::kBadData, "exa: evidence {} found, expected 0 to {}", highest, kEvidenceCount - 1);
  DUBSAR_TRY(labels("QPAR", ExaLabel::kPartition, model.quad_partition));
  if (reader.has("PART")) {
    DUBSAR_ASSIGN(const std::string text, reader.text("PART"));
    DUBSAR_ASSIGN(model.partitions, parse_exa_partitions(text));
  }
  if (reader.has("FILL")) {
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks("FILL", kCodec));
    DUBSAR_ASSIGN(std::vector<FillPatch> patches, decode_patches(chunks.chunks, {model.mesh, model.quad_partition}));
    if (reader.has("FEVI")) {
      DUBSAR_ASSIGN(const ExaChunks evidence, reader.chunks("FEVI", kCodec));
      DUBSAR_TRY(decode_patch_evidence(evidence.chunks, patches));
    }
    model.patches.insert(model.patches.end(), std::make_move_iterator(patches.begin()),  // behind the contact, if any
                         std::make_move_iterator(patches.end()));
  }
  if (reader.has("PROV")) {
    DUBSAR_ASSIGN(model.provenance, reader.text("PROV"));
  }
  return {};
}

/// Of a surface whose vertices are not those that were written: what follows from the surface alone.
Result<SurfaceModel> bare(SurfaceModel model, const ExaHeader& header, Progress& progress) {
  if (header.normals == ExaNormals::kNone) return model;
  VertexAttributes& a = model.attributes;
  DUBSAR_ASSIGN(a.normals, recomputed_normals(model.mesh, progress));
  DUBSAR_ASSIGN(Curvatures k, principal_curvatures(model.mesh, a.normals, header.curvature, progress));
  a.shape = shape_classes(k.k_min, k.k_max);
  a.k_min = std::move(k.k_min);
  a.k_max = std::move(k.k_max);
  return model;
}

Result<void> decode_offsets(const ExaReader& reader, const ExaHeader& header, const EdgeIndex& index,
                            SurfaceSamples& samples, Progress& progress, const ExaDamage& damage) {
  const std::vector<std::uint8_t>& lost = damage.offsets;
  DUBSAR_ASSIGN(const ExaChunks offsets, reader.chunks("OFFS", kCodec, all_but(lost)));
  DUBSAR_ASSIGN(const ExaChunks faces, reader.chunks("FACE", kCodec, all_but(damage.faces)));
  DUBSAR_TRY(decode_samples(offsets.chunks, faces.chunks, index, samples, progress,
                            {header.sums.far_sides, header.sums.far_sides, header.sums.far_sides}));
  for (std::size_t i = 0; i < lost.size(); ++i)
    if (lost[i] != 0) put_crossings_half_way(samples, index, i);
  return {};
}

}  // namespace

Result<LoadedSigns> load_signs(const ExaReader& reader, int level, const std::function<bool(std::size_t)>& wanted) {
  LoadedSigns loaded;
  loaded.chunks.late_bricks = reader.table().has(ExaFeature::kLateBricks);
  DUBSAR_ASSIGN(ExaChunks coarse, reader.chunks("SIGC", kCodec));
  loaded.chunks.coarse = coarse.chunks;
  loaded.blocks.push_back(std::move(coarse));
  for (int l = kBrickLevels - 1; l >= level; --l) {
    DUBSAR_ASSIGN(ExaChunks block, reader.chunks(kSignBlocks[static_cast<std::size_t>(l)], kCodec, wanted));
    loaded.chunks.bricks[static_cast<std::size_t>(l)] = block.chunks;
    loaded.blocks.push_back(std::move(block));
  }
  return loaded;
}

Result<BitVolume> decode_level_signs(const ExaReader& reader, const ExaHeader& header, int level, Progress& progress,
                                     const std::vector<std::uint8_t>& lost) {
  DUBSAR_ASSIGN(LoadedSigns loaded, load_signs(reader, level, all_but(lost)));
  loaded.chunks.lost = lost;
  return decode_signs(loaded.chunks, header.dims, level, std::nullopt,
                      most_coded_signs(static_cast<std::uint64_t>(header.samples.edges)), progress);
}

SurfaceSamples empty_samples(const ExaHeader& header) {
  SurfaceSamples samples;
  samples.dims = header.dims;
  samples.isovalue = header.isovalue;
  samples.offset_bits = header.offset_bits;
  samples.closed = header.closed;
  return samples;
}

Result<SurfaceModel> decode_model(const ExaReader& reader, const ExaReadOptions& options, Progress& progress,
                                  const ExaDamage* damage) {
  if (damage == nullptr) DUBSAR_TRY(reader.check_sums());  // before anything is decoded: damage costs next to nothing
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  DUBSAR_TRY(check_memory("exa", exa_memory_bound(header)));
  SurfaceModel model;
  model.frame = header.frame;
  model.samples = empty_samples(header);
  SurfaceSamples& samples = model.samples;
  DUBSAR_ASSIGN(samples.signs,
                decode_level_signs(reader, header, 0, progress, damage ? damage->signs : std::vector<std::uint8_t>()));
  DUBSAR_TRY(check_signs(samples));
  std::optional<EdgeIndex> index;  // of both steps that need it, gone when memory is needed for others
  DUBSAR_ASSIGN(index, EdgeIndex::create(samples));
  const SampleCounts counts = index->counts();
  if (damage == nullptr && (counts.edges != header.samples.edges || counts.faces != header.samples.faces))
    return fail(ErrorKind::kBadData, "exa: {} active edges and {} ambiguous faces found, the header says {} and {}",
                counts.edges, counts.faces, header.samples.edges, header.samples.faces);
  DUBSAR_TRY(decode_offsets(reader, header, *index, samples, progress, damage ? *damage : ExaDamage()));
  std::optional<LabelledMesh> labelled;
  if (header.sums.contact && (damage == nullptr || reader.has("LABL"))) {
    DUBSAR_ASSIGN(labelled, decode_labelled(reader, header, *index, damage == nullptr, model, progress));
  } else {
    DUBSAR_ASSIGN(model.mesh, build_quad_mesh(samples, *index, progress));
    model.mesh.embedded = header.sums.embedded;
    if (header.sums.contact)
      return bare(std::move(model), header, progress);  // its vertices are not those that were written
  }
  index.reset();
  if (model.mesh.vertex_count() != header.vertices || model.mesh.quad_count() != header.quads) {
    if (damage != nullptr) return bare(std::move(model), header, progress);
    return fail(ErrorKind::kBadData, "exa: {} vertices and {} x-quads found, the header says {} and {}",
                model.mesh.vertex_count(), model.mesh.quad_count(), header.vertices, header.quads);
  }
  if (!labelled) DUBSAR_TRY(decode_positions(reader, model, progress));
  if (damage == nullptr &&
      (position_sum_of(model) != header.sums.positions || quad_sum_of(model.mesh) != header.sums.quads))
    return fail(ErrorKind::kBadData, "exa: the mesh built from this file is not the one that was written");
  if (options.recompute || header.normals != ExaNormals::kRecomputed)
    DUBSAR_TRY(decode_normals(reader, header, model, progress));
  DUBSAR_TRY(decode_attributes(reader, header, model, progress));
  if (labelled) draw_labelled_mesh(model, std::move(*labelled));
  DUBSAR_ASSIGN(model.foreign, reader.foreign());
  return model;
}

}  // namespace dubsar
