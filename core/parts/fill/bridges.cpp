#include "core/parts/fill/bridges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/base/numbers/disjoint_sets.h"

namespace dubsar {
namespace {

/// A way from a vertex of one rim to one of another.
struct Bridge {
  float length = INFINITY;
  std::uint32_t rim = 0, other = 0;
  std::uint32_t from = 0, to = 0;  ///< vertices
};

/// The shortest one between two rims.
Bridge shortest(const std::vector<HoleRim>& rims, std::uint32_t a, std::uint32_t b,
                std::span<const glm::vec3> positions,
                const std::function<bool(std::uint32_t, std::uint32_t)>& may_bridge) {
  Bridge best{INFINITY, a, b};
  for (const std::uint32_t v : rims[a].vertices)
    for (const std::uint32_t w : rims[b].vertices)
      if (const float length = glm::distance(positions[v], positions[w]); length < best.length && may_bridge(v, w))
        best = {length, a, b, v, w};
  return best;
}

/// The walk from its first visit to a vertex on.
void turn_to(HoleRim& rim, std::uint32_t vertex) {
  const auto at = std::find(rim.vertices.begin(), rim.vertices.end(), vertex) - rim.vertices.begin();
  std::rotate(rim.vertices.begin(), rim.vertices.begin() + at, rim.vertices.end());
  if (!rim.normals.empty()) std::rotate(rim.normals.begin(), rim.normals.begin() + at, rim.normals.end());
}

/// Round `to`, over the bridge, round `from` and back.
void join(HoleRim& to, HoleRim from, const Bridge& bridge) {
  turn_to(to, bridge.from);
  turn_to(from, bridge.to);
  const bool known = !to.normals.empty() && !from.normals.empty();
  to.vertices.push_back(bridge.from);
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  to.vertices.push_back(bridge.to);
  if (known) {
    to.normals.emplace_back(0.0f);
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
    to.normals.emplace_back(0.0f);
  } else {
    to.normals.clear();
  }
}

}  // namespace

std::vector<JoinedRims> join_islands(std::vector<HoleRim> rims, const std::vector<bool>& island,
                                     std::span<const glm::vec3> positions,
                                     const std::function<bool(std::uint32_t, std::uint32_t)>& may_bridge) {
  std::vector<Bridge> bridges;
  for (std::uint32_t a = 0; a < rims.size(); ++a)
    for (std::uint32_t b = a + 1; b < rims.size(); ++b)
      if (rims[a].piece != rims[b].piece && (island[rims[a].piece] || island[rims[b].piece]))
        bridges.push_back(shortest(rims, a, b, positions, may_bridge));
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.length < b.length; });
  std::vector<JoinedRims> joined;
  std::vector<std::uint32_t> place(rims.size());  // of each rim in `joined`
  for (std::uint32_t r = 0; r < rims.size(); ++r) {
    joined.push_back({std::move(rims[r]), {r}});
    place[r] = r;
  }
  DisjointSets pieces(island.size());
  std::vector<bool> held(island.size());  // of each set, by its root: it has a piece that is no island
  std::transform(island.begin(), island.end(), held.begin(), [](bool is) { return !is; });
  for (const Bridge& bridge : bridges) {
    if (!std::isfinite(bridge.length)) break;
    const std::uint32_t a = pieces.root(joined[bridge.rim].rim.piece), b = pieces.root(joined[bridge.other].rim.piece);
    if (a == b || (held[a] && held[b])) continue;
    const bool either = held[a] || held[b];
    pieces.join(a, b);
    held[pieces.root(a)] = either;
    JoinedRims &to = joined[place[bridge.rim]], &from = joined[place[bridge.other]];
    join(to.rim, std::move(from.rim), bridge);
    for (const std::uint32_t r : from.members) {
      to.members.push_back(r);
      place[r] = place[bridge.rim];
    }
    from.members.clear();
  }
  std::erase_if(joined, [](const JoinedRims& one) { return one.members.empty(); });
  return joined;
}

}  // namespace dubsar
