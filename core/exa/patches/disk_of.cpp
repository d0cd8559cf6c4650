// How the walk of patch_disk.h covers a patch that is there: its rims and choices.

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/numbers/sort_unique.h"
#include "core/exa/patches/patch_disk.h"
#include "core/exa/patches/patch_fans.h"

namespace dubsar {
namespace {
constexpr std::uint32_t kNone = PatchFans::kNone;
constexpr std::int32_t kFarthest = 64;  ///< steps along the border; farther, and on other borders, a node is named

/// The triangles of a patch by numbers of its own for their vertices: first those of the surface, rising, then the
/// patch's. Nothing where a triangle has another vertex.
struct OwnVertices {
  std::vector<std::uint32_t> surface;  ///< ids
  std::vector<Triangle> triangles;
};
std::optional<OwnVertices> own_vertices(const FillPatch& patch, std::uint32_t vertex_count) {
  OwnVertices own;
  for (const Triangle& t : patch.triangles)
    for (const std::uint32_t v : t)
      if (v < vertex_count) own.surface.push_back(v);
  sort_unique(own.surface);
  const auto surface = static_cast<std::uint32_t>(own.surface.size());
  own.triangles = patch.triangles;
  for (Triangle& t : own.triangles)
    for (std::uint32_t& v : t) {
      if (v >= vertex_count && v - vertex_count >= patch.extra_positions.size()) return std::nullopt;
      v = v < vertex_count ? static_cast<std::uint32_t>(std::ranges::lower_bound(own.surface, v) - own.surface.begin())
                           : v - vertex_count + surface;
    }
  return own;
}

/// Answers the walk with the triangles of a patch.
class Choices {
 public:
  /// `corners`: those of the rims and of the first triangles of closed pieces. `surface`: vertices below are not the
  /// patch's.
  Choices(const PatchFans& fans, std::size_t triangles, std::vector<std::uint32_t> corners, std::uint32_t surface,
          DiskPatch& disk)
      : fans_(fans),
        surface_(surface),
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
      if (vertex < surface_) return std::nullopt;
      number_[third] = static_cast<std::uint32_t>(corner_of_.size());
      corner_of_.push_back(third);
      latest_.push_back(kNone);
      disk_.order.push_back(vertex - surface_);
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

  const PatchFans& fans_;
  std::uint32_t surface_;
  DiskPatch& disk_;
  std::vector<std::uint32_t> corner_of_;          ///< by number in the walk
  std::vector<std::uint32_t> number_;             ///< and back
  std::vector<std::uint32_t> latest_, before_{};  ///< nodes of a number, the newest first
  std::vector<bool> used_;
};
}  // namespace

std::optional<DiskPatch> disk_of(const FillPatch& patch, std::uint32_t vertex_count) {
  const std::optional<OwnVertices> own = own_vertices(patch, vertex_count);
  if (!own) return std::nullopt;
  const auto surface = static_cast<std::uint32_t>(own->surface.size());
  const PatchFans fans(own->triangles, surface + static_cast<std::uint32_t>(patch.extra_positions.size()));
  if (!fans.manifold()) return std::nullopt;
  DiskPatch disk;
  std::vector<std::uint32_t> corners;
  for (const std::vector<std::uint32_t>& rim : fans.rims()) {
    disk.rims.push_back(static_cast<std::uint32_t>(rim.size()));
    corners.insert(corners.end(), rim.begin(), rim.end());
  }
  const std::vector<std::uint32_t> inside = fans.inside(surface, corners);
  corners.insert(corners.end(), inside.begin(), inside.end());
  disk.rims.resize(disk.rims.size() + inside.size(), 1);
  for (const std::uint32_t corner : corners) {
    if (fans.vertices()[corner] >= surface) return std::nullopt;
    disk.rim.push_back(own->surface[fans.vertices()[corner]]);
  }
  const std::vector<std::uint32_t> pieces = fans.closed_pieces(surface);
  if (!pieces.empty() && pieces.back() == kNone) return std::nullopt;
  for (const std::uint32_t t : pieces)
    for (std::size_t c = 0; c < 3; ++c) {
      corners.push_back(fans.corners(t)[c]);
      disk.order.push_back(own->triangles[t][c] - surface);
    }
  disk.rims.resize(disk.rims.size() + pieces.size(), 0);
  Choices choices(fans, patch.triangles.size(), std::move(corners), surface, disk);
  for (const std::uint32_t t : pieces) choices.use(t);
  const bool covered = walk_disk(disk.rims, patch.triangles.size(), std::ref(choices), disk.triangles);
  if (!covered || disk.triangles.size() != patch.triangles.size() || disk.order.size() != patch.extra_positions.size())
    return std::nullopt;
  return disk;
}

}  // namespace dubsar
