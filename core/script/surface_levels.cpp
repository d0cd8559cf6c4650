#include "core/script/surface_levels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace dubsar {
namespace {

constexpr double kLevelEdges = 12.0;  // a width: patches have 8 samples a width
constexpr std::uint32_t kNoCluster = 0xffffffffu;

/// Numbers of cubes in the order in which they are met. Neighbours along x lie beside each other in memory.
class CubeNumbers {
 public:
  explicit CubeNumbers(std::size_t most) {
    std::size_t size = 64;
    while (size < 2 * most) size *= 2;
    slots_.assign(size, {0, kNoCluster});
  }
  std::uint32_t number(const std::array<std::uint64_t, 3>& cube) {
    const std::uint64_t row = cube[1] << 21 | cube[2], key = row << 21 | cube[0];
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (static_cast<std::size_t>((row * 0x9e3779b97f4a7c15ull) >> 16) + cube[0]) & mask;
    while (slots_[at].number != kNoCluster && slots_[at].key != key) at = (at + 1) & mask;
    if (slots_[at].number == kNoCluster) slots_[at] = {key, count_++};
    return slots_[at].number;
  }
  std::uint32_t count() const noexcept { return count_; }

 private:
  struct Slot {
    std::uint64_t key;
    std::uint32_t number;
  };
  std::vector<Slot> slots_;
  std::uint32_t count_ = 0;
};

}  // namespace

PatchCells clustered(const PatchCells& cells, double cube_mm) {
  const std::vector<glm::vec3>& points = cells.points();
  CubeNumbers numbers(points.size());
  std::vector<std::uint32_t> cluster(points.size(), kNoCluster);
  std::vector<glm::dvec3> sums;
  std::vector<std::uint32_t> counts;
  std::vector<Triangle> triangles;
  triangles.reserve(cells.triangles().size() / 4);
  const auto cluster_of = [&](std::uint32_t v) {
    if (cluster[v] != kNoCluster) return cluster[v];
    const glm::dvec3 off = (glm::dvec3(points[v]) - cells.low_mm()) / cube_mm;
    std::array<std::uint64_t, 3> cube{};
    for (int a = 0; a < 3; ++a)
      cube[static_cast<std::size_t>(a)] = static_cast<std::uint64_t>(std::clamp(std::floor(off[a]), 0.0, 2097151.0));
    cluster[v] = numbers.number(cube);
    if (cluster[v] == sums.size()) {
      sums.emplace_back(0.0);
      counts.push_back(0);
    }
    sums[cluster[v]] += glm::dvec3(points[v]);
    ++counts[cluster[v]];
    return cluster[v];
  };
  for (const Triangle& t : cells.triangles()) {
    const Triangle coarse{cluster_of(t[0]), cluster_of(t[1]), cluster_of(t[2])};
    if (coarse[0] != coarse[1] && coarse[1] != coarse[2] && coarse[2] != coarse[0]) triangles.push_back(coarse);
  }
  std::vector<glm::vec3> means(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) means[k] = glm::vec3(sums[k] / static_cast<double>(counts[k]));
  return {std::move(means), std::move(triangles)};
}

const PatchCells& SurfaceLevels::for_width(double width_mm) {
  const double edge = fine().mean_edge_mm();
  std::size_t level = 0;
  for (double cube = 2.0 * edge; edge > 0.0 && kLevelEdges * cube <= width_mm; cube *= 2.0) {
    if (++level < levels_.size()) continue;
    levels_.push_back(std::make_unique<PatchCells>(clustered(*levels_.back(), cube)));
  }
  return *levels_[level];
}

}  // namespace dubsar
