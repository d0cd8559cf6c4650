#include "core/mesh/pores_by_body.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace dubsar {
namespace {

using Winding = std::array<int, PartitionTable::kMost>;  // by the id of a body

constexpr int kCells = 128;                       // along the longest side of the mesh
constexpr glm::dvec2 kAside{0.000317, 0.000271};  // grid steps: lines of sight meet no vertices and no edges

/// A connected piece of pores or crumbs.
struct Piece {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  std::int64_t triangles = 0;
  PartitionId body = PartitionTable::kNone;
  glm::dvec3 middle() const { return 0.5 * (low + high); }
};

struct Pores {
  std::vector<std::size_t> triangles;  ///< of the mesh
  std::vector<std::uint32_t> piece;    ///< of each of them
  std::vector<Piece> pieces;
};

bool is_pores(const TriMesh& mesh, std::size_t triangle) {
  const Partition* const row = mesh.partitions.find(mesh.partition_of(triangle));
  return row != nullptr && row->kind == PartitionKind::kPores;
}

bool finite(const TriMesh& mesh, const Triangle& t) {
  return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
    const glm::vec3& p = mesh.positions[v];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

Pores pores_of(const TriMesh& mesh) {
  Pores out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_pores(mesh, t)) out.triangles.push_back(t);
  if (out.triangles.empty()) return out;
  std::vector<std::uint32_t> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const std::size_t t : out.triangles)
    for (const std::uint32_t v : mesh.triangles[t]) {
      const std::uint32_t a = find(v), b = find(mesh.triangles[t][0]);
      root[std::max(a, b)] = std::min(a, b);
    }
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const std::size_t t : out.triangles) {
    const auto [at, made] =
        numbers.try_emplace(find(mesh.triangles[t][0]), static_cast<std::uint32_t>(out.pieces.size()));
    if (made) out.pieces.emplace_back();
    out.piece.push_back(at->second);
    Piece& piece = out.pieces[at->second];
    ++piece.triangles;
    for (const std::uint32_t v : mesh.triangles[t]) {
      piece.low = glm::min(piece.low, glm::dvec3(mesh.positions[v]));
      piece.high = glm::max(piece.high, glm::dvec3(mesh.positions[v]));
    }
  }
  return out;
}

/// Cells of the box of the mesh.
struct CellGrid {
  glm::dvec3 low{0.0};
  double side = 1.0;  ///< grid steps
  glm::ivec3 count{1};

  explicit CellGrid(const TriMesh& mesh) {
    glm::dvec3 from(std::numeric_limits<double>::infinity()), to(-from);
    for (const Triangle& t : mesh.triangles)
      if (finite(mesh, t))
        for (const std::uint32_t v : t) {
          from = glm::min(from, glm::dvec3(mesh.positions[v]));
          to = glm::max(to, glm::dvec3(mesh.positions[v]));
        }
    if (!(from.x <= to.x)) return;
    const glm::dvec3 size = to - from;
    low = from;
    side = std::max({size.x, size.y, size.z, 1e-9}) / kCells;
    count = glm::ivec3(glm::floor(size / side)) + 1;
  }
  glm::ivec3 of(const glm::dvec3& p) const {
    return glm::clamp(glm::ivec3(glm::floor((p - low) / side)), glm::ivec3(0), count - 1);
  }
  glm::dvec3 centre(const glm::ivec3& cell) const { return low + (glm::dvec3(cell) + 0.5) * side; }
};

/// Windings of every body around the middle of each piece.
std::vector<Winding> windings(const TriMesh& mesh, const std::vector<PartitionId>& bodies, const Pores& pores,
                              const CellGrid& grid) {
  std::vector<Winding> out(pores.pieces.size(), Winding{});
  std::vector<std::vector<std::uint32_t>> columns(static_cast<std::size_t>(grid.count.x) *
                                                  static_cast<std::size_t>(grid.count.y));
  const auto column = [&](int x, int y) -> std::vector<std::uint32_t>& {
    return columns[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.count.x) + static_cast<std::size_t>(x)];
  };
  std::vector<glm::dvec3> middles;
  for (std::size_t i = 0; i < pores.pieces.size(); ++i) {
    middles.push_back(pores.pieces[i].middle() + glm::dvec3(kAside, 0.0));
    const glm::ivec3 cell = grid.of(middles.back());
    column(cell.x, cell.y).push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const PartitionId body = bodies[t];
    if (body == PartitionTable::kNone || !finite(mesh, corners)) continue;
    std::array<glm::dvec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) p[c] = mesh.positions[corners[c]];
    const glm::ivec3 from = grid.of(glm::min(glm::min(p[0], p[1]), p[2])),
                     to = grid.of(glm::max(glm::max(p[0], p[1]), p[2]));
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x)
        for (const std::uint32_t i : column(x, y)) {
          const auto edge = [&](std::size_t a, std::size_t b) {
            const glm::dvec3 u = p[b] - p[a], v = middles[i] - p[a];
            return u.x * v.y - u.y * v.x;
          };
          const double e0 = edge(1, 2), e1 = edge(2, 0), e2 = edge(0, 1), sum = e0 + e1 + e2;
          const bool inside = (e0 > 0 && e1 > 0 && e2 > 0) || (e0 < 0 && e1 < 0 && e2 < 0);
          if (!inside || (e0 * p[0].z + e1 * p[1].z + e2 * p[2].z) / sum <= middles[i].z) continue;
          out[i][body] += sum > 0 ? 1 : -1;
        }
  }
  return out;
}

/// Vertices of all bodies by the cells that they lie in.
class NearestBody {
 public:
  NearestBody(const TriMesh& mesh, const std::vector<PartitionId>& bodies, const CellGrid& grid) : grid_(grid) {
    std::map<std::array<int, 3>, std::size_t> cells;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (bodies[t] == PartitionTable::kNone || !finite(mesh, mesh.triangles[t])) continue;
      const glm::dvec3 at(mesh.positions[mesh.triangles[t][0]]);
      const glm::ivec3 cell = grid.of(at);
      const auto [found, made] = cells.try_emplace({cell.x, cell.y, cell.z}, cells_.size());
      if (made) cells_.push_back({grid.centre(cell), {}});
      cells_[found->second].places.push_back({at, bodies[t]});
    }
  }
  PartitionId of(const glm::dvec3& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Cell& cell : cells_) least = std::min(least, glm::distance(cell.centre, p));
    double nearest = std::numeric_limits<double>::infinity();
    PartitionId out = PartitionTable::kNone;
    for (const Cell& cell : cells_) {
      if (glm::distance(cell.centre, p) > least + std::sqrt(3.0) * grid_.side) continue;
      for (const auto& [at, body] : cell.places)
        if (const double d = glm::distance(at, p); d < nearest) nearest = d, out = body;
    }
    return out;
  }

 private:
  struct Cell {
    glm::dvec3 centre;
    std::vector<std::pair<glm::dvec3, PartitionId>> places;
  };
  const CellGrid& grid_;
  std::vector<Cell> cells_;
};

/// Of each triangle, the first partition of its body; none of pores and of those without a row.
std::vector<PartitionId> bodies_of(const TriMesh& mesh) {
  std::array<PartitionId, 256> body_of{};
  for (std::size_t id = 0; id < body_of.size(); ++id) {
    const Partition* const row = mesh.partitions.find(static_cast<PartitionId>(id));
    body_of[id] =
        row == nullptr || row->kind == PartitionKind::kPores ? PartitionTable::kNone : mesh.partitions.body_of(row->id);
  }
  std::vector<PartitionId> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) out[t] = body_of[mesh.partition_of(t)];
  return out;
}

}  // namespace

void divide_pores(TriMesh& mesh) {
  const Partition* const row = mesh.partitions.find(PartitionKind::kPores);
  if (row == nullptr || mesh.triangle_partition.empty()) return;
  const std::vector<PartitionId> bodies = bodies_of(mesh);
  if (std::all_of(bodies.begin(), bodies.end(), [](PartitionId body) { return body == PartitionTable::kNone; })) return;
  Pores pores = pores_of(mesh);
  if (pores.pieces.empty()) return;
  const CellGrid grid(mesh);
  const std::vector<Winding> around = windings(mesh, bodies, pores, grid);
  std::optional<NearestBody> nearest;
  std::array<std::int64_t, PartitionTable::kMost> triangles{};
  for (std::size_t i = 0; i < pores.pieces.size(); ++i) {
    Piece& piece = pores.pieces[i];
    for (std::size_t body = 0; body < around[i].size() && piece.body == PartitionTable::kNone; ++body)
      if (around[i][body] != 0) piece.body = static_cast<PartitionId>(body);
    if (piece.body == PartitionTable::kNone) {
      if (!nearest) nearest.emplace(mesh, bodies, grid);
      piece.body = nearest->of(piece.middle());
    }
    triangles[piece.body] += piece.triangles;
  }
  std::vector<PartitionId> owners;
  for (std::size_t body = 0; body < triangles.size(); ++body)
    if (triangles[body] > 0) owners.push_back(static_cast<PartitionId>(body));
  std::stable_sort(owners.begin(), owners.end(),
                   [&](PartitionId a, PartitionId b) { return triangles[a] > triangles[b]; });
  const Partition first = *row;
  std::array<PartitionId, PartitionTable::kMost> label{};
  PartitionId last = first.id;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    const std::string within = mesh.partitions.find(owners[i])->body_name();
    if (i == 0) mesh.partitions.lies_within(first.id, within);
    if (i > 0 && !mesh.partitions.full() && mesh.partitions[mesh.partitions.size() - 1].id < PartitionTable::kHighest) {
      last = mesh.partitions.add(PartitionKind::kPores, first.body_name(), first.name);
      mesh.partitions.lies_within(last, within);
    }
    label[owners[i]] = last;
  }
  for (std::size_t i = 0; i < pores.triangles.size(); ++i)
    mesh.triangle_partition[pores.triangles[i]] = label[pores.pieces[pores.piece[i]].body];
}

}  // namespace dubsar
