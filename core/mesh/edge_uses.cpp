#include "core/mesh/edge_uses.h"

#include <algorithm>
#include <tuple>

#include "core/base/numbers/counting_sort.h"

namespace dubsar {

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles) {
  constexpr std::size_t kMostKeys = 8;  // for each item; beyond it counting them takes longer than sorting
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  std::uint32_t least = 0xffffffffu, most = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), 3 * t + i, a < b});
      least = std::min(least, uses.back().low);
      most = std::max(most, uses.back().low);
    }
  const auto by_edge = [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side);
  };
  if (uses.empty() || (most - least) / kMostKeys >= uses.size()) {
    std::sort(uses.begin(), uses.end(), by_edge);
    return uses;
  }
  counting_sort(uses, std::size_t{most - least} + 1, [&](const EdgeUse& use) { return use.low - least; });
  for (auto begin = uses.begin(), end = begin; begin != uses.end(); begin = end) {
    while (end != uses.end() && end->low == begin->low) ++end;
    std::sort(begin, end, by_edge);
  }
  return uses;
}

std::vector<bool> sides_alone(std::span<const Triangle> triangles) {
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  std::vector<bool> alone(3 * triangles.size(), false);
  for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
    end = end_of_edge(uses, begin);
    if (end - begin == 1) alone[uses[begin].side] = true;
  }
  return alone;
}

}  // namespace dubsar
