#include <algorithm>
#include <array>
#include <cmath>

#include "core/exa/chunks.h"
#include "core/exa/exa_blocks.h"
#include "core/exa/exa_file.h"
#include "core/exa/labels/labelled_code.h"
#include "core/exa/offsets/offsets.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/signs/sign_brick.h"
#include "core/exa/values/attributes.h"
#include "core/exa/values/exact.h"
#include "core/extract/extract.h"
#include "core/mesh/evidence.h"
#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {
/// The mesh of a model without labels must be the one that its samples give.
Result<void> check_rebuilt(const SurfaceModel& model, const QuadMesh& rebuilt) {
  if (model.mesh.quads != rebuilt.quads || model.mesh.doubled != rebuilt.doubled ||
      model.mesh.positions.size() != rebuilt.positions.size())
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the samples give ({} vertices)",
                model.mesh.positions.size(), rebuilt.positions.size());
  return {};
}

/// The arrays of a model must fit its mesh.
Result<void> check_model(const SurfaceModel& model) {
  const auto vertices = static_cast<std::size_t>(model.mesh.vertex_count());
  const auto quads = static_cast<std::size_t>(model.mesh.quad_count());
  const auto fits = [](std::size_t size, std::size_t count) { return size == 0 || size == count; };
  const VertexAttributes& a = model.attributes;
  if (!fits(a.normals.size(), vertices) || !fits(a.k_min.size(), vertices) || a.k_min.size() != a.k_max.size() ||
      !fits(a.shape.size(), vertices) || !fits(a.ao.size(), vertices) || !fits(a.evidence.size(), vertices) ||
      !fits(model.quad_partition.size(), quads))
    return fail(ErrorKind::kInternal, "exa: arrays do not fit the mesh of {} vertices and {} x-quads", vertices, quads);
  const auto finite = [](float v) { return std::isfinite(v); };
  const auto all_finite = [&](const std::vector<glm::vec3>& items) {
    return std::all_of(items.begin(), items.end(),
                       [&](const glm::vec3& p) { return finite(p.x) && finite(p.y) && finite(p.z); });
  };
  if (!all_finite(model.mesh.positions) || !all_finite(a.normals) ||
      !std::all_of(a.k_min.begin(), a.k_min.end(), finite) || !std::all_of(a.k_max.begin(), a.k_max.end(), finite))
    return fail(ErrorKind::kBadData,
                "exa: a position, normal or curvature is not finite, so the surface is not stored");
  for (const glm::vec3& p : model.mesh.positions)
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kFarthestPlace)
      return fail(ErrorKind::kBadData, "exa: a vertex lies at {:g} {:g} {:g}, beyond all grids, so it is not stored",
                  p.x, p.y, p.z);
  const auto largest = [](const std::vector<std::uint8_t>& v) {
    return v.empty() ? 0 : int{*std::max_element(v.begin(), v.end())};
  };
  if (largest(a.shape) > highest_label(ExaLabel::kShape) || largest(a.ao) > highest_label(ExaLabel::kLight) ||
      largest(a.evidence) >= int{kEvidenceCount} || largest(model.quad_partition) > highest_label(ExaLabel::kPartition))
    return fail(ErrorKind::kInternal, "exa: a shape class, ambient light, evidence or partition is out of range");
  const auto carried = [](const ForeignBlock& block) { return block.type == "FILL"; };
  if (!model.labelled && !model.patches.empty() && std::none_of(model.foreign.begin(), model.foreign.end(), carried))
    return fail(ErrorKind::kInternal, "exa: {} fill patches found, which no file says; labels close parts",
                model.patches.size());
  return {};
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

/// Can a reader compute the normals and curvatures itself?
Result<void> find_normals(const SurfaceModel& model, ExaHeader& header, Progress& progress) {
  const VertexAttributes& a = model.attributes;
  header.normals = a.normals.empty() && a.k_min.empty() ? ExaNormals::kNone : ExaNormals::kExact;
  header.curvatures = !a.k_min.empty();
  if (a.normals.empty()) return {};
  if (model.settled_sum != 0 && model.settled_sum == settled_sum(model)) {
    header.normals = ExaNormals::kRecomputed;  // settle_for_exa() did
    return {};
  }
  {
    DUBSAR_ASSIGN(const std::vector<glm::vec3> normals, recomputed_normals(model.mesh, progress));
    if (!same(normals, a.normals)) return {};
  }
  for (const CurvatureMethod method : {CurvatureMethod::kFit, CurvatureMethod::kPairs}) {
    header.curvature = method;
    if (a.k_min.empty()) {
      header.normals = ExaNormals::kRecomputed;
      return {};
    }
    DUBSAR_ASSIGN(const Curvatures k, principal_curvatures(model.mesh, a.normals, method, progress));
    if (!same(k.k_min, a.k_min) || !same(k.k_max, a.k_max)) continue;
    header.normals = ExaNormals::kRecomputed;
    return {};
  }
  header.curvature = CurvatureMethod::kFit;
  return {};
}

std::span<const float> floats_of(const std::vector<glm::vec3>& items) {
  return {reinterpret_cast<const float*>(items.data()), items.size() * 3};
}

constexpr auto kLabelled = static_cast<std::uint16_t>(ExaFeature::kLabels);

/// Has the grid a last slice that begins where a brick would?
bool ends_with_a_brick(const Dims& dims) {
  const auto ends = [](std::int64_t points) { return points > 1 && points % kBrickCells == 1; };
  return ends(dims.x) || ends(dims.y) || ends(dims.z);
}

class BlockList {
 public:
  void add(const char* type, bool required, const std::vector<std::string>& chunks,
           std::uint16_t needs = kExaMajorBefore) {
    blocks_.push_back({type, kCodec, required ? kExaRequired : std::uint16_t{0},
                       static_cast<std::uint32_t>(chunks.size()), join_chunks(chunks), needs});
  }
  void add(BlockList others) {
    for (ExaBlock& block : others.blocks_) blocks_.push_back(std::move(block));
  }
  std::vector<ExaBlock> take() { return std::move(blocks_); }

 private:
  std::vector<ExaBlock> blocks_;
};

void add_positions(const SurfaceModel& model, const QuadMesh& base, BlockList& blocks, Progress& progress) {
  if (same(base.positions, model.mesh.positions)) return;
  if (const auto escapes = encode_escapes(base, model.mesh.positions, progress)) {
    blocks.add("ESCP", true, *escapes);
    return;
  }
  blocks.add("POSN", true, encode_floats(floats_of(model.mesh.positions), 3, progress));
}

/// Signs, offsets, face decisions.
Result<void> add_samples(const SurfaceSamples& samples, BlockList& blocks, Progress& progress) {
  DUBSAR_ASSIGN(const SignCode signs, encode_signs(samples.signs, progress));
  blocks.add("SIGC", true, signs.coarse);
  for (std::size_t level = kBrickLevels; level-- > 0;) blocks.add(kSignBlocks[level], true, signs.bricks[level]);
  DUBSAR_ASSIGN(const SampleCode code, encode_samples(samples, progress));
  blocks.add("FACE", true, code.faces);
  blocks.add("OFFS", true, code.offsets);
  return {};
}

/// Shape classes, light, partitions of x-quads.
void add_labels(const SurfaceModel& model, const ExaHeader& header, BlockList& blocks, Progress& progress) {
  const VertexAttributes& a = model.attributes;
  const auto labels = [&](const char* type, ExaLabel label, const std::vector<std::uint8_t>& values) {
    if (!values.empty()) blocks.add(type, false, encode_labels(label, model.mesh, values, progress));
  };
  if (!header.shapes) labels("SHAP", ExaLabel::kShape, a.shape);
  labels("AMBO", ExaLabel::kLight, a.ao);
  labels("QPAR", ExaLabel::kPartition, model.quad_partition);
}

}  // namespace

Result<std::vector<ExaBlock>> encode_exa(const SurfaceModel& model, Progress& progress) {
  BlockList positions, labelled;
  ExaHeader header;
  DUBSAR_TRY(check_model(model));
  if (model.labelled) {
    DUBSAR_ASSIGN(const LabelledCode code, encode_labelled(model, progress));
    labelled.add("LABL", true, code.labels, kLabelled);
    labelled.add("LOFS", true, code.offsets);
    labelled.add("LEVI", true, code.evidence);
    if (!code.escapes.empty()) positions.add("ESCP", true, code.escapes);
    if (!code.exact.empty()) positions.add("POSN", true, code.exact);
    header.sums.contact = code.counts;
  } else {
    DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
    DUBSAR_TRY(check_rebuilt(model, base));
    add_positions(model, base, positions, progress);
  }
  header.frame = model.frame;
  header.dims = model.samples.dims;
  header.isovalue = model.samples.isovalue;
  header.offset_bits = model.samples.offset_bits;
  header.closed = model.samples.closed;
  header.sums.far_sides = ends_with_a_brick(model.samples.dims);
  header.sums.embedded = model.mesh.embedded;
  header.vertices = model.mesh.vertex_count();
  header.quads = model.mesh.quad_count();
  header.samples.edges = static_cast<std::int64_t>(model.samples.offsets.size());
  header.samples.faces = static_cast<std::int64_t>(model.samples.joined.size());
  header.sums.positions = position_sum_of(model);
  header.sums.quads = quad_sum_of(model.mesh);
  header.tool = "dubsar " DUBSAR_VERSION;
  DUBSAR_TRY(find_normals(model, header, progress));
  const VertexAttributes& a = model.attributes;
  header.shapes = header.curvatures && !a.shape.empty() && same(a.shape, shape_classes(a.k_min, a.k_max));

  BlockList blocks;
  DUBSAR_ASSIGN(std::string text, exa_header_json(header));
  blocks.add("HEAD", true, {std::move(text)}, header.sums.far_sides ? kLabelled : kExaMajorBefore);
  if (!model.partitions.empty()) {
    DUBSAR_ASSIGN(std::string table, exa_partitions_json(model.partitions));
    blocks.add("PART", false, {std::move(table)});
  }
  if (!model.provenance.empty()) blocks.add("PROV", false, {model.provenance});
  DUBSAR_TRY(add_samples(model.samples, blocks, progress));
  blocks.add(std::move(labelled));
  blocks.add(std::move(positions));
  if (header.normals == ExaNormals::kExact) {
    if (!a.normals.empty()) blocks.add("NORM", false, encode_floats(floats_of(a.normals), 3, progress));
    if (header.curvatures) {
      std::vector<float> pairs(2 * a.k_min.size());
      for (std::size_t v = 0; v < a.k_min.size(); ++v) {
        pairs[2 * v] = a.k_min[v];
        pairs[2 * v + 1] = a.k_max[v];
      }
      blocks.add("CURV", false, encode_floats(pairs, 2, progress));
    }
  }
  add_labels(model, header, blocks, progress);
  if (!a.evidence.empty()) blocks.add("EVID", false, encode_labels(ExaLabel::kEnum, model.mesh, a.evidence, progress));
  std::vector<ExaBlock> all = blocks.take();
  for (const ForeignBlock& block : model.foreign)
    all.push_back({block.type, block.codec, block.flags, block.chunks, block.bytes});
  if (progress.cancelled()) return cancelled_error();
  return all;
}

}  // namespace dubsar
