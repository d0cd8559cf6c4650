#include "core/extract/piece_moves.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/base/numbers/sort_unique.h"
#include "core/base/result.h"
#include "core/extract/cell_box.h"
#include "core/extract/cell_pieces.h"

namespace dubsar {
namespace {

constexpr std::array<double, 5> kDrawn = {1.0, 10.0 / 16, 6.0 / 16, 3.0 / 16, 1.0 / 16};  // of the way from the chord
constexpr int kMeans = 400;
constexpr int kRounds = 8;  // a move may bring others to touch; more than 2 were not seen

/// The crossings around one vertex, and those among them that a chord joins.
struct Crossings {
  std::vector<glm::dvec3> all, chord;
};

glm::dvec3 mean(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

class CellMoves {
 public:
  CellMoves(QuadMesh& mesh, const QuadCuts& cuts, std::span<const glm::vec3> safe, const PlaceOfVertex& place,
            PieceMoves& report)
      : mesh_(mesh),
        safe_(safe),
        place_(place),
        report_(report),
        cells_(cells_of_several_pieces(mesh)),
        marked_(mesh.positions.size(), 0) {
    for (const std::uint32_t first : cuts.pointed)
      if (const CellPieces* cell = cell_of(first))
        std::fill_n(marked_.begin() + cell->first, cell->count, std::uint8_t{1});
  }

  void part(std::uint32_t first) {
    const CellPieces* cell = cell_of(first);
    if (cell == nullptr || cell->first != first) return;
    CellLook look(mesh_, marked_);
    if (!look.touches(*cell)) return;
    vertices_.clear();
    for (std::uint32_t v = first; v < first + cell->count; ++v) vertices_.push_back(v);
    if (move(*cell, look, Around::kStays)) return;
    for (std::uint32_t v = first; v < first + cell->count; ++v)
      for (const std::uint32_t q : mesh_.quads_of(v)) {
        const Polygon polygon = mesh_.polygon(q);
        vertices_.insert(vertices_.end(), polygon.vertex.begin(), polygon.vertex.begin() + polygon.size);
      }
    sort_unique(vertices_);
    if (move(*cell, look, Around::kSafe)) return;
    move(*cell, look, Around::kTried);
  }

 private:
  /// What becomes of the vertices around a cell while places for its own are tried: they stay, are where they are safe,
  /// or are tried as its own are.
  enum class Around : std::uint8_t { kStays, kSafe, kTried };

  /// Tries places for the vertices of a cell until nothing around vertices_ touches that did not before.
  bool move(const CellPieces& cell, CellLook& look, Around around) {
    find_near();
    touched_.clear();
    for (const CellPieces* other : near_) touched_.push_back(look.touches(*other));
    std::vector<glm::vec3> before;
    for (const std::uint32_t v : vertices_) before.push_back(mesh_.positions[v]);
    if (around == Around::kSafe)
      for (const std::uint32_t v : vertices_) mesh_.positions[v] = place_(v, kept_in_cell(safe_[v], safe_[v]));
    std::vector<std::uint32_t> own(cell.count);
    std::iota(own.begin(), own.end(), cell.first);
    const std::vector<std::uint32_t>& tried = around == Around::kTried ? vertices_ : own;
    std::vector<Crossings> crossings;
    for (const std::uint32_t v : tried) crossings.push_back(crossings_of(v));
    std::uint64_t random = cell.first;
    const auto next = [&random] {  // [Steele 2014], 24 bits
      random += 0x9E3779B97F4A7C15U;
      std::uint64_t z = (random ^ (random >> 30)) * 0xBF58476D1CE4E5B9U;
      z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
      return static_cast<double>((z ^ (z >> 31)) >> 40) * 0x1p-24;
    };
    const auto drawn = static_cast<int>(kDrawn.size());
    for (int trial = 0; trial < drawn + kMeans; ++trial) {
      for (std::size_t i = 0; i < tried.size(); ++i) {
        const std::uint32_t v = tried[i];
        const Crossings& c = crossings[i];
        if (c.all.empty()) continue;
        glm::dvec3 wanted = mean(c.all);
        if (trial < drawn && !c.chord.empty())
          wanted = mean(c.chord) + kDrawn[static_cast<std::size_t>(trial)] * (wanted - mean(c.chord));
        if (trial >= drawn) wanted = weighted(c.all, next);
        mesh_.positions[v] = place_(v, kept_in_cell(safe_[v], glm::vec3(wanted)));
      }
      if (look.touches(cell) || !none_came_to_touch(look)) continue;
      for (std::size_t i = 0; i < vertices_.size(); ++i) report_.moved += before[i] != mesh_.positions[vertices_[i]];
      return true;
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) mesh_.positions[vertices_[i]] = before[i];
    return false;
  }

  template <class Draw>
  static glm::dvec3 weighted(const std::vector<glm::dvec3>& points, const Draw& next) {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (const glm::dvec3& p : points) {
      const double draw = next(), weight = draw * draw;
      sum += weight * p;
      weights += weight;
    }
    return weights > 0.0 ? sum / weights : mean(points);
  }

  const CellPieces* cell_of(std::uint32_t v) const {
    const auto behind = std::upper_bound(cells_.begin(), cells_.end(), v,
                                         [](std::uint32_t x, const CellPieces& cell) { return x < cell.first; });
    if (behind == cells_.begin()) return nullptr;
    const CellPieces& cell = *(behind - 1);
    return v < cell.first + cell.count ? &cell : nullptr;
  }

  /// The cells at the x-quads around vertices_.
  void find_near() {
    near_.clear();
    for (const std::uint32_t v : vertices_)
      for (const std::uint32_t q : mesh_.quads_of(v)) {
        const Polygon polygon = mesh_.polygon(q);
        for (int k = 0; k < polygon.size; ++k)
          if (const CellPieces* other = cell_of(polygon.vertex[static_cast<std::size_t>(k)])) near_.push_back(other);
      }
    sort_unique(near_);
  }

  bool none_came_to_touch(CellLook& look) const {
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (!touched_[i] && look.touches(*near_[i])) return false;
    return true;
  }

  Crossings crossings_of(std::uint32_t v) const {
    Crossings found;
    for (const std::uint32_t q : mesh_.quads_of(v)) {
      const PlacedPolygon placed = place_polygon(mesh_, q);
      if (!placed.edge) continue;
      const glm::dvec3 crossing = glm::dvec3(placed.centre()) / static_cast<double>(kExactSteps);
      found.all.push_back(crossing);
      const Polygon& polygon = placed.polygon;
      for (int k = 0; k < polygon.size; ++k) {
        const auto here = static_cast<std::size_t>(k), next = static_cast<std::size_t>((k + 1) % polygon.size);
        if ((polygon.vertex[here] == v || polygon.vertex[next] == v) && polygon.corner[here] == polygon.corner[next])
          found.chord.push_back(crossing);
      }
    }
    return found;
  }

  QuadMesh& mesh_;
  std::span<const glm::vec3> safe_;
  const PlaceOfVertex& place_;
  PieceMoves& report_;
  std::vector<CellPieces> cells_;
  std::vector<std::uint8_t> marked_;
  std::vector<std::uint32_t> vertices_;  ///< that may move, rising
  std::vector<const CellPieces*> near_;
  std::vector<bool> touched_;  ///< of near_, before the moves
};

}  // namespace

PieceMoves part_pieces(QuadMesh& mesh, std::span<const glm::vec3> safe, const PlaceOfVertex& place) {
  DUBSAR_CHECK(safe.size() == mesh.positions.size());
  PieceMoves report;
  for (int round = 0; round < kRounds; ++round) {
    const QuadCuts cuts = find_cuts(mesh);
    if (round == 0) report.touching = static_cast<std::int64_t>(cuts.touching.size());
    report.left = static_cast<std::int64_t>(cuts.touching.size());
    const std::int64_t before = report.moved;
    if (cuts.touching.empty()) break;
    CellMoves moves(mesh, cuts, safe, place, report);
    for (const std::uint32_t first : cuts.touching) moves.part(first);
    if (report.moved == before) break;
  }
  return report;
}

}  // namespace dubsar
