#include "core/parts/border_check.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/base/numbers/counting_sort.h"
#include "core/base/system/parallel_gather.h"
#include "core/parts/triangle_soup.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBorderGrain = 1 << 12;

/// A triangle's corner at a vertex: the other two, in order.
struct Corner {
  std::uint32_t vertex = 0, next = 0, previous = 0;
  PartitionId body = 0;
};
using Places = std::vector<glm::vec3>;

class BorderCheck {
 public:
  BorderCheck(const SurfaceModel& model, const Triangulation& surface, std::span<const PartitionId> bodies)
      : model_(model),
        surface_(surface),
        bodies_(bodies),
        dual_(static_cast<std::uint32_t>(model.mesh.positions.size())),
        added_(surface.steiner) {
    for (const Partition& partition : model.partitions) body_[partition.id] = model.partitions.body_of(partition.id);
    for (const FillPatch& patch : model.patches) add_patch(patch);
    counting_sort(at_dual_, std::size_t{dual_} + 1, [](const Corner& c) { return c.vertex; });
    counting_sort(at_added_, added_.size(), [&](const Corner& c) { return c.vertex - dual_; });
  }

  Places run() {
    const std::vector<std::uint8_t> border = border_vertices(model_, body_);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < border.size(); ++v)
      if (border[v] != 0) vertices.push_back(v);
    Places open = std::move(degenerate_);
    const auto add = [&](const Places& more) { open.insert(open.end(), more.begin(), more.end()); };
    add(at_each(static_cast<std::int64_t>(vertices.size()), [&](std::int64_t i, std::vector<Corner>& corners) {
      corners_of_dual(vertices[static_cast<std::size_t>(i)], corners);
    }));
    const std::vector<std::size_t> starts = starts_of(at_added_);
    add(at_each(static_cast<std::int64_t>(starts.size()) - 1, [&](std::int64_t i, std::vector<Corner>& corners) {
      const auto at = static_cast<std::size_t>(i);
      corners.assign(at_added_.begin() + static_cast<std::ptrdiff_t>(starts[at]),
                     at_added_.begin() + static_cast<std::ptrdiff_t>(starts[at + 1]));
    }));
    return open;
  }

 private:
  bool wanted(PartitionId body) const { return std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end(); }
  glm::vec3 position(std::uint32_t v) const { return v < dual_ ? model_.mesh.positions[v] : added_[v - dual_]; }

  void add_patch(const FillPatch& patch) {
    const PartitionId front = body_[patch.partition];
    const PartitionId back =
        patch.reverse_partition == PartitionTable::kNone ? PartitionTable::kNone : body_[patch.reverse_partition];
    if (front == back) return;
    const auto base = dual_ + static_cast<std::uint32_t>(added_.size());
    added_.insert(added_.end(), patch.extra_positions.begin(), patch.extra_positions.end());
    const bool in_front = wanted(front), behind = back != PartitionTable::kNone && wanted(back);
    for (Triangle t : patch.triangles) {
      for (std::uint32_t& v : t)
        if (v >= dual_) v = v - dual_ + base;
      if ((in_front || behind) && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])) degenerate_.push_back(position(t[0]));
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = t[i], next = t[(i + 1) % 3], previous = t[(i + 2) % 3];
        if (v >= dual_) {  // both bodies have the same triangles around it
          if (in_front || behind) at_added_.push_back({v, next, previous, in_front ? front : back});
          continue;
        }
        if (in_front) at_dual_.push_back({v, next, previous, front});
        if (behind) at_dual_.push_back({v, previous, next, back});
      }
    }
  }

  static std::vector<std::size_t> starts_of(const std::vector<Corner>& corners) {
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (i == 0 || corners[i].vertex != corners[i - 1].vertex) starts.push_back(i);
    starts.push_back(corners.size());
    return starts;
  }

  void corners_of_dual(std::uint32_t v, std::vector<Corner>& corners) const {
    corners.clear();
    for (const std::uint32_t q : model_.mesh.quads_of(v)) {
      const PartitionId body = body_[model_.quad_partition[q]];
      if (!wanted(body)) continue;
      for (std::uint32_t t = surface_.first_triangle[q]; t < surface_.first_triangle[q + 1]; ++t) {
        const Triangle& triangle = surface_.triangles[t];
        for (std::size_t i = 0; i < 3; ++i)
          if (triangle[i] == v) corners.push_back({v, triangle[(i + 1) % 3], triangle[(i + 2) % 3], body});
      }
    }
    const auto of_patches = std::equal_range(at_dual_.begin(), at_dual_.end(), Corner{.vertex = v},
                                             [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
    corners.insert(corners.end(), of_patches.first, of_patches.second);
  }

  /// Middles of the open edges at each of some vertices, whose corners `collect` finds.
  template <class Collect>
  Places at_each(std::int64_t count, const Collect& collect) const {
    return parallel_gather<glm::vec3>(count, kBorderGrain, [&](std::int64_t begin, std::int64_t end, Places& open) {
      std::vector<Corner> corners;
      std::vector<Side> sides;
      for (std::int64_t i = begin; i < end; ++i) {
        collect(i, corners);
        look_at(corners, sides, open);
      }
    });
  }

  struct Side {
    PartitionId body = 0;
    std::uint32_t neighbour = 0;
    bool leaves = false;
    friend bool operator<(const Side& a, const Side& b) {
      return std::tie(a.body, a.neighbour, a.leaves) < std::tie(b.body, b.neighbour, b.leaves);
    }
  };

  /// Of one vertex: each neighbour in a body once after it and once before it.
  void look_at(const std::vector<Corner>& corners, std::vector<Side>& sides, Places& open) const {
    sides.clear();
    for (const Corner& c : corners) {
      sides.push_back({c.body, c.next, true});
      sides.push_back({c.body, c.previous, false});
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
      end = begin;
      std::size_t leaving = 0;
      for (;
           end < sides.size() && sides[end].body == sides[begin].body && sides[end].neighbour == sides[begin].neighbour;
           ++end)
        leaving += sides[end].leaves;
      if (end - begin != 2 || leaving != 1)
        open.push_back(0.5f * (position(corners.front().vertex) + position(sides[begin].neighbour)));
    }
  }

  const SurfaceModel& model_;
  const Triangulation& surface_;
  std::span<const PartitionId> bodies_;
  std::uint32_t dual_;
  std::array<PartitionId, std::size_t{PartitionTable::kHighest} + 1> body_{};
  std::vector<glm::vec3> added_;            ///< positions of ids from dual_ on: Steiner points, then those of patches
  std::vector<Corner> at_dual_, at_added_;  ///< of the patches' triangles, by vertex
  Places degenerate_;
};

}  // namespace

std::vector<glm::vec3> open_borders(const SurfaceModel& model, const Triangulation& surface,
                                    std::span<const PartitionId> bodies) {
  return BorderCheck(model, surface, bodies).run();
}

}  // namespace dubsar
