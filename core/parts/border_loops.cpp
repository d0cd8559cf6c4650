#include "core/parts/border_loops.h"

#include <algorithm>
#include <unordered_map>

namespace dubsar {

std::vector<std::vector<std::uint32_t>> join_loops(const std::vector<BorderEdge>& edges) {
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> leaving;  // by vertex; last one is taken first
  for (auto e = static_cast<std::uint32_t>(edges.size()); e-- > 0;) leaving[edges[e].from].push_back(e);
  std::vector<bool> used(edges.size(), false);
  const auto take = [&](std::uint32_t vertex) {
    const auto found = leaving.find(vertex);
    if (found == leaving.end()) return static_cast<std::uint32_t>(edges.size());
    while (!found->second.empty()) {
      const std::uint32_t e = found->second.back();
      found->second.pop_back();
      if (!used[e]) return e;
    }
    return static_cast<std::uint32_t>(edges.size());
  };

  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<std::uint32_t> path;                       // edges, end to start
  std::unordered_map<std::uint32_t, std::size_t> place;  // of the vertices the path starts from and visits
  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    path.assign(1, start);
    used[start] = true;
    place.clear();
    place[edges[start].from] = 0;
    while (!path.empty()) {
      const std::uint32_t vertex = edges[path.back()].to;
      if (const auto seen = place.find(vertex); seen != place.end()) {
        const std::size_t begin = seen->second;  // the path has come back: what lies between is a loop
        loops.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end());
        for (std::size_t i = begin; i < path.size(); ++i) place.erase(edges[path[i]].from);
        path.resize(begin);
        continue;
      }
      const std::uint32_t next = take(vertex);
      if (next == edges.size()) {  // a dead end at an open boundary: give up the last edge
        place.erase(edges[path.back()].from);
        path.pop_back();
        continue;
      }
      used[next] = true;
      place[vertex] = path.size();
      path.push_back(next);
    }
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

}  // namespace dubsar
