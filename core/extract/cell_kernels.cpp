#include "core/extract/cell_kernels.h"

#include <algorithm>
#include <limits>

#include "core/extract/piece_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extract/cell_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/extract/mixed_cells-inl.h"

#ifndef DUBSAR_CELL_KERNELS_ROW
#define DUBSAR_CELL_KERNELS_ROW
namespace dubsar {
namespace {

/// Numbers of the ambiguous faces of a row of cells. Faces across x: on both sides of a cell; across y and z: one
/// stream for each side. Faces that touch the layer are never ambiguous.
class FaceStreams {
 public:
  FaceStreams(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& cells)
      : joined_(samples.joined.data()) {
    const std::int64_t y = cells.j - 1, z = cells.k - 1;
    const auto start = [&](std::int64_t row_y, std::int64_t row_z, std::size_t axis) -> std::uint32_t {
      const bool inside = row_y >= 0 && row_z >= 0 && row_y < samples.dims.y && row_z < samples.dims.z;
      return inside ? index.starts(row_y, row_z).faces[axis] : 0;
    };
    next_ = {start(y, z, 0), start(y, z, 1), start(y + 1, z, 1), start(y, z, 2), start(y, z + 1, 2)};
  }
  /// Decisions of the ambiguous faces of the next cell that has some, the lowest face first.
  unsigned take(unsigned ambiguous) {
    unsigned bits = 0, place = 0;
    for (; ambiguous != 0; ambiguous &= ambiguous - 1) {
      const auto f = static_cast<unsigned>(__builtin_ctz(ambiguous));
      // The face at the low side across x is the last one that a cell had at its high side.
      const std::uint32_t number = f == 0 ? next_[0] - 1 : next_[f - 1]++;
      bits |= static_cast<unsigned>(joined_[number]) << place++;
    }
    return bits;
  }

 private:
  const std::uint8_t* joined_;
  std::array<std::uint32_t, 5> next_;  // x, y low, y high, z low, z high
};

constexpr unsigned kEdgesAlongX = 0x00F, kEdgesAlongY = 0x0F0, kEdgesAlongZ = 0xF00;

/// The row that write_cells() works on: where its edges begin, which of them are virtual, what was written.
struct RowWriter {
  RowWriter(const SurfaceSamples& all, const EdgeIndex& edge_index, const CellRow& cells, const CellRowOutput& to)
      : samples(all),
        index(edge_index),
        row(cells),
        output(to),
        inverse(PieceTable::instance().inverse[static_cast<std::size_t>(all.offset_bits)].data()) {
    const std::int64_t y = row.j - 1, z = row.k - 1, ny = all.dims.y, nz = all.dims.z;
    inside = y >= 0 && z >= 0 && y + 1 < ny && z + 1 < nz;
    const std::array<std::int64_t, 2> ys = {y, y + 1}, zs = {z, z + 1};
    constexpr std::array<std::size_t, 4> kAlongX = {0, 3, 4, 7};
    for (std::size_t r = 0; r < 4; ++r) first[kAlongX[r]] = index.first_along(0, ys[r % 2], zs[r / 2]);
    for (std::size_t side = 0; side < 2; ++side) {
      first[side == 0 ? 1 : 5] = index.first_along(1, y, zs[side]);
      first[side == 0 ? 2 : 6] = index.first_along(2, ys[side], z);
    }
    if (y == -1 || y == ny - 1) virtual_edges |= kEdgesAlongY;
    if (z == -1 || z == nz - 1) virtual_edges |= kEdgesAlongZ;
  }
  /// One grid step in half quanta.
  unsigned step() const { return 2u << samples.offset_bits; }
  /// Cells 0 and nx have virtual edges along x.
  bool at_end(std::int64_t cell) const { return cell == 0 || cell == samples.dims.x; }

  const SurfaceSamples& samples;
  const EdgeIndex& index;
  const CellRow row;
  const CellRowOutput& output;
  bool inside = false;         ///< all four rows of points lie in the grid
  unsigned virtual_edges = 0;  ///< along y and z
  std::array<std::uint32_t, kEdgeStreams> first{};
  const double* inverse;  ///< of n: 1 / (n grid steps in half quanta)
};

/// Any vertex of any cell, edge by edge; returns how many it has. `at`: where the streams stand.
std::uint32_t write_piece(const RowWriter& to, std::int64_t cell, int id, unsigned number,
                          const std::array<std::uint32_t, kEdgeStreams>& at, std::uint32_t vertex,
                          std::uint32_t incidence) {
  const CellTable& table = CellTable::instance();
  const CellConfig& config = table.config(id);
  const CellPiece& piece = config.pieces[number];
  const unsigned edges = config.piece_edges[number], signs = table.signs(id), step = to.step();
  const unsigned in_layer = edges & (to.virtual_edges | (to.at_end(cell) ? kEdgesAlongX : 0u));
  QuadMesh& mesh = *to.output.mesh;
  unsigned sum[3] = {piece.high[0] * step, piece.high[1] * step, piece.high[2] * step};
  std::uint32_t* incident = mesh.incident.data() + incidence;
  const auto write = [&](const PieceEdge& edge, std::uint32_t quad) {
    *incident++ = quad;
    if (!edge.is_second)
      mesh.quads[quad][edge.corner] = vertex;
    else
      to.output.doubled->push_back({quad, vertex, edge.corner});
  };
  if (in_layer != edges) {
    for (const PieceEdge& edge : std::span(piece.edges).first(piece.count)) {
      if (in_layer >> edge.edge & 1u) continue;
      const std::uint32_t quad = at[kStreamOfEdge[edge.edge]] - kLowInStream[edge.edge];
      sum[edge.axis] += 2u * to.samples.offsets[quad] + 1u;
      write(edge, quad);
    }
  }
  if (in_layer != 0) {  // virtual edges have higher numbers; their crossings lie at the point inside
    for (const PieceEdge& edge : std::span(piece.edges).first(piece.count)) {
      if (!(in_layer >> edge.edge & 1u)) continue;
      sum[edge.axis] += signs >> edge_corners(edge.edge)[0] & 1u ? 0u : step;
      const bool along_x = kEdgesAlongX >> edge.edge & 1u;
      write(edge, along_x ? to.index.end_of_row(to.row.j - 1 + edge.edge % 2, to.row.k - 1 + edge.edge / 2, cell != 0)
                          : at[kStreamOfEdge[edge.edge]] - kLowInStream[edge.edge]);
    }
  }
  const double scale = to.inverse[piece.count];
  mesh.first_incident[vertex] = incidence;
  mesh.positions[vertex] = {static_cast<float>(static_cast<double>(cell - 1) + sum[0] * scale),
                            static_cast<float>(static_cast<double>(to.row.j - 1) + sum[1] * scale),
                            static_cast<float>(static_cast<double>(to.row.k - 1) + sum[2] * scale)};
  if (to.output.in_layer != nullptr) (*to.output.in_layer)[vertex] = !to.inside || to.at_end(cell);
  return piece.count;
}

}  // namespace
}  // namespace dubsar
#endif

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
#define DUBSAR_EIGHT_STREAMS 1
using Streams = hn::FixedTag<std::uint32_t, kEdgeStreams>;
using Bytes = hn::FixedTag<std::uint8_t, kEdgeStreams>;
using Four = hn::FixedTag<std::int32_t, 4>;

/// A row of cells inside the grid, whose edges are counted from the first one of its first row of points, so that their
/// numbers times four stay small.
class LaneRow {
 public:
  /// False where a read of two crossings at once could leave the list, and where numbers are too far apart.
  static bool fits(const RowWriter& to) {
    constexpr std::int64_t kLargestSlice = std::int64_t{1} << 26;
    const SurfaceSamples& samples = to.samples;
    return to.inside && samples.dims.slice() < kLargestSlice && to.first[0] > 0 &&
           to.index.starts(to.row.j, to.row.k).edges[1] < samples.offsets.size();
  }

  explicit LaneRow(const RowWriter& to)
      : base_(to.first[0]),
        end_(to.output.end_incidence),
        step_(static_cast<std::int32_t>(to.step())),
        crossings_(reinterpret_cast<const std::int32_t*>(to.samples.offsets.data() + base_ - 1)),
        quads_(to.output.mesh->quads[base_].data()),
        incident_(to.output.mesh->incident.data()),
        first_incident_(to.output.mesh->first_incident.data()),
        positions_(&to.output.mesh->positions.data()->x),
        inverse_(to.inverse),
        row_origin_{0.0, static_cast<double>(to.row.j - 1), static_cast<double>(to.row.k - 1), 0.0} {}

  HWY_INLINE hn::Vec<Streams> load(const std::array<std::uint32_t, kEdgeStreams>& numbers) const {
    const Streams d;
    return hn::Sub(hn::LoadU(d, numbers.data()), hn::Set(d, base_));
  }
  HWY_INLINE void store(const hn::Vec<Streams> at, std::array<std::uint32_t, kEdgeStreams>& numbers) const {
    const Streams d;
    hn::StoreU(hn::Add(at, hn::Set(d, base_)), d, numbers.data());
  }
  HWY_INLINE hn::Vec<Streams> pairs(const hn::Vec<Streams> at) const {
    const Streams d;
    const hn::RebindToSigned<Streams> di;
    return hn::BitCast(d, hn::GatherOffset(di, crossings_, hn::BitCast(di, hn::ShiftLeft<1>(at))));
  }

  /// One vertex. `at`: where the streams stand; `pairs`: the crossings there (high half) and before (low half).
  HWY_INLINE void write(std::int64_t cell, const PieceLanes& piece, const hn::Vec<Streams> at,
                        const hn::Vec<Streams> pairs, std::uint32_t vertex, std::uint32_t incidence) const {
    const Streams d;
    const hn::RebindToSigned<Streams> di;
    const Bytes d8;
    const hn::RebindToSigned<Bytes> di8;

    // X-quads, and the corners of them that are this vertex.
    const auto stream = hn::PromoteTo(d, hn::LoadU(d8, piece.stream.data()));
    const auto number = hn::TableLookupLanes(at, hn::IndicesFromVec(d, stream));
    const auto place = hn::PromoteTo(di, hn::LoadU(di8, piece.place.data()));
    const auto corner = hn::Add(hn::ShiftLeft<2>(number), hn::BitCast(d, place));
    const auto quad = hn::Add(hn::ShiftRight<2>(corner), hn::Set(d, base_));
    if (incidence + kEdgeStreams <= end_)
      hn::StoreU(quad, d, incident_ + incidence);  // what is too much is written again by the next vertex
    else
      hn::BlendedStore(quad, hn::FirstN(d, piece.count), d, incident_ + incidence);
    HWY_ALIGN std::uint32_t corners[kEdgeStreams];
    hn::Store(corner, d, corners);
    for (std::size_t n = 0; n < 6; ++n) quads_[corners[n]] = vertex;
    if (piece.count > 6) {
      quads_[corners[6]] = vertex;
      quads_[corners[7]] = vertex;
    }

    // The mean of its crossings.
    const Four d4;
    const hn::FixedTag<std::uint8_t, 4> d4u8;
    const hn::FixedTag<double, 4> dd;
    const hn::FixedTag<float, 4> df;
    const auto used = hn::And(pairs, hn::LoadU(d, piece.crossings.data()));
    const auto eight = hn::BitCast(di, hn::Add(hn::And(used, hn::Set(d, 0xFFFFu)), hn::ShiftRight<16>(used)));
    const auto four = hn::Add(hn::LowerHalf(d4, eight), hn::UpperHalf(d4, eight));  // x, y, z, x
    const auto offsets = hn::Add(four, hn::ShiftRightLanes<3>(d4, four));
    const auto on_axis = hn::PromoteTo(d4, hn::LoadU(d4u8, piece.on_axis.data()));
    const auto high_side = hn::PromoteTo(d4, hn::LoadU(d4u8, piece.high_side.data()));
    const auto sum = hn::Add(hn::Add(hn::ShiftLeft<1>(offsets), on_axis), hn::Mul(high_side, hn::Set(d4, step_)));
    const auto origin =
        hn::IfThenElse(hn::FirstN(dd, 1), hn::Set(dd, static_cast<double>(cell - 1)), hn::Load(dd, row_origin_));
    const auto mean = hn::Mul(hn::PromoteTo(dd, sum), hn::Set(dd, inverse_[piece.count]));
    const auto position = hn::DemoteTo(df, hn::Add(origin, mean));
    float* xyz = positions_ + std::size_t{vertex} * 3;
    const hn::FixedTag<float, 2> df2;
    hn::StoreU(hn::LowerHalf(df2, position), df2, xyz);
    xyz[2] = hn::ExtractLane(position, 2);
    first_incident_[vertex] = incidence;
  }

 private:
  std::uint32_t base_, end_;
  std::int32_t step_;  ///< one grid step in half quanta
  const std::int32_t* crossings_;
  std::uint32_t *quads_, *incident_, *first_incident_;
  float* positions_;
  const double* inverse_;
  HWY_ALIGN double row_origin_[4];
};

void write_lanes(const RowWriter& to, const ListedRow& listed) {
  const PieceTable& table = PieceTable::instance();
  const ConfigLanes* configs = table.configs.data();
  const PieceLanes* pieces = table.pieces.data();
  const Streams d;
  HWY_ALIGN constexpr std::uint32_t kAlongYz[kEdgeStreams] = {0, ~0u, ~0u, 0, 0, ~0u, ~0u, 0};
  const LaneRow lanes(to);
  auto at = lanes.load(to.first);
  std::uint32_t vertex = to.output.first_vertex, incidence = to.output.first_incidence;
  const std::int64_t last = to.samples.dims.x;
  for (std::size_t i = 0; i < listed.cell.size(); ++i) {
    const std::int64_t cell = listed.cell[i];
    const ConfigLanes& config = configs[listed.config[i]];
    const bool at_end = cell == 0 || cell == last;
    const auto pairs = lanes.pairs(at);
    for (unsigned p = 0; p < config.vertices; ++p, ++vertex) {
      const PieceLanes& piece = pieces[config.first_piece + p];
      if (piece.count != 0 && !at_end) {
        lanes.write(cell, piece, at, pairs, vertex, incidence);
        incidence += piece.count;
      } else {
        std::array<std::uint32_t, kEdgeStreams> numbers;
        lanes.store(at, numbers);
        incidence += write_piece(to, cell, listed.config[i], p, numbers, vertex, incidence);
      }
    }
    auto steps = hn::PromoteTo(d, hn::LoadU(Bytes(), config.steps.data()));
    if (at_end) steps = hn::And(steps, hn::Load(d, kAlongYz));
    at = hn::Add(at, steps);
  }
}
#endif

/// Layers, the ends of the list of crossings, and machines with small vectors.
void write_plain(const RowWriter& to, const ListedRow& listed) {
  const PieceTable& table = PieceTable::instance();
  std::array<std::uint32_t, kEdgeStreams> at = to.first;
  std::uint32_t vertex = to.output.first_vertex, incidence = to.output.first_incidence;
  for (std::size_t i = 0; i < listed.cell.size(); ++i) {
    const std::int64_t cell = listed.cell[i];
    const ConfigLanes& config = table.configs[listed.config[i]];
    for (unsigned p = 0; p < config.vertices; ++p, ++vertex)
      incidence += write_piece(to, cell, listed.config[i], p, at, vertex, incidence);
    const bool along_x = !to.at_end(cell);
    for (std::size_t s = 0; s < at.size(); ++s)
      if (along_x || s % 4 == 1 || s % 4 == 2) at[s] += config.steps[s];
  }
}

}  // namespace

CellRowCounts list_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, CellList& list) {
  const CellTable& table = CellTable::instance();
  const ConfigLanes* configs = PieceTable::instance().configs.data();
  CellRowCounts counts;
  FaceStreams faces(samples, index, row);
  for_mixed_cells(samples, row,
                  [&](std::span<const std::uint32_t> bits, std::int64_t first, const auto& signs) HWY_ATTR {
                    const std::size_t before = list.cell.size();
                    list.cell.resize(before + bits.size());
                    list.config.resize(before + bits.size());
                    std::uint32_t* cell = list.cell.data() + before;
                    std::uint16_t* config = list.config.data() + before;
                    std::uint32_t vertices = 0, incidences = 0;
                    for (std::size_t i = 0; i < bits.size(); ++i) {
                      const unsigned corners = signs(bits[i]), ambiguous = table.ambiguous_faces(corners);
                      const int id = table.id(corners, ambiguous == 0 ? 0u : faces.take(ambiguous));
                      cell[i] = static_cast<std::uint32_t>(first + bits[i]);
                      config[i] = static_cast<std::uint16_t>(id);
                      vertices += configs[id].vertices;
                      incidences += configs[id].incidences;
                    }
                    counts.cells += static_cast<std::uint32_t>(bits.size());
                    counts.vertices += vertices;
                    counts.incidences += incidences;
                  });
  return counts;
}

void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, const ListedRow& cells,
                 const CellRowOutput& output) {
  const RowWriter to(samples, index, row, output);
#ifdef DUBSAR_EIGHT_STREAMS
  if (LaneRow::fits(to)) return write_lanes(to, cells);
#undef DUBSAR_EIGHT_STREAMS
#endif
  write_plain(to, cells);
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(list_cells);
HWY_EXPORT(write_cells);
}  // namespace

CellRowCounts list_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, CellList& list) {
  return HWY_DYNAMIC_DISPATCH(list_cells)(samples, index, row, list);
}
void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, const ListedRow& cells,
                 const CellRowOutput& output) {
  HWY_DYNAMIC_DISPATCH(write_cells)(samples, index, row, cells, output);
}
}  // namespace dubsar
#endif
