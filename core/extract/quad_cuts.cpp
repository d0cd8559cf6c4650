#include "core/extract/quad_cuts.h"

#include <algorithm>

#include "core/base/numbers/sort_unique.h"
#include "core/base/system/large_pages.h"
#include "core/base/system/parallel_gather.h"
#include "core/extract/cell_pieces.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCutsGrain = 1 << 14;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

QuadCut cut_of_quad(const QuadMesh& mesh, std::uint32_t q) {
  if (mesh.has_doubled(q)) return cut_of(place_polygon(mesh, q));
  const auto& v = mesh.quads[q];
  const std::array<ExactPlace, 4> corner{exact_place(mesh.positions[v[0]]), exact_place(mesh.positions[v[1]]),
                                         exact_place(mesh.positions[v[2]]), exact_place(mesh.positions[v[3]])};
  constexpr std::array<QuadCut, 4> kCuts = {QuadCut::kFan, QuadCut::kFirst, QuadCut::kSecond, QuadCut::kEither};
  if (const auto allowed = allowed_inside(corner)) return kCuts[*allowed];
  const auto edge = edge_of_quad(corner);
  if (!edge) return QuadCut::kFree;
  const unsigned allowed = allowed_diagonals(corner, *edge);
  return allowed == 0 && !edge->strict ? QuadCut::kFree : kCuts[allowed];
}

/// Cells of several pieces where polygons touch get face points, and those beside them that come to touch, until none
/// do.
class Marking {
 public:
  explicit Marking(const QuadMesh& mesh) : mesh_(mesh), cells_(cells_of_several_pieces(mesh)) {}

  void run(QuadCuts& cuts) {
    std::vector<std::uint32_t> wanted(cells_.size());  // numbers of cells to look at
    for (std::uint32_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
    while (true) {
      const std::vector<std::uint32_t> found = touching(wanted);
      std::vector<std::uint32_t> fresh;
      for (const std::uint32_t i : found)
        if (marked_.empty() || marked_[cells_[i].first] == 0) fresh.push_back(i);
      std::erase_if(touching_, [&](std::uint32_t i) { return std::ranges::binary_search(wanted, i); });
      touching_.insert(touching_.end(), found.begin(), found.end());
      if (fresh.empty()) break;
      wanted = mark(fresh);
    }
    std::sort(touching_.begin(), touching_.end());
    for (const std::uint32_t i : touching_) cuts.touching.push_back(cells_[i].first);
    if (marked_.empty()) return;
    for (const CellPieces& cell : cells_)
      if (marked_[cell.first] != 0) cuts.pointed.push_back(cell.first);
    add_points(cuts);
  }

 private:
  std::vector<std::uint32_t> touching(std::span<const std::uint32_t> wanted) const {
    return parallel_gather<std::uint32_t>(static_cast<std::int64_t>(wanted.size()), 256,
                                          [&](std::int64_t begin, std::int64_t end, std::vector<std::uint32_t>& part) {
                                            CellLook look(mesh_, marked_);
                                            for (std::int64_t i = begin; i < end; ++i)
                                              if (look.touches(cells_[wanted[index(i)]]))
                                                part.push_back(wanted[index(i)]);
                                          });
  }

  /// Returns the cells at the x-quads around.
  std::vector<std::uint32_t> mark(std::span<const std::uint32_t> fresh) {
    marked_.resize(mesh_.positions.size(), 0);
    std::vector<std::uint32_t> near;
    for (const std::uint32_t i : fresh)
      for (std::uint32_t v = cells_[i].first; v < cells_[i].first + cells_[i].count; ++v) {
        marked_[v] = 1;
        for (const std::uint32_t q : mesh_.quads_of(v)) {
          quads_.push_back(q);
          const Polygon polygon = mesh_.polygon(q);
          for (int k = 0; k < polygon.size; ++k) add_cell(polygon.vertex[index(k)], near);
        }
      }
    sort_unique(near);
    return near;
  }

  void add_cell(std::uint32_t v, std::vector<std::uint32_t>& cells) const {
    const auto behind = std::upper_bound(cells_.begin(), cells_.end(), v,
                                         [](std::uint32_t x, const CellPieces& cell) { return x < cell.first; });
    if (behind == cells_.begin()) return;
    const CellPieces& cell = *(behind - 1);
    if (v < cell.first + cell.count) cells.push_back(static_cast<std::uint32_t>(behind - 1 - cells_.begin()));
  }

  void add_points(QuadCuts& cuts) {
    sort_unique(quads_);
    for (const std::uint32_t q : quads_) {
      const PlacedPolygon placed = place_polygon(mesh_, q);
      if (!placed.edge || !placed.edge->strict) continue;
      cuts.of_quad[q] = QuadCut::kFan;
      const Polygon& polygon = placed.polygon;
      for (int i = 0; i < polygon.size; ++i) {
        const std::uint32_t a = polygon.vertex[index(i)], b = polygon.vertex[index((i + 1) % polygon.size)];
        if (a > b || (marked_[a] == 0 && marked_[b] == 0)) continue;  // another x-quad of the side has it the other way
        if (const auto place = face_point(mesh_, a, b)) cuts.face_points.push_back({a, b, *place});
      }
    }
    std::sort(cuts.face_points.begin(), cuts.face_points.end());
    const auto same = [](const FacePoint& x, const FacePoint& y) { return !(x < y) && !(y < x); };
    cuts.face_points.erase(std::unique(cuts.face_points.begin(), cuts.face_points.end(), same),
                           cuts.face_points.end());  // of three x-quads two run the same way
  }

  const QuadMesh& mesh_;
  std::vector<CellPieces> cells_;
  std::vector<std::uint8_t> marked_;
  std::vector<std::uint32_t> touching_, quads_;
};

}  // namespace

std::optional<std::size_t> find_face_point(std::span<const FacePoint> points, std::uint32_t a, std::uint32_t b) {
  const FacePoint wanted{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(points.begin(), points.end(), wanted);
  if (found == points.end() || wanted < *found) return std::nullopt;
  return static_cast<std::size_t>(found - points.begin());
}

QuadCuts find_cuts(const QuadMesh& mesh) {
  QuadCuts cuts;
  resize_large(cuts.of_quad, mesh.quads.size());
  parallel_for(mesh.quad_count(), kCutsGrain,
               [&](std::int64_t q) { cuts.of_quad[index(q)] = cut_of_quad(mesh, static_cast<std::uint32_t>(q)); });
  Marking(mesh).run(cuts);
  return cuts;
}

}  // namespace dubsar
