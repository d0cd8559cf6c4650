#include "core/extract/labelled/labelled_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/extract/row_kernels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kMixedGrain = 1 << 12;

/// Cells with clay of both, in order.
std::vector<MixedCell> list_mixed_cells(const PointLabels& labels) {
  const Dims& dims = labels.inside().dims();
  const std::int64_t rows_y = dims.y + 1, rows = rows_y * (dims.z + 1), grain = rows_per_chunk(dims.x);
  std::vector<std::vector<MixedCell>> chunks(static_cast<std::size_t>((rows + grain - 1) / grain));
  parallel_chunks(rows, grain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<MixedCell>& found = chunks[static_cast<std::size_t>(begin / grain)];
    for (std::int64_t r = begin; r < end; ++r) {
      const std::int64_t y = r % rows_y - 1, z = r / rows_y - 1;
      std::uint64_t tablet_before = 0, envelope_before = 0;
      for (std::int64_t w = 0; w <= dims.x / 64; ++w) {
        std::uint64_t tablet = 0, envelope = 0;
        for (const std::int64_t dz : {0, 1})
          for (const std::int64_t dy : {0, 1}) {
            tablet |= labels.tablet_word(w, y + dy, z + dz);
            envelope |= labels.envelope_word(w, y + dy, z + dz);
          }
        std::uint64_t mixed =
            (tablet | tablet << 1 | tablet_before >> 63) & (envelope | envelope << 1 | envelope_before >> 63);
        tablet_before = tablet;
        envelope_before = envelope;
        for (; mixed != 0; mixed &= mixed - 1)
          found.push_back({static_cast<std::int32_t>(64 * w + std::countr_zero(mixed)) - 1,
                           static_cast<std::int32_t>(y), static_cast<std::int32_t>(z), 0, 0});
      }
    }
  });
  std::vector<MixedCell> all;
  for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

/// Decisions of faces that clay and air share in turn, by their place.
class JoinedFaces {
 public:
  JoinedFaces(const SurfaceSamples& samples, const EdgeIndex& index) : samples_(samples), index_(index) {}

  /// Of an ambiguous face that starts at a point of the grid.
  bool joined(unsigned axis, std::int64_t x, std::int64_t y, std::int64_t z) const {
    const BitVolume& signs = samples_.signs;
    const std::uint64_t* here = signs.row(y, z);
    std::uint32_t number = index_.starts(y, z).faces[axis];
    const std::uint64_t* u = axis == 0 ? signs.row(y + 1, z) : axis == 1 ? signs.row(y, z + 1) : signs.row(y + 1, z);
    const std::uint64_t* v = axis == 0 ? signs.row(y, z + 1) : nullptr;
    const std::uint64_t* uv = axis == 0 ? signs.row(y + 1, z + 1) : nullptr;
    for (std::int64_t w = 0; w <= x >> 6; ++w) {
      std::uint64_t ambiguous;
      if (axis == 0) {
        ambiguous = (here[w] ^ u[w]) & (here[w] ^ v[w]) & ~(here[w] ^ uv[w]);
      } else {
        const auto next = [&](const std::uint64_t* row) {
          return row[w] >> 1 | (w + 1 < signs.words_per_row() ? row[w + 1] << 63 : 0);
        };
        ambiguous = (here[w] ^ u[w]) & (here[w] ^ next(here)) & ~(here[w] ^ next(u));
      }
      if (w == x >> 6) ambiguous &= (std::uint64_t{1} << (x & 63)) - 1;
      number += static_cast<std::uint32_t>(std::popcount(ambiguous));
    }
    return samples_.joined[number] != 0;
  }

 private:
  const SurfaceSamples& samples_;
  const EdgeIndex& index_;
};

class MixedCells {
 public:
  /// Without `edges` those of the contact have no numbers.
  MixedCells(const SurfaceSamples& samples, const EdgeIndex& index, const PointLabels& labels,
             const ContactEdges* edges, std::span<const std::uint16_t> contact)
      : samples_(samples), index_(index), labels_(labels), edges_(edges), contact_(contact), faces_(samples, index) {}

  CornerLabels corners(const MixedCell& cell) const {
    CornerLabels corners{};
    for (unsigned c = 0; c < 8; ++c) {
      const auto [x, y, z] = corner(cell, c);
      corners[c] = static_cast<std::uint8_t>(labels_.get(x, y, z));
    }
    return corners;
  }

  std::uint16_t config(const MixedCell& cell) const {
    const CornerLabels at = corners(cell);
    const int labelling = LabelledCellTable::labelling(at);
    unsigned bits = 0, place = 0;
    for (unsigned faces = table_.ambiguous_faces(labelling); faces != 0; faces &= faces - 1, ++place) {
      const auto f = static_cast<unsigned>(std::countr_zero(faces));
      const unsigned axis = f / 2, first = (f & 1u) << axis, second = first | 1u << ((axis + 1) % 3);
      if (at[first] != 0 && at[second] != 0) continue;  // the tablet is joined
      const auto [x, y, z] = corner(cell, first);
      bits |= unsigned{faces_.joined(axis, x, y, z)} << place;
    }
    return static_cast<std::uint16_t>(table_.id(labelling, bits));
  }

  struct Crossing {
    std::uint32_t quad = 0;
    unsigned along = 0;  ///< from the start of the edge, half quanta
  };
  Crossing crossing(const MixedCell& cell, unsigned edge) const {
    const auto [low, high] = edge_corners(edge);
    const unsigned axis = edge / 4;
    const auto [x, y, z] = corner(cell, low);
    const bool from_clay = labels_.get(x, y, z) != PointLabel::kAir;
    const bool to_clay = labels_.get(x + (axis == 0), y + (axis == 1), z + (axis == 2)) != PointLabel::kAir;
    if (from_clay && to_clay) {
      const std::uint32_t number = edges_ == nullptr ? 0 : edges_->number(axis, x, y, z);
      return {first_contact() + number, contact_.empty() ? step() / 2 : 2u * contact_[number] + 1u};
    }
    const std::uint32_t quad = index_.quad_of(static_cast<int>(axis), x, y, z);
    if (index_.is_virtual(static_cast<int>(axis), x, y, z)) return {quad, from_clay ? 0 : step()};
    return {quad, 2u * samples_.offsets[quad] + 1u};
  }
  bool is_contact(const Crossing& crossing) const { return crossing.quad >= first_contact(); }
  std::uint32_t first_contact() const {
    return static_cast<std::uint32_t>(index_.counts().edges + index_.virtual_edges());
  }

  /// Edges of the cell between clay and air.
  std::uint16_t edges_at_air(const MixedCell& cell) const {
    const CornerLabels at = corners(cell);
    unsigned edges = 0;
    for (unsigned e = 0; e < 12; ++e) {
      const auto [low, high] = edge_corners(e);
      if ((at[low] == 0) != (at[high] == 0)) edges |= 1u << e;
    }
    return static_cast<std::uint16_t>(edges);
  }

  /// The mean of crossings, as build_quad_mesh() has it.
  glm::vec3 mean_of(const MixedCell& cell, std::uint16_t edges) const {
    std::array<unsigned, 3> sum{};
    unsigned count = 0;
    for (unsigned e = 0; e < 12; ++e) {
      if (!(edges >> e & 1u)) continue;
      ++count;
      const unsigned axis = e / 4;
      sum[axis] += crossing(cell, e).along;
      if (e & 1u) sum[(axis + 1) % 3] += step();
      if (e & 2u) sum[(axis + 2) % 3] += step();
    }
    const double scale = 1.0 / (static_cast<double>(count) * step());
    return {static_cast<float>(cell.x + sum[0] * scale), static_cast<float>(cell.y + sum[1] * scale),
            static_cast<float>(cell.z + sum[2] * scale)};
  }

 private:
  static std::array<std::int64_t, 3> corner(const MixedCell& cell, unsigned c) {
    return {cell.x + std::int64_t{c & 1u}, cell.y + std::int64_t{c >> 1 & 1u}, cell.z + std::int64_t{c >> 2}};
  }
  unsigned step() const { return 2u << samples_.offset_bits; }

  const LabelledCellTable& table_ = LabelledCellTable::instance();
  const SurfaceSamples& samples_;
  const EdgeIndex& index_;
  const PointLabels& labels_;
  const ContactEdges* edges_;
  std::span<const std::uint16_t> contact_;
  JoinedFaces faces_;
};

/// Visits the active edges of a cell: visit(edge, crossing, corner).
template <class Visit>
void each_active_edge(const MixedCells& mixed, const MixedCell& cell, const LabelledConfig& config,
                      const Visit& visit) {
  for (unsigned e = 0; e < 12; ++e)
    if (config.active_edges >> e & 1u) visit(e, mixed.crossing(cell, e), config.corners[e]);
}

template <class Visit>
void each_mixed_cell(const std::vector<MixedCell>& cells, const Visit& visit) {
  parallel_for(static_cast<std::int64_t>(cells.size()), kMixedGrain,
               [&](std::int64_t i) { visit(static_cast<std::size_t>(i)); });
}

/// Doubled corners that cells find, in lists of some cells each.
using DoubledLists = std::vector<std::vector<DoubledCorner>>;

void add_doubled(const DoubledLists& lists, std::vector<DoubledCorner>& doubled) {
  for (const auto& list : lists) doubled.insert(doubled.end(), list.begin(), list.end());
  std::sort(doubled.begin(), doubled.end(), [](const DoubledCorner& a, const DoubledCorner& b) {
    return a.quad != b.quad ? a.quad < b.quad : a.corner < b.corner;
  });
}

/// For the vertices of a cell that are at the air: the vertices of the mesh without labels whose place they take, and
/// whose places go.
struct Heirs {
  const QuadMesh& before;
  std::vector<std::uint8_t>& dropped;      ///< of each vertex before
  std::vector<std::uint32_t>& unlabelled;  ///< of each vertex of mixed cells

  void look(const MixedCells& mixed, const MixedCell& cell, const LabelledConfig& config) const {
    each_active_edge(mixed, cell, config,
                     [&](unsigned, const MixedCells::Crossing& crossing, const CellCorner& corner) {
                       if (mixed.is_contact(crossing)) return;
                       const Polygon polygon = before.polygon(crossing.quad);
                       std::uint32_t first = LabelledMesh::kNoVertex;
                       for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k) {
                         if (polygon.corner[k] != corner.corner) continue;
                         dropped[polygon.vertex[k]] = 1;
                         first = std::min(first, polygon.vertex[k]);
                       }
                       for (const unsigned piece : {corner.first, corner.second})
                         unlabelled[cell.first_vertex + piece] = std::min(unlabelled[cell.first_vertex + piece], first);
                     });
  }
};

}  // namespace

Result<ContactQuads> build_contact_quads(const SurfaceSamples& samples, const EdgeIndex& index,
                                         const PointLabels& labels, const ContactEdges& edges,
                                         const std::vector<std::uint16_t>& contact) {
  if (!contact.empty() && contact.size() != edges.all().size())
    return fail(ErrorKind::kBadData, "extract: {} crossings of the contact found, {} expected", contact.size(),
                edges.all().size());
  ContactQuads result;
  result.cells = list_mixed_cells(labels);
  const MixedCells mixed(samples, index, labels, &edges, contact);
  const LabelledCellTable& table = LabelledCellTable::instance();
  each_mixed_cell(result.cells, [&](std::size_t i) { result.cells[i].config = mixed.config(result.cells[i]); });
  std::size_t vertices = 0;
  for (MixedCell& cell : result.cells) {
    cell.first_vertex = static_cast<std::uint32_t>(vertices);
    vertices += table.config(cell.config).vertices;
  }
  if (vertices >= LabelledMesh::kNoVertex)
    return fail(ErrorKind::kTryAgain, "extract: the contact has {} vertices, at most {} can be numbered", vertices,
                LabelledMesh::kNoVertex - 1);
  QuadMesh& mesh = result.mesh;
  mesh.embedded = true;
  mesh.positions.resize(vertices);
  mesh.quads.resize(edges.all().size());
  result.triple.resize(vertices);
  result.at_air.resize(vertices);
  DoubledLists doubled(result.cells.size() / kMixedGrain + 1);
  each_mixed_cell(result.cells, [&](std::size_t i) {
    const MixedCell& cell = result.cells[i];
    const LabelledConfig& config = table.config(cell.config);
    const std::uint16_t air = mixed.edges_at_air(cell);
    for (unsigned p = 0; p < config.vertices; ++p) {
      const auto own = static_cast<std::uint16_t>(config.piece_edges[p] & air);
      mesh.positions[cell.first_vertex + p] = mixed.mean_of(cell, own != 0 ? own : config.piece_edges[p]);
      result.triple[cell.first_vertex + p] = config.triple >> p & 1u;
      result.at_air[cell.first_vertex + p] = own != 0;
    }
    each_active_edge(mixed, cell, config,
                     [&](unsigned, const MixedCells::Crossing& crossing, const CellCorner& corner) {
                       if (!mixed.is_contact(crossing)) return;
                       const std::uint32_t quad = crossing.quad - mixed.first_contact();
                       mesh.quads[quad][corner.corner] = cell.first_vertex + corner.first;
                       if (corner.second != corner.first)
                         doubled[i / kMixedGrain].push_back({quad, cell.first_vertex + corner.second, corner.corner});
                     });
  });
  add_doubled(doubled, mesh.doubled);
  mesh.mark_doubled();
  return result;
}

Result<LabelledMesh> put_labels(QuadMesh unlabelled, ContactQuads contact, const SurfaceSamples& samples,
                                const EdgeIndex& index, const PointLabels& labels) {
  if (!samples.closed)
    return fail(ErrorKind::kUsage, "extract: an open surface found, labels need one that is closed at the border");
  constexpr std::uint32_t kNoVertex = LabelledMesh::kNoVertex;
  LabelledMesh result;
  result.mesh = std::move(unlabelled);
  QuadMesh& mesh = result.mesh;
  const std::size_t before = mesh.positions.size(), own = contact.mesh.positions.size();
  result.first_contact = static_cast<std::uint32_t>(mesh.quads.size());
  result.cells = std::move(contact.cells);
  result.triple = std::move(contact.triple);
  result.at_air = std::move(contact.at_air);
  if (mesh.quads.size() + contact.mesh.quads.size() >= kNoVertex || before + own >= kNoVertex)
    return fail(ErrorKind::kTryAgain, "extract: the labelled surface has {} vertices, at most {} can be numbered",
                before + own, kNoVertex - 1);
  const MixedCells mixed(samples, index, labels, nullptr, {});
  const LabelledCellTable& table = LabelledCellTable::instance();

  // The vertices that these cells had without labels go.
  std::vector<std::uint8_t> dropped(before, 0);
  std::vector<std::uint32_t> heirs(own, kNoVertex);
  each_mixed_cell(result.cells, [&](std::size_t i) {
    Heirs{mesh, dropped, heirs}.look(mixed, result.cells[i], table.config(result.cells[i].config));
  });
  auto new_number = large_array<std::vector<std::uint32_t>>(before);
  std::vector<glm::vec3> positions;
  resize_large(positions, before + own);
  resize_large(result.unlabelled, before + own);
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < before; ++v) {
    new_number[v] = dropped[v] ? kNoVertex : next;
    if (dropped[v]) continue;
    positions[next] = mesh.positions[v];
    result.unlabelled[next++] = static_cast<std::uint32_t>(v);
  }
  result.first_mixed = next;
  result.extracted = std::move(contact.mesh.positions);
  std::ranges::copy(result.extracted, positions.begin() + next);
  std::ranges::copy(heirs, result.unlabelled.begin() + next);
  positions.resize(next + own);
  result.unlabelled.resize(next + own);
  mesh.positions = std::move(positions);

  std::vector<std::array<std::uint32_t, 4>> quads;
  resize_large(quads, mesh.quads.size() + contact.mesh.quads.size());
  parallel_for(mesh.quad_count(), 1 << 14, [&](std::int64_t i) {
    const auto q = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < 4; ++k) quads[q][k] = new_number[mesh.quads[q][k]];
  });
  mesh.quads = std::move(quads);
  std::vector<DoubledCorner> doubled;
  for (const DoubledCorner& d : mesh.doubled)
    if (new_number[d.vertex] != kNoVertex) doubled.push_back({d.quad, new_number[d.vertex], d.corner});
  for (MixedCell& cell : result.cells) cell.first_vertex += result.first_mixed;
  DoubledLists more(result.cells.size() / kMixedGrain + 1);
  each_mixed_cell(result.cells, [&](std::size_t i) {
    const MixedCell& cell = result.cells[i];
    each_active_edge(
        mixed, cell, table.config(cell.config),
        [&](unsigned, const MixedCells::Crossing& crossing, const CellCorner& corner) {
          if (mixed.is_contact(crossing)) return;
          mesh.quads[crossing.quad][corner.corner] = cell.first_vertex + corner.first;
          if (corner.second != corner.first)
            more[i / kMixedGrain].push_back({crossing.quad, cell.first_vertex + corner.second, corner.corner});
        });
  });
  add_doubled(more, doubled);
  for (std::size_t i = 0; i < contact.mesh.quads.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      mesh.quads[result.first_contact + i][k] = contact.mesh.quads[i][k] + result.first_mixed;
  for (const DoubledCorner& d : contact.mesh.doubled)
    doubled.push_back({d.quad + result.first_contact, d.vertex + result.first_mixed, d.corner});
  mesh.doubled = std::move(doubled);
  mesh.build_incidence();
  return result;
}

Result<LabelledMesh> build_labelled_mesh(const SurfaceSamples& samples, const EdgeIndex& index,
                                         const PointLabels& labels, const ContactEdges& edges,
                                         const std::vector<std::uint16_t>& contact, Progress& progress) {
  if (!samples.closed)
    return fail(ErrorKind::kUsage, "extract: an open surface found, labels need one that is closed at the border");
  DUBSAR_ASSIGN(ContactQuads quads, build_contact_quads(samples, index, labels, edges, contact));
  DUBSAR_ASSIGN(QuadMesh mesh, build_quad_mesh(samples, index, progress));
  return put_labels(std::move(mesh), std::move(quads), samples, index, labels);
}

}  // namespace dubsar
