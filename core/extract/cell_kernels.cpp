#include "core/extract/cell_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/extract/cell_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE std::uint32_t count_bits(std::uint64_t word) {
  return static_cast<std::uint32_t>(__builtin_popcountll(word));
}

// The eight corners of 64 cells: bit i of corner[c] is the sign of corner c of cell i.
struct CornerWords {
  HWY_ALIGN std::uint64_t corner[8];
  HWY_INLINE unsigned signs(unsigned i) const {
    const hn::CappedTag<std::uint64_t, 8> d;
    unsigned signs = 0;
    for (std::size_t c = 0; c < 8; c += hn::Lanes(d)) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::TestBit(hn::Load(d, corner + c), hn::Set(d, std::uint64_t{1} << i)), bits);
      signs |= static_cast<unsigned>(bits[0]) << c;
    }
    return signs;
  }
};

// The four rows of points around a row of cells, word by word; rows outside the grid read as 0.
class PointRows {
 public:
  HWY_INLINE PointRows(const SurfaceSamples& samples, const CellRow& cells) : words_(samples.signs.words_per_row()) {
    for (int r = 0; r < 4; ++r) {
      const std::int64_t y = cells.j - 1 + r % 2, z = cells.k - 1 + r / 2;
      const bool inside = y >= 0 && z >= 0 && y < samples.dims.y && z < samples.dims.z;
      row_[r] = inside ? samples.signs.row(y, z) : nullptr;
    }
  }
  bool all_outside() const {
    std::uint64_t any = 0;
    for (const std::uint64_t* row : row_)
      for (std::int64_t w = 0; row != nullptr && w < words_; ++w) any |= row[w];
    return any == 0;
  }
  // Moves to the next word and returns the cells of mixed sign.
  HWY_INLINE std::uint64_t next() {
    ++at_;
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (int r = 0; r < 4; ++r) {
      before_[r] = here_[r];
      here_[r] = row_[r] != nullptr && at_ < words_ ? row_[r][at_] : 0;
      any |= here_[r];
      all &= here_[r];
    }
    const std::uint64_t mixed = (any | any << 1 | any_before_) & ~(all & (all << 1 | all_before_));
    any_before_ = any >> 63;
    all_before_ = all >> 63;
    return mixed;
  }
  HWY_INLINE CornerWords corners() const {
    CornerWords c;
    for (int r = 0; r < 4; ++r) {
      c.corner[2 * r] = here_[r] << 1 | before_[r] >> 63;
      c.corner[2 * r + 1] = here_[r];
    }
    return c;
  }

 private:
  const std::uint64_t* row_[4];
  std::int64_t words_, at_ = -1;
  std::uint64_t here_[4] = {}, before_[4] = {}, any_before_ = 0, all_before_ = 0;
};

// Numbers of the ambiguous faces of a row of cells. Faces of axis x: on both sides of a cell; of axis y and z: one
// stream for each side. Faces that touch the layer are never ambiguous.
struct FaceStreams {
  static constexpr int kStreams = 5;  // x, y low, y high, z low, z high
  std::uint32_t next[kStreams] = {};
  std::uint64_t word[kStreams] = {};

  HWY_INLINE FaceStreams(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& cells) {
    const std::int64_t y = cells.j - 1, z = cells.k - 1;
    const auto start = [&](std::int64_t row_y, std::int64_t row_z, std::size_t axis) -> std::uint32_t {
      const bool inside = row_y >= 0 && row_z >= 0 && row_y < samples.dims.y && row_z < samples.dims.z;
      return inside ? index.starts(row_y, row_z).faces[axis] : 0;
    };
    next[0] = start(y, z, 0);
    next[1] = start(y, z, 1);
    next[2] = start(y + 1, z, 1);
    next[3] = start(y, z, 2);
    next[4] = start(y, z + 1, 2);
  }
  HWY_INLINE void load(const CornerWords& p) {
    const auto ambiguous = [&](int a, int b, int c, int d) HWY_ATTR {
      return (p.corner[a] ^ p.corner[b]) & (p.corner[a] ^ p.corner[c]) & ~(p.corner[a] ^ p.corner[d]);
    };
    word[0] = ambiguous(1, 3, 5, 7);
    word[1] = ambiguous(0, 1, 4, 5);
    word[2] = ambiguous(2, 3, 6, 7);
    word[3] = ambiguous(0, 1, 2, 3);
    word[4] = ambiguous(4, 5, 6, 7);
  }
  HWY_INLINE void advance() {
    for (int s = 0; s < kStreams; ++s) next[s] += count_bits(word[s]);
  }
  // Decisions of the ambiguous faces of cell i, the lowest face first.
  HWY_INLINE unsigned resolution(unsigned faces, unsigned i, const std::uint8_t* joined) const {
    const std::uint64_t below = (std::uint64_t{1} << i) - 1;
    unsigned bits = 0, place = 0;
    for (unsigned f = 0; f < 6; ++f) {
      if (!(faces >> f & 1u)) continue;
      const unsigned s = f < 2 ? 0 : f - 1;
      // Of the stream along x the face below cell i is the last one before place i.
      const std::uint32_t number = next[s] + count_bits(word[s] & below) - (f == 0 ? 1 : 0);
      bits |= static_cast<unsigned>(joined[number]) << place++;
    }
    return bits;
  }
};

CellRowCounts count_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row) {
  const CellTable& table = CellTable::instance();
  PointRows points(samples, row);
  CellRowCounts counts;
  if (points.all_outside()) return counts;
  FaceStreams faces(samples, index, row);
  const std::int64_t words = samples.dims.x / 64 + 1;
  for (std::int64_t w = 0; w < words; ++w) {
    std::uint64_t rest = points.next();
    if (rest == 0) continue;
    const CornerWords corners = points.corners();
    faces.load(corners);
    for (; rest != 0; rest &= rest - 1) {
      const unsigned i = static_cast<unsigned>(__builtin_ctzll(rest));
      const unsigned signs = corners.signs(i), ambiguous = table.ambiguous_faces(signs);
      const unsigned resolution = ambiguous == 0 ? 0 : faces.resolution(ambiguous, i, samples.joined.data());
      const CellConfig& config = table.config(table.id(signs, resolution));
      counts.vertices += config.vertices;
      counts.incidences += config.incidences;
    }
    faces.advance();
  }
  return counts;
}

// Numbers of the real edges of a row of cells inside the grid: streams 0-3 along x at the four rows, 4-5 along y at
// z low and high, 6-7 along z at y low and high.
struct EdgeStreams {
  static constexpr int kStreams = 8;
  std::uint32_t next[kStreams] = {};
  std::uint64_t word[kStreams] = {};

  HWY_INLINE EdgeStreams(const EdgeIndex& index, const CellRow& cells, bool inside) {
    if (!inside) return;
    const std::int64_t y = cells.j - 1, z = cells.k - 1;
    for (int r = 0; r < 4; ++r) next[r] = index.starts(y + r % 2, z + r / 2).edges[0];
    next[4] = index.starts(y, z).edges[1];
    next[5] = index.starts(y, z + 1).edges[1];
    next[6] = index.starts(y, z).edges[2];
    next[7] = index.starts(y + 1, z).edges[2];
  }
  // Virtual edges along x are left out: `real` is the mask of the cells between two points.
  HWY_INLINE void load(const CornerWords& p, std::uint64_t real) {
    for (int r = 0; r < 4; ++r) word[r] = (p.corner[2 * r] ^ p.corner[2 * r + 1]) & real;
    word[4] = p.corner[1] ^ p.corner[3];
    word[5] = p.corner[5] ^ p.corner[7];
    word[6] = p.corner[1] ^ p.corner[5];
    word[7] = p.corner[3] ^ p.corner[7];
  }
  HWY_INLINE void advance() {
    for (int s = 0; s < kStreams; ++s) next[s] += count_bits(word[s]);
  }
  // Numbers of all twelve edges of cell i; those of inactive edges mean nothing.
  HWY_INLINE void quads(unsigned i, std::uint32_t (&quad)[12]) const {
    const std::uint64_t below = (std::uint64_t{1} << i) - 1;
    for (int s = 0; s < 4; ++s) quad[s] = next[s] + count_bits(word[s] & below);
    // Edges along y: e = 4 + (z high) + 2 (x high), along z: e = 8 + (x high) + 2 (y high). Of a stream along x the
    // edge at the low side of cell i, if active, is the last one before place i.
    constexpr int kHigh[4] = {6, 7, 9, 11}, kLow[4] = {4, 5, 8, 10};
    for (int s = 4; s < kStreams; ++s) {
      const std::uint32_t number = next[s] + count_bits(word[s] & below);
      quad[kHigh[s - 4]] = number;
      quad[kLow[s - 4]] = number - 1;
    }
  }
};

void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row,
                 const CellRowOutput& output) {
  const CellTable& table = CellTable::instance();
  const Dims& dims = samples.dims;
  PointRows points(samples, row);
  FaceStreams faces(samples, index, row);
  const bool inside = row.j >= 1 && row.k >= 1 && row.j < dims.y && row.k < dims.z;
  EdgeStreams edges(index, row, inside);
  QuadMesh& mesh = *output.mesh;
  std::uint32_t vertex = output.first_vertex, incidence = output.first_incidence;
  const int step = 2 << samples.offset_bits;  // one grid step in half quanta
  double inverse[13];
  for (int n = 1; n <= 12; ++n) inverse[n] = 1.0 / (static_cast<double>(n) * step);
  const std::int64_t words = dims.x / 64 + 1;

  for (std::int64_t w = 0; w < words; ++w) {
    std::uint64_t rest = points.next();
    if (rest == 0) continue;
    const CornerWords corners = points.corners();
    faces.load(corners);
    if (inside) {
      const std::int64_t left = dims.x - 64 * w;  // cells 1 .. nx - 1 lie between two points
      std::uint64_t real = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
      if (w == 0) real &= ~std::uint64_t{1};
      edges.load(corners, real);
    }
    for (; rest != 0; rest &= rest - 1) {
      const unsigned i = static_cast<unsigned>(__builtin_ctzll(rest));
      const std::int64_t cell = 64 * w + i;
      const unsigned signs = corners.signs(i), ambiguous = table.ambiguous_faces(signs);
      const unsigned resolution = ambiguous == 0 ? 0 : faces.resolution(ambiguous, i, samples.joined.data());
      const CellConfig& config = table.config(table.id(signs, resolution));

      // X-quads of the edges, and crossings along them in half quanta from the low corner of the cell.
      const bool in_layer = !inside || cell == 0 || cell == dims.x;
      std::uint32_t quad[12];
      int pinned[12];  // only of cells in the layer; negative: not pinned
      if (!in_layer) {
        edges.quads(i, quad);
      } else {
        for (unsigned active = config.active_edges; active != 0; active &= active - 1) {
          const unsigned e = static_cast<unsigned>(__builtin_ctz(active)), low = edge_corners(e)[0];
          const int axis = static_cast<int>(e / 4);
          const std::int64_t x = cell - 1 + (low & 1u), y = row.j - 1 + (low >> 1 & 1u), z = row.k - 1 + (low >> 2);
          quad[e] = index.quad_of(axis, x, y, z);
          pinned[e] = !index.is_virtual(axis, x, y, z) ? -1 : signs >> low & 1u ? 0 : step;
        }
      }

      for (unsigned p = 0; p < config.vertices; ++p, ++vertex) {
        const CellPiece& piece = config.pieces[p];
        int sum[3] = {piece.high[0] * step, piece.high[1] * step, piece.high[2] * step};
        mesh.first_incident[vertex] = incidence;
        std::uint32_t* incident = mesh.incident.data() + incidence;
        for (unsigned n = 0; n < piece.count; ++n) {
          const PieceEdge& edge = piece.edges[n];
          const std::uint32_t q = quad[edge.edge];
          incident[n] = q;
          sum[edge.axis] += in_layer && pinned[edge.edge] >= 0 ? pinned[edge.edge] : 2 * samples.offsets[q] + 1;
          if (!edge.is_second) {
            mesh.quads[q][edge.corner] = vertex;
          } else {
            output.doubled->push_back({q, vertex, edge.corner});
          }
        }
        incidence += piece.count;
        if (in_layer) std::sort(incident, incident + piece.count);
        const double scale = inverse[piece.count];
        mesh.positions[vertex] = {static_cast<float>(static_cast<double>(cell - 1) + sum[0] * scale),
                                  static_cast<float>(static_cast<double>(row.j - 1) + sum[1] * scale),
                                  static_cast<float>(static_cast<double>(row.k - 1) + sum[2] * scale)};
        if (output.in_layer != nullptr) (*output.in_layer)[vertex] = in_layer;
      }
    }
    faces.advance();
    edges.advance();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(count_cells);
HWY_EXPORT(write_cells);
}  // namespace

CellRowCounts count_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row) {
  return HWY_DYNAMIC_DISPATCH(count_cells)(samples, index, row);
}
void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row,
                 const CellRowOutput& output) {
  HWY_DYNAMIC_DISPATCH(write_cells)(samples, index, row, output);
}
}  // namespace dubsar
#endif
