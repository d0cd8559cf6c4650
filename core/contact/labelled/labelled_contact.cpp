#include "core/contact/labelled/labelled_contact.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/extract/labelled/quad_edges.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kNotOfSheet = 0xffffffffu;
constexpr int kSheetSteps = 4;          ///< farther than film_refine moves the contact
constexpr std::size_t kLeastClay = 64;  ///< nodes; less is a speck

/// Where along the edge between two nodes the density is least, 0..1: the vertex of a parabola.
float dip_along(const ContactBand& band, const Dips& dips, std::uint32_t n, std::uint32_t m, int axis) {
  if (dips.density.empty()) return 0.5f;
  const bool first = dips.density[n] <= dips.density[m];
  const std::uint32_t middle = first ? n : m;
  const std::uint32_t below = band.at(band.point(middle) - unit_step(axis)),
                      above = band.at(band.point(middle) + unit_step(axis));
  if (below == ContactBand::kNone || above == ContactBand::kNone) return 0.5f;
  const float a = dips.density[below], b = dips.density[middle], c = dips.density[above], bend = a - 2.0f * b + c;
  if (!(bend > 0.0f)) return 0.5f;
  return std::clamp((first ? 0.0f : 1.0f) + 0.5f * (a - c) / bend, 0.0f, 1.0f);
}

/// The crossings of the contact, of each of its edges: from the end at which the edge starts, 0..1.
template <class Along>
std::vector<float> crossings_along(const ContactBand& band, const ContactEdges& edges, const Along& along) {
  std::vector<float> crossings(edges.all().size(), 0.5f);
  parallel_for(static_cast<std::int64_t>(crossings.size()), 1 << 12, [&](std::int64_t i) {
    const GridEdge& e = edges.all()[static_cast<std::size_t>(i)];
    const glm::ivec3 p(e.x, e.y, e.z);
    const std::uint32_t n = band.at(p), m = band.at(p + unit_step(e.axis));
    if (n != ContactBand::kNone && m != ContactBand::kNone)
      crossings[static_cast<std::size_t>(i)] = along(n, m, e.axis);
  });
  return crossings;
}

std::vector<std::uint16_t> quantised(const std::vector<float>& along, int bits) {
  std::vector<std::uint16_t> offsets(along.size());
  const float steps = static_cast<float>(1 << bits);
  for (std::size_t i = 0; i < along.size(); ++i)
    offsets[i] = static_cast<std::uint16_t>(std::clamp(along[i] * steps, 0.0f, steps - 1.0f));
  return offsets;
}

/// The contact of a labelled mesh alone.
ContactSheet sheet_of(const ContactQuads& contact, const DividedClay& clay, const ContactEdges& edges,
                      const std::vector<float>& along) {
  ContactSheet sheet;
  const QuadMesh& mesh = contact.mesh;
  std::vector<std::uint32_t> id(mesh.positions.size(), kNotOfSheet);
  std::vector<std::uint32_t> inner;
  const auto each_corner = [&](const auto& visit) {
    for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
      const Polygon polygon = mesh.polygon(q);
      for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k) visit(polygon.vertex[k], q);
    }
  };
  each_corner([&](std::uint32_t v, std::uint32_t) {
    if (contact.at_air[v] == 0 || id[v] != kNotOfSheet) return;
    id[v] = static_cast<std::uint32_t>(sheet.dual_positions.size());
    sheet.dual_positions.push_back(mesh.positions[v]);
  });
  const auto dual = static_cast<std::uint32_t>(sheet.dual_positions.size());
  each_corner([&](std::uint32_t v, std::uint32_t) {
    if (contact.at_air[v] != 0 || id[v] != kNotOfSheet) return;
    id[v] = dual + static_cast<std::uint32_t>(inner.size());
    inner.push_back(v);
    sheet.mesh.added.push_back(mesh.positions[v]);
  });
  sheet.mesh.strength.assign(inner.size(), 0.0f);
  std::vector<float> count(inner.size(), 0.0f);
  const auto strength_of = [&](std::uint32_t q) {
    const GridEdge& e = edges.all()[q];
    const std::uint32_t n = clay.band.at({e.x, e.y, e.z}),
                        m = clay.band.at(glm::ivec3(e.x, e.y, e.z) + unit_step(e.axis));
    return n == ContactBand::kNone || m == ContactBand::kNone ? 0.0f
                                                              : std::max(clay.dips.strength[n], clay.dips.strength[m]);
  };
  each_corner([&](std::uint32_t v, std::uint32_t q) {
    if (id[v] < dual) return;
    sheet.mesh.strength[id[v] - dual] += strength_of(q);
    count[id[v] - dual] += 1.0f;
  });
  for (std::size_t i = 0; i < count.size(); ++i) sheet.mesh.strength[i] /= std::max(count[i], 1.0f);
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    const Polygon polygon = mesh.polygon(q);
    const auto n = static_cast<std::size_t>(polygon.size);
    const auto corner = [&](std::size_t k) { return id[polygon.vertex[n - 1 - k % n]]; };  // out of the tablet
    if (n == 4) {
      sheet.mesh.quads.push_back(static_cast<std::uint32_t>(sheet.mesh.triangles.size()));
      sheet.mesh.triangles.push_back({corner(0), corner(1), corner(2)});
      sheet.mesh.triangles.push_back({corner(0), corner(2), corner(3)});
      continue;
    }
    const GridEdge& e = edges.all()[q];
    glm::vec3 crossing(e.x, e.y, e.z);
    crossing[e.axis] += along[q];
    sheet.mesh.added.push_back(crossing);
    sheet.mesh.strength.push_back(strength_of(q));
    const auto middle = dual + static_cast<std::uint32_t>(sheet.mesh.added.size() - 1);
    for (std::size_t k = 0; k < n; ++k) sheet.mesh.triangles.push_back({middle, corner(k), corner(k + 1)});
  }
  return sheet;
}

/// The evidence of the nearest vertex of the sheet, by cubes of two steps.
class NearestEvidence {
 public:
  NearestEvidence(const ContactSheet& sheet, const Dims& dims)
      : sheet_(sheet),
        first_({dims.x / 2 + 1, dims.y / 2 + 1, dims.z / 2 + 1}, kNone),
        next_(sheet.mesh.added.size(), kNone) {
    for (std::size_t i = next_.size(); i-- > 0;) {
      const glm::ivec3 c = cube(sheet.mesh.added[i]);
      next_[i] = std::exchange(first_.at(c.x, c.y, c.z), static_cast<std::uint32_t>(i));
    }
  }
  std::uint8_t at(const glm::vec3& p) const {
    float least = INFINITY;
    std::uint8_t found = evidence_byte(Evidence::kInferred);
    const glm::ivec3 c = cube(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          for (std::uint32_t i = first_.get(c.x + x, c.y + y, c.z + z); i != kNone; i = next_[i]) {
            const float distance = glm::distance(p, sheet_.mesh.added[i]);
            if (distance < least) least = distance, found = sheet_.evidence[i];
          }
    return found;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static glm::ivec3 cube(const glm::vec3& p) { return glm::ivec3(glm::floor(glm::max(p, 0.0f) * 0.5f)); }
  const ContactSheet& sheet_;
  BrickMap<std::uint32_t> first_;    ///< vertex of each cube
  std::vector<std::uint32_t> next_;  ///< vertex in the same cube
};

/// The evidence of the vertices of the contact that are not at the air.
std::vector<std::uint8_t> evidence_of(const ContactQuads& contact, const ContactSheet& sheet, const Dims& dims) {
  const NearestEvidence known(sheet, dims);
  std::vector<std::uint32_t> asked;
  for (std::uint32_t v = 0; v < contact.at_air.size(); ++v)
    if (contact.at_air[v] == 0) asked.push_back(v);
  std::vector<std::uint8_t> evidence(asked.size());
  parallel_for(static_cast<std::int64_t>(asked.size()), 1 << 10, [&](std::int64_t i) {
    evidence[static_cast<std::size_t>(i)] = known.at(contact.mesh.positions[asked[static_cast<std::size_t>(i)]]);
  });
  return evidence;
}

/// The faces of the surface belong to whose clay is behind them, so that parts are closed: those of tablet and envelope
/// all, but where nothing says whose clay it is; those of a cavity that the contact reaches.
void give_faces_to_labels(SurfaceModel& model, const LabelledMesh& labelled, const EdgeIndex& index,
                          const PointLabels& labels, const ClayBeyond& beyond) {
  const PartitionId tablet = model.partitions.find(PartitionKind::kTablet)->id,
                    inside = model.partitions.find(PartitionKind::kEnvelopeInside)->id;
  const auto kind_of = [&](std::uint32_t q) { return model.partitions[model.quad_partition[q]].kind; };
  const auto each_vertex = [&](std::uint32_t q, const auto& visit) {
    const Polygon polygon = labelled.mesh.polygon(q);
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k) visit(polygon.vertex[k]);
  };
  std::vector<PartitionId> own(labelled.first_contact);
  std::vector<std::uint8_t> reached_first(labelled.first_contact, 0);
  each_quad_edge(model.samples.signs, index, [&](std::uint32_t q, const GridEdge& e) {
    glm::ivec3 clay(e.x, e.y, e.z);
    if (labels.get(clay.x, clay.y, clay.z) == PointLabel::kAir) clay += unit_step(e.axis);
    own[q] = labels.get(clay.x, clay.y, clay.z) == PointLabel::kTablet ? tablet : inside;
    const PartitionKind kind = kind_of(q);
    if (kind == PartitionKind::kPores) {
      each_vertex(q, [&](std::uint32_t v) {
        if (labelled.mesh.quads_of(v).back() >= labelled.first_contact) reached_first[q] = 1;
      });
      return;
    }
    const bool envelope = kind == PartitionKind::kEnvelopeInside || kind == PartitionKind::kEnvelopeOutside;
    if ((kind != PartitionKind::kTablet && !envelope) || !beyond.touches(clay)) return;
    if ((own[q] == tablet) != (kind == PartitionKind::kTablet)) model.quad_partition[q] = own[q];
  });
  std::vector<std::uint32_t> reached;
  for (std::uint32_t q = 0; q < reached_first.size(); ++q)
    if (reached_first[q] != 0) reached.push_back(q);
  for (const std::uint32_t q : reached) model.quad_partition[q] = own[q];
  for (std::size_t i = 0; i < reached.size(); ++i)
    each_vertex(reached[i], [&](std::uint32_t v) {
      for (const std::uint32_t q : labelled.mesh.quads_of(v)) {
        if (q >= labelled.first_contact || kind_of(q) != PartitionKind::kPores) continue;
        model.quad_partition[q] = own[q];
        reached.push_back(q);
      }
    });
}

}  // namespace

Result<ContactSheet> sheet_of_cut(const SurfaceModel& model, const DividedClay& clay, const BandDensity& density,
                                  const ShapeOptions& shape, Progress& progress) {
  const EnvelopeBits envelope = clay.beyond.labels(clay.side);
  const PointLabels labels(model.samples.signs, envelope);
  const ContactEdges edges(labels);
  const std::vector<float> along = crossings_along(clay.band, edges, [&](std::uint32_t n, std::uint32_t m, int axis) {
    return dip_along(clay.band, clay.dips, n, m, axis);
  });
  DUBSAR_ASSIGN(const ContactQuads cut, build_contact_quads(model.samples, clay.index, labels, edges,
                                                            quantised(along, model.samples.offset_bits)));
  ContactSheet sheet = sheet_of(cut, clay, edges, along);
  sheet.evidence = shape_interface(sheet.mesh, sheet.dual_positions, density, shape);
  if (progress.cancelled()) return cancelled_error();
  return sheet;
}

Result<LabelledContact> lay_labelled_contact(SurfaceModel& model, const DividedClay& clay, const ContactSheet& sheet,
                                             Progress& progress) {
  LabelledContact report;
  const int bits = model.samples.offset_bits;
  if (progress.cancelled()) return cancelled_error();
  const std::vector<float> distances = distances_from_sheet(clay.band, sheet.mesh, sheet.dual_positions);
  std::vector<ClaySide> side = clay.side;
  follow_sheet(clay.band, distances, kSheetSteps, kLeastClay, side);
  keep_whole(clay.band, clay.pores, side);
  for (std::size_t n = 0; n < side.size(); ++n) report.relabelled += side[n] != clay.side[n];
  report.pockets = relabel_faces(model, clay.rest, clay.faces, side);
  LabelledSurface& surface = model.labelled.emplace();
  surface.envelope = clay.beyond.labels(side);
  const PointLabels labels(model.samples.signs, surface.envelope);
  const ContactEdges edges(labels);
  surface.contact = quantised(crossings_along(clay.band, edges,
                                              [&](std::uint32_t n, std::uint32_t m, int axis) {
                                                const float a = distances[n], b = distances[m];
                                                if (!std::isfinite(a) || !std::isfinite(b) || !(a * b < 0.0f))
                                                  return dip_along(clay.band, clay.dips, n, m, axis);
                                                return a / (a - b);
                                              }),
                              bits);
  DUBSAR_ASSIGN(ContactQuads contact, build_contact_quads(model.samples, clay.index, labels, edges, surface.contact));
  surface.evidence = evidence_of(contact, sheet, model.samples.dims);
  DUBSAR_ASSIGN(report.mesh, put_labels(std::move(model.mesh), std::move(contact), model.samples, clay.index, labels));
  give_faces_to_labels(model, report.mesh, clay.index, labels, clay.beyond);
  report.film_vertices = std::ranges::count(surface.evidence, evidence_byte(Evidence::kFilm));
  report.inferred_vertices = static_cast<std::int64_t>(surface.evidence.size()) - report.film_vertices;
  log_debug("contact: {} cells with clay of both, {} points given to the other clay", report.mesh.cells.size(),
            report.relabelled);
  return report;
}

}  // namespace dubsar
