#include "core/extract/cell_pieces.h"

#include <algorithm>
#include <bit>

#include "core/base/numbers/sort_unique.h"
#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPiecesGrain = 1 << 15;
constexpr std::uint64_t kCentreId = std::uint64_t{1} << 32, kFaceId = std::uint64_t{1} << 63;

std::uint64_t id_of_side(std::uint32_t a, std::uint32_t b) {
  return kFaceId | ((std::uint64_t{std::min(a, b)} << 31) ^ std::max(a, b));
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<CellPieces> cells_of_several_pieces(const QuadMesh& mesh) {
  const auto cell = [&](std::int64_t v) {
    const ExactPlace p = exact_place(mesh.positions[static_cast<std::size_t>(v)]);
    return p >> std::int64_t{10};
  };
  static_assert(kExactSteps == 1 << 10);
  const auto same = [&](std::int64_t v) {  // as the next
    return v + 1 < mesh.vertex_count() && cell(v) == cell(v + 1) &&
           mesh.positions[static_cast<std::size_t>(v)] != mesh.positions[static_cast<std::size_t>(v) + 1];
  };
  return parallel_gather<CellPieces>(
      mesh.vertex_count(), kPiecesGrain, [&](std::int64_t begin, std::int64_t end, std::vector<CellPieces>& part) {
        bool before = begin > 0 && same(begin - 1);
        for (std::int64_t v = begin; v < end; ++v) {
          const bool here = same(v);
          if (here && !before) {
            std::int64_t last = v + 1;
            while (same(last)) ++last;
            part.push_back({static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(last + 1 - v)});
          }
          before = here;
        }
      });
}

std::array<ExactPlace, 4> PlacedPolygon::corners() const {
  std::array<ExactPlace, 4> corners;
  for (int i = polygon.size - 1; i >= 0; --i) corners[polygon.corner[at(i)]] = place[at(i)];
  return corners;
}

PlacedPolygon place_polygon(const QuadMesh& mesh, std::uint32_t quad) {
  PlacedPolygon placed{mesh.polygon(quad), {}, {}};
  for (int i = 0; i < placed.polygon.size; ++i)
    placed.place[at(i)] = exact_place(mesh.positions[placed.polygon.vertex[at(i)]]);
  placed.edge = edge_of_quad(placed.corners());
  if (placed.edge && placed.polygon.size > 4) {  // the second vertices of corners lie in the same cells
    std::array<ExactPlace, 4> seconds{};
    for (int i = 0; i < placed.polygon.size; ++i) seconds[placed.polygon.corner[at(i)]] = placed.place[at(i)];
    const auto second = edge_of_quad(seconds);
    if (!second || second->low != placed.edge->low || second->axis != placed.edge->axis)
      placed.edge.reset();
    else
      placed.edge->strict = placed.edge->strict && second->strict;
  }
  return placed;
}

QuadCut cut_of(const PlacedPolygon& placed) {
  if (!placed.edge) return QuadCut::kFree;
  if (placed.polygon.size == 4) {
    const unsigned allowed = allowed_diagonals(placed.corners(), *placed.edge);
    if (allowed != 0) return allowed == 1 ? QuadCut::kFirst : allowed == 2 ? QuadCut::kSecond : QuadCut::kEither;
  }
  return placed.edge->strict ? QuadCut::kFan : QuadCut::kFree;
}

std::optional<ExactPlace> face_point(const QuadMesh& mesh, std::uint32_t a, std::uint32_t b) {
  ExactPlace sum{0};
  std::int64_t found = 0;
  for (const std::uint32_t q : mesh.quads_of(a)) {
    const PlacedPolygon placed = place_polygon(mesh, q);
    const Polygon& polygon = placed.polygon;
    for (int i = 0; i < polygon.size; ++i) {
      const int next = (i + 1) % polygon.size;
      const std::uint32_t from = polygon.vertex[at(i)], to = polygon.vertex[at(next)];
      if (!((from == a && to == b) || (from == b && to == a))) continue;
      if (polygon.corner[at(i)] == polygon.corner[at(next)] || !placed.edge || !placed.edge->strict)
        return std::nullopt;
      sum += placed.centre();
      ++found;
    }
  }
  if (found < 2) return std::nullopt;
  const auto mean = [&](std::int64_t total) {  // the nearest, halves up
    return floor_div(2 * total + found, 2 * found);
  };
  return ExactPlace{mean(sum.x), mean(sum.y), mean(sum.z)};
}

void CellLook::add(const ExactTriangle& triangle, std::uint32_t quad, std::uint32_t pieces, bool fan) {
  members_.push_back({triangle, quad, pieces, fan});
  Reach& reach = reaches_.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactPlace p = triangle.place[i] - origin_;  // a few cells at most
    const auto x = static_cast<std::int32_t>(p.x), y = static_cast<std::int32_t>(p.y),
               z = static_cast<std::int32_t>(p.z);
    const std::array<std::int32_t, 7> along = {x, y, z, x + y + z, x + y - z, x - y + z, -x + y + z};
    for (std::size_t k = 0; k < along.size(); ++k) {
      reach.low[k] = i == 0 ? along[k] : std::min(reach.low[k], along[k]);
      reach.high[k] = i == 0 ? along[k] : std::max(reach.high[k], along[k]);
    }
  }
}

void CellLook::add_quad(const CellPieces& cell, std::uint32_t quad, std::uint32_t pieces) {
  const PlacedPolygon placed = place_polygon(mesh_, quad);
  const Polygon& polygon = placed.polygon;
  const int n = polygon.size;
  const auto vertex = [&](int i) { return polygon.vertex[at(i % n)]; };
  bool any_marked = false;
  if (!marked_.empty())
    for (int i = 0; i < n; ++i) any_marked = any_marked || marked_[vertex(i)] != 0;
  const QuadCut cut = cut_of(placed);
  if (cut == QuadCut::kFan || (any_marked && placed.edge && placed.edge->strict)) {
    const ExactPlace centre = placed.centre();
    const std::uint64_t centre_id = kCentreId + quad;
    const auto in_cell = [&](std::uint32_t v) { return v - cell.first < cell.count; };
    for (int i = 0; i < n; ++i) {
      const std::uint32_t a = vertex(i), b = vertex(i + 1);
      if (!in_cell(a) && !in_cell(b)) continue;
      const ExactPlace &pa = placed.place[at(i)], &pb = placed.place[at((i + 1) % n)];
      const auto middle = any_marked && (marked_[a] != 0 || marked_[b] != 0) ? face_point(mesh_, a, b) : std::nullopt;
      if (!middle) {
        add({{pa, pb, centre}, {a, b, centre_id}}, quad, pieces, true);
        continue;
      }
      add({{pa, *middle, centre}, {a, id_of_side(a, b), centre_id}}, quad, pieces, true);
      add({{*middle, pb, centre}, {id_of_side(a, b), b, centre_id}}, quad, pieces, true);
    }
    return;
  }
  const auto corner = [&](int a, int b, int c) {
    add({{placed.place[at(a)], placed.place[at(b)], placed.place[at(c)]}, {vertex(a), vertex(b), vertex(c)}}, quad,
        pieces, false);
  };
  if (n != 4) {  // cut somehow
    for (int i = 1; i + 1 < n; ++i) corner(0, i, i + 1);
    return;
  }
  if (cut != QuadCut::kSecond) {
    corner(0, 1, 2);
    corner(0, 2, 3);
  }
  if (cut != QuadCut::kFirst) {
    corner(1, 2, 3);
    corner(1, 3, 0);
  }
}

bool CellLook::touches(const CellPieces& cell) {
  members_.clear();
  reaches_.clear();
  quads_.clear();
  origin_ = exact_place(mesh_.positions[cell.first]);
  for (std::uint32_t v = cell.first; v < cell.first + cell.count; ++v)
    quads_.insert(quads_.end(), mesh_.quads_of(v).begin(), mesh_.quads_of(v).end());
  sort_unique(quads_);
  for (const std::uint32_t q : quads_) {
    std::uint32_t pieces = 0;
    for (std::uint32_t i = 0; i < cell.count; ++i)
      if (std::ranges::find(mesh_.quads_of(cell.first + i), q) != mesh_.quads_of(cell.first + i).end())
        pieces |= 1u << i;
    add_quad(cell, q, pieces);
  }
  for (std::size_t a = 0; a < members_.size(); ++a)
    for (std::size_t b = a + 1; b < members_.size(); ++b) {
      const Member &x = members_[a], &y = members_[b];
      if (x.quad == y.quad ? !x.fan : x.pieces == y.pieces && std::has_single_bit(x.pieces)) continue;
      bool apart = false;
      for (std::size_t k = 0; k < 7; ++k)
        apart |= (reaches_[a].high[k] < reaches_[b].low[k]) | (reaches_[b].high[k] < reaches_[a].low[k]);
      if (!apart && triangles_touch(x.triangle, y.triangle)) return true;
    }
  return false;
}

}  // namespace dubsar
