// How the walk of patch_disk.h covers a patch that is there: its fans, rims and choices.

#include <algorithm>
#include <functional>
#include <unordered_map>
#include <utility>

#include "core/exa/patches/patch_disk.h"

namespace dubsar {
namespace {
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::int32_t kFarthest = 64;  ///< steps along the border; farther, and on other borders, a node is named

/// The triangles of a patch around their vertices. A vertex at which several fans of triangles meet, as where two holes
/// touch, is as many corners: so each lies on one rim at most, once.
class Fans {
 public:
  explicit Fans(std::span<const Triangle> triangles) : triangles_(triangles), corners_(triangles.size()) {
    edges_.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        if (triangles[t][c] == triangles[t][(c + 1) % 3] ||
            !edges_.emplace(key(triangles[t][c], triangles[t][(c + 1) % 3]), t).second)
          return;
    for (Triangle& t : corners_) t.fill(kNone);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        if (corners_[t][c] == kNone) name_fan(t, triangles[t][c]);
    manifold_ = true;
  }
  /// False: an edge has two triangles on one side.
  bool manifold() const { return manifold_; }
  /// Vertices by corner; corners of the triangles.
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  const Triangle& corners(std::uint32_t triangle) const { return corners_[triangle]; }
  /// The triangle with this directed edge between vertices, or kNone.
  std::uint32_t triangle(std::uint32_t from, std::uint32_t to) const {
    const auto found = edges_.find(key(from, to));
    return found == edges_.end() ? kNone : found->second;
  }
  /// The triangle behind `t` around one of its vertices, or kNone.
  std::uint32_t next_around(std::uint32_t t, std::uint32_t vertex) const {
    return triangle(vertex, triangles_[t][(place(t, vertex) + 2) % 3]);
  }
  /// Rims as corners: each begins with its lowest edge of vertices, the rim with the lowest of all first. A rim with
  /// an inner vertex between its edges, or an open one, cannot be.
  std::vector<std::vector<std::uint32_t>> rims() const {
    struct Edge {
      std::uint32_t from, to, from_corner, to_corner;
    };
    std::vector<Edge> edges;
    std::vector<std::uint32_t> next(vertices_.size(), kNone);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t d = (c + 1) % 3;
        if (triangle(triangles_[t][d], triangles_[t][c]) != kNone) continue;
        edges.push_back({triangles_[t][c], triangles_[t][d], corners_[t][c], corners_[t][d]});
        next[corners_[t][c]] = corners_[t][d];
      }
    std::ranges::sort(edges, {}, [](const Edge& e) { return key(e.from, e.to); });
    std::vector<std::vector<std::uint32_t>> rims;
    for (const Edge& e : edges) {
      if (next[e.from_corner] == kNone) continue;  // seen
      rims.emplace_back();
      for (std::uint32_t at = e.from_corner; next[at] != kNone;) {
        rims.back().push_back(at);
        at = std::exchange(next[at], kNone);
      }
    }
    return rims;
  }

  /// Corners at vertices below `end` that no rim has, by their vertices.
  std::vector<std::uint32_t> inside(std::uint32_t end, std::span<const std::uint32_t> on_rims) const {
    std::vector<bool> known(vertices_.size(), false);
    for (const std::uint32_t corner : on_rims) known[corner] = true;
    std::vector<std::uint32_t> corners;
    for (std::uint32_t corner = 0; corner < vertices_.size(); ++corner)
      if (vertices_[corner] < end && !known[corner]) corners.push_back(corner);
    std::ranges::stable_sort(corners, {}, [&](std::uint32_t corner) { return vertices_[corner]; });
    return corners;
  }
  /// Of each piece that has no rim the first triangle without vertices below `end`; kNone where there is none.
  std::vector<std::uint32_t> closed_pieces(std::uint32_t end) const {
    std::vector<bool> seen(triangles_.size(), false);
    const auto see_piece = [&](std::uint32_t first) {
      std::vector<std::uint32_t> front{first};
      seen[first] = true;
      bool rim = false;
      std::uint32_t lowest = kNone;
      while (!front.empty()) {
        const Triangle& t = triangles_[front.back()];
        if (*std::ranges::min_element(t) >= end) lowest = std::min(lowest, front.back());
        front.pop_back();
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t beyond = triangle(t[(c + 1) % 3], t[c]);
          rim = rim || beyond == kNone;
          if (beyond == kNone || seen[beyond]) continue;
          seen[beyond] = true;
          front.push_back(beyond);
        }
      }
      return std::pair(rim, lowest);
    };
    std::vector<std::uint32_t> pieces;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (seen[t]) continue;
      const auto [rim, lowest] = see_piece(t);
      if (!rim) pieces.push_back(lowest);
    }
    std::ranges::sort(pieces);
    return pieces;
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  std::size_t place(std::uint32_t t, std::uint32_t vertex) const {
    return triangles_[t][0] == vertex ? 0 : triangles_[t][1] == vertex ? 1 : 2;
  }
  void name_fan(std::uint32_t first, std::uint32_t vertex) {
    const auto name = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(vertex);
    for (std::uint32_t t = first; t != kNone && corners_[t][place(t, vertex)] == kNone; t = next_around(t, vertex))
      corners_[t][place(t, vertex)] = name;
    for (std::uint32_t t = first;;) {  // and the other way round
      t = triangle(triangles_[t][(place(t, vertex) + 1) % 3], vertex);
      if (t == kNone || corners_[t][place(t, vertex)] != kNone) break;
      corners_[t][place(t, vertex)] = name;
    }
  }

  std::span<const Triangle> triangles_;
  std::unordered_map<std::uint64_t, std::uint32_t> edges_;
  std::vector<Triangle> corners_;
  std::vector<std::uint32_t> vertices_;
  bool manifold_ = false;
};

/// Answers the walk with the triangles of a patch.
class Choices {
 public:
  /// `corners`: those of the rims and of the first triangles of closed pieces.
  Choices(const Fans& fans, std::size_t triangles, std::vector<std::uint32_t> corners, std::uint32_t vertex_count,
          DiskPatch& disk)
      : fans_(fans),
        vertex_count_(vertex_count),
        disk_(disk),
        corner_of_(std::move(corners)),
        number_(fans.vertices().size(), kNone),
        latest_(corner_of_.size(), kNone),
        used_(triangles, false) {
    for (std::uint32_t i = 0; i < corner_of_.size(); ++i) number_[corner_of_[i]] = i;
  }
  void use(std::uint32_t triangle) { used_[triangle] = true; }
  std::optional<DiskChoice> operator()(const DiskEdge& edge) {
    see_new_nodes(edge.border);
    const DiskNode& here = edge.border[edge.node];
    const std::uint32_t from = vertex_at(here), to = vertex_at(edge.border[here.next]);
    const std::uint32_t t = fans_.triangle(from, to);
    if (t == kNone || used_[t]) return std::nullopt;
    used_[t] = true;
    std::uint32_t third = kNone;
    for (const std::uint32_t corner : fans_.corners(t))
      if (fans_.vertices()[corner] != from && fans_.vertices()[corner] != to) third = corner;
    if (third == kNone) return std::nullopt;
    DiskChoice choice;
    const std::uint32_t known = number_[third];
    if (known == kNone) {
      const std::uint32_t vertex = fans_.vertices()[third];
      if (vertex < vertex_count_) return std::nullopt;
      number_[third] = static_cast<std::uint32_t>(corner_of_.size());
      corner_of_.push_back(third);
      latest_.push_back(kNone);
      disk_.order.push_back(vertex - vertex_count_);
    } else if (edge.border[edge.border[here.next].next].vertex == known) {
      choice.step = DiskStep::kNext;
    } else if (edge.border[here.before].vertex == known) {
      choice.step = DiskStep::kBefore;
    } else {
      choice.step = DiskStep::kOther;
      choice.node = node_with(edge, known, t);
      if (choice.node == kNone) return std::nullopt;
      choice.distance = distance_to(edge, choice.node);
    }
    disk_.choices.push_back(choice);
    return choice;
  }

 private:
  std::uint32_t vertex_at(const DiskNode& node) const { return fans_.vertices()[corner_of_[node.vertex]]; }
  void see_new_nodes(std::span<const DiskNode> border) {
    for (auto node = static_cast<std::uint32_t>(before_.size()); node < border.size(); ++node)
      before_.push_back(std::exchange(latest_[border[node].vertex], node));
  }
  /// The node of a vertex behind whose edge, around the vertex, triangle t is still to come.
  std::uint32_t node_with(const DiskEdge& edge, std::uint32_t number, std::uint32_t t) const {
    for (std::uint32_t node = latest_[number]; node != kNone; node = before_[node]) {
      const DiskNode& n = edge.border[node];
      if (!n.alive) continue;
      if (n.next == node) return node;  // on no border yet
      const std::uint32_t vertex = vertex_at(n);
      std::uint32_t at = fans_.triangle(vertex, vertex_at(edge.border[n.next]));
      while (at != kNone && !used_[at]) at = fans_.next_around(at, vertex);
      if (at == t) return node;
    }
    return kNone;
  }
  static std::int32_t distance_to(const DiskEdge& edge, std::uint32_t node) {
    std::uint32_t forth = edge.border[edge.node].next, back = edge.node;
    for (std::int32_t step = 1; step <= kFarthest; ++step) {
      forth = edge.border[forth].next;
      back = edge.border[back].before;
      if (forth == node) return step;
      if (back == node) return -step;
      if (forth == edge.node) break;
    }
    return 0;
  }

  const Fans& fans_;
  std::uint32_t vertex_count_;
  DiskPatch& disk_;
  std::vector<std::uint32_t> corner_of_;          ///< by number in the walk
  std::vector<std::uint32_t> number_;             ///< and back
  std::vector<std::uint32_t> latest_, before_{};  ///< nodes of a number, the newest first
  std::vector<bool> used_;
};
}  // namespace

std::optional<DiskPatch> disk_of(const FillPatch& patch, std::uint32_t vertex_count) {
  const Fans fans(patch.triangles);
  if (!fans.manifold()) return std::nullopt;
  DiskPatch disk;
  std::vector<std::uint32_t> corners;
  for (const std::vector<std::uint32_t>& rim : fans.rims()) {
    disk.rims.push_back(static_cast<std::uint32_t>(rim.size()));
    corners.insert(corners.end(), rim.begin(), rim.end());
  }
  const std::vector<std::uint32_t> inside = fans.inside(vertex_count, corners);
  corners.insert(corners.end(), inside.begin(), inside.end());
  disk.rims.resize(disk.rims.size() + inside.size(), 1);
  for (const std::uint32_t corner : corners) {
    disk.rim.push_back(fans.vertices()[corner]);
    if (disk.rim.back() >= vertex_count) return std::nullopt;
  }
  const std::vector<std::uint32_t> pieces = fans.closed_pieces(vertex_count);
  if (!pieces.empty() && pieces.back() == kNone) return std::nullopt;
  for (const std::uint32_t t : pieces)
    for (std::size_t c = 0; c < 3; ++c) {
      corners.push_back(fans.corners(t)[c]);
      disk.order.push_back(patch.triangles[t][c] - vertex_count);
    }
  disk.rims.resize(disk.rims.size() + pieces.size(), 0);
  Choices choices(fans, patch.triangles.size(), std::move(corners), vertex_count, disk);
  for (const std::uint32_t t : pieces) choices.use(t);
  const bool covered = walk_disk(disk.rims, patch.triangles.size(), std::ref(choices), disk.triangles);
  if (!covered || disk.triangles.size() != patch.triangles.size() || disk.order.size() != patch.extra_positions.size())
    return std::nullopt;
  return disk;
}

}  // namespace dubsar
