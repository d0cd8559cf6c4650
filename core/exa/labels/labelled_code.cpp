#include "core/exa/labels/labelled_code.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/base/system/parallel.h"
#include "core/exa/chunks.h"
#include "core/exa/exa_blocks.h"
#include "core/exa/labels/contact_offsets.h"
#include "core/exa/labels/label_plane.h"
#include "core/exa/values/attributes.h"
#include "core/exa/values/exact.h"
#include "core/exa/values/same_bits.h"
#include "core/mesh/evidence.h"
#include "core/parts/labelled_model.h"

namespace dubsar {
namespace {

/// Edges between clay of both, without a list of them.
std::int64_t count_contact(const PointLabels& labels) {
  const Dims& d = labels.inside().dims();
  const std::int64_t words = labels.inside().words_per_row();
  return parallel_reduce(
      d.y * d.z, 256, std::int64_t{0},
      [&](std::int64_t begin, std::int64_t end) {
        std::int64_t found = 0;
        for (std::int64_t r = begin; r < end; ++r) {
          const std::int64_t y = r % d.y, z = r / d.y;
          for (std::int64_t w = 0; w < words; ++w) {
            const std::uint64_t tablet = labels.tablet_word(w, y, z), envelope = labels.envelope_word(w, y, z);
            if ((tablet | envelope) == 0) continue;
            const auto add = [&](std::uint64_t tablet_beside, std::uint64_t envelope_beside) {
              found += std::popcount((tablet & envelope_beside) | (envelope & tablet_beside));
            };
            add(tablet >> 1 | labels.tablet_word(w + 1, y, z) << 63, envelope >> 1 | labels.envelope_word(w + 1, y, z)
                                                                                         << 63);
            add(labels.tablet_word(w, y + 1, z), labels.envelope_word(w, y + 1, z));
            add(labels.tablet_word(w, y, z + 1), labels.envelope_word(w, y, z + 1));
          }
        }
        return found;
      },
      [](std::int64_t a, std::int64_t b) { return a + b; });
}

/// The x-quads of the contact, vertices that are not at the air first, in their order: what is known of these is coded
/// after that of their neighbours.
struct InnerMesh {
  QuadMesh mesh;
  std::size_t inner = 0;
};
InnerMesh inner_mesh(const LabelledMesh& labelled) {
  const std::size_t count = labelled.mesh.positions.size();
  std::vector<std::uint32_t> number(count, LabelledMesh::kNoVertex);
  InnerMesh result;
  for (std::size_t v = labelled.first_mixed; v < count; ++v)
    if (!labelled.is_at_air(v)) number[v] = static_cast<std::uint32_t>(result.inner++);
  auto next = static_cast<std::uint32_t>(result.inner);
  const auto number_of = [&](std::uint32_t v) {
    if (number[v] == LabelledMesh::kNoVertex) number[v] = next++;
    return number[v];
  };
  QuadMesh& mesh = result.mesh;
  for (std::size_t q = labelled.first_contact; q < labelled.mesh.quads.size(); ++q) {
    auto quad = labelled.mesh.quads[q];
    for (std::uint32_t& v : quad) v = number_of(v);
    mesh.quads.push_back(quad);
  }
  for (const DoubledCorner& d : labelled.mesh.doubled)
    if (d.quad >= labelled.first_contact)
      mesh.doubled.push_back({d.quad - labelled.first_contact, number_of(d.vertex), d.corner});
  mesh.positions.resize(next);
  mesh.build_incidence();
  return result;
}

std::uint32_t contact_sum_of(const SurfaceModel& model) {
  const auto bytes_of = [](const auto* items, std::size_t count) {
    return std::string_view(reinterpret_cast<const char*>(items), count * sizeof(*items));
  };
  const LabelledSurface& surface = *model.labelled;
  std::uint32_t sum = crc32_of(bytes_of(model.patches.front().extra_positions.data(), surface.evidence.size()));
  sum = crc32_of(bytes_of(surface.contact.data(), surface.contact.size()), sum);
  return crc32_of(bytes_of(surface.evidence.data(), surface.evidence.size()), sum);
}

std::span<float> floats_of_places(std::vector<glm::vec3>& items) {
  return {reinterpret_cast<float*>(items.data()), items.size() * 3};
}

}  // namespace

Result<LabelledMesh> labelled_base(const SurfaceModel& model, const EdgeIndex& index, Progress& progress) {
  const PointLabels labels(model.samples.signs, model.labelled->envelope);
  const ContactEdges edges(labels);
  return build_labelled_mesh(model.samples, index, labels, edges, model.labelled->contact, progress);
}

Result<LabelledCode> encode_labelled(const SurfaceModel& model, Progress& progress) {
  const LabelledSurface& surface = *model.labelled;
  if (surface.envelope.dims() != model.samples.dims || model.patches.empty())
    return fail(ErrorKind::kInternal,
                "exa: a surface of labels has labels of another grid, or no patch for its contact");
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(model.samples));
  const PointLabels labels(model.samples.signs, surface.envelope);
  const ContactEdges edges(labels);
  LabelledCode code;
  DUBSAR_ASSIGN(code.labels, encode_label_plane(model.samples.signs, surface.envelope, progress));
  DUBSAR_ASSIGN(LabelledMesh base, build_labelled_mesh(model.samples, index, labels, edges, surface.contact, progress));
  if (base.mesh.positions.size() != model.mesh.positions.size() + surface.evidence.size() ||
      model.patches.front().extra_positions.size() < surface.evidence.size())
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the labels give ({} vertices)",
                model.mesh.positions.size(), base.mesh.positions.size() - surface.evidence.size());
  if (!is_mesh_at_air(model.mesh, base))
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the labels give",
                model.mesh.positions.size());
  DUBSAR_ASSIGN(code.offsets, encode_contact_offsets({model.samples, index, labels, edges}, surface.contact, progress));
  const InnerMesh inner = inner_mesh(base);
  code.evidence = encode_labels(ExaLabel::kEnum, inner.mesh, surface.evidence, progress);
  std::vector<glm::vec3> places = labelled_places(model, base);
  if (!std::equal(places.begin(), places.end(), base.mesh.positions.begin(), same_bits)) {
    if (auto escapes = encode_escapes(base.mesh, places, progress))
      code.escapes = std::move(*escapes);
    else
      code.exact = encode_floats(floats_of_places(places), 3, progress);
  }
  code.counts = {static_cast<std::int64_t>(surface.contact.size()), static_cast<std::int64_t>(surface.evidence.size()),
                 contact_sum_of(model)};
  if (progress.cancelled()) return cancelled_error();
  return code;
}

Result<LabelledMesh> decode_labelled(const ExaReader& reader, const ExaHeader& header, const EdgeIndex& index,
                                     bool exact_sums, SurfaceModel& model, Progress& progress) {
  if (!header.closed) return fail(ErrorKind::kBadData, "exa: labels of an open surface found, expected a closed one");
  DUBSAR_ASSIGN(const std::string table, reader.text("PART"));
  DUBSAR_ASSIGN(model.partitions, parse_exa_partitions(table));
  const ExaContact& counts = *header.sums.contact;
  LabelledSurface& surface = model.labelled.emplace();
  {
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks("LABL", kCodec));
    DUBSAR_ASSIGN(surface.envelope,
                  decode_label_plane(chunks.chunks, model.samples.signs,
                                     most_coded_labels(static_cast<std::uint64_t>(header.samples.edges),
                                                       static_cast<std::uint64_t>(counts.edges)),
                                     progress));
  }
  const PointLabels labels(model.samples.signs, surface.envelope);
  if (const std::int64_t found = count_contact(labels); found != counts.edges)
    return fail(ErrorKind::kBadData, "exa: {} edges of the contact found, the header says {}", found, counts.edges);
  const ContactEdges edges(labels);
  {
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks("LOFS", kCodec));
    DUBSAR_ASSIGN(surface.contact,
                  decode_contact_offsets(chunks.chunks, {model.samples, index, labels, edges}, progress));
  }
  DUBSAR_ASSIGN(LabelledMesh labelled,
                build_labelled_mesh(model.samples, index, labels, edges, surface.contact, progress));
  const InnerMesh inner = inner_mesh(labelled);
  if (static_cast<std::int64_t>(inner.inner) != counts.vertices)
    return fail(ErrorKind::kBadData, "exa: {} vertices of the contact alone found, the header says {}", inner.inner,
                counts.vertices);
  surface.evidence.assign(inner.inner, evidence_byte(Evidence::kInferred));
  if (exact_sums || reader.has("LEVI")) {
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks("LEVI", kCodec));
    DUBSAR_ASSIGN(surface.evidence, decode_labels(ExaLabel::kEnum, inner.mesh, chunks.chunks, progress,
                                                  static_cast<std::int64_t>(inner.inner)));
    const auto highest = std::max_element(surface.evidence.begin(), surface.evidence.end());
    if (highest != surface.evidence.end() && *highest >= kEvidenceCount)
      return fail(ErrorKind::kBadData, "exa: evidence {} found, expected 0 to {}", *highest, kEvidenceCount - 1);
  }
  if (reader.has("ESCP")) {
    DUBSAR_ASSIGN(const ExaChunks escapes, reader.chunks("ESCP", kCodec));
    DUBSAR_TRY(decode_escapes(escapes.chunks, labelled.mesh, progress));
  }
  if (reader.has("POSN")) {
    DUBSAR_ASSIGN(const ExaChunks exact, reader.chunks("POSN", kCodec));
    DUBSAR_TRY(decode_floats(exact.chunks, 3, "positions", floats_of_places(labelled.mesh.positions), progress));
    for (const glm::vec3& p : labelled.mesh.positions)
      if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthestPlace))
        return fail(ErrorKind::kBadData, "exa: a vertex at {:g} {:g} {:g} found, expected at most {:g} grid steps", p.x,
                    p.y, p.z, kFarthestPlace);
  }
  labelled.mesh.embedded = header.sums.embedded;
  DUBSAR_TRY(put_labelled_mesh(model, labelled));
  if (exact_sums && contact_sum_of(model) != counts.sum)
    return fail(ErrorKind::kBadData, "exa: the contact built from this file is not the one that was written");
  return labelled;
}

}  // namespace dubsar
