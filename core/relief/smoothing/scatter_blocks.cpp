#include "core/relief/smoothing/scatter_blocks.h"

#include <algorithm>
#include <span>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {
constexpr std::int64_t kGroupsAtOnce = 256;
constexpr auto kScatterBlock32 = static_cast<std::uint32_t>(kScatterBlock);

/// The lowest and highest block that a group touches; lowest > highest: none.
struct TouchedBlocks {
  std::uint32_t low = ~std::uint32_t{0}, high = 0;
};

/// Blocks of the targets `ids`, from lowest to highest.
TouchedBlocks range_of(std::span<const std::uint32_t> ids) {
  std::uint32_t low = ~std::uint32_t{0}, high = 0;
  for (const std::uint32_t id : ids) {
    low = std::min(low, id);
    high = std::max(high, id);
  }
  if (ids.empty()) return {};
  return {low / kScatterBlock32, high / kScatterBlock32};
}

/// Sorts groups into the blocks that they touch. Nearly all touch one, or two that follow one another; of others
/// ids_of(group) is looked at one by one.
template <class IdsOf>
ScatterBlocks blocks_of(std::int64_t targets, std::int64_t groups, const IdsOf& ids_of) {
  std::vector<TouchedBlocks> ranges(static_cast<std::size_t>(groups));
  parallel_for(groups, kGroupsAtOnce, [&](std::int64_t g) {
    ranges[static_cast<std::size_t>(g)] = range_of(ids_of(static_cast<std::uint32_t>(g)));
  });
  ScatterBlocks blocks(static_cast<std::size_t>((targets + kScatterBlock - 1) / kScatterBlock));
  for (std::uint32_t g = 0; g < ranges.size(); ++g) {
    const TouchedBlocks& range = ranges[g];
    if (range.low <= range.high && range.high - range.low <= 1) {
      for (std::uint32_t b = range.low; b <= range.high; ++b) blocks[b].push_back(g);
      continue;
    }
    for (const std::uint32_t id : ids_of(g)) {
      std::vector<std::uint32_t>& block = blocks[id / kScatterBlock32];
      if (block.empty() || block.back() != g) block.push_back(g);
    }
  }
  return blocks;
}

/// Second vertices at doubled corners may lie in blocks of their own.
void add_doubled(const QuadMesh& mesh, ScatterBlocks& blocks) {
  for (const DoubledCorner& d : mesh.doubled) {
    const std::uint32_t group = d.quad / kQuadGroup;
    std::vector<std::uint32_t>& block = blocks[d.vertex / kScatterBlock32];
    const auto at = std::lower_bound(block.begin(), block.end(), group);
    if (at == block.end() || *at != group) block.insert(at, group);
  }
}
}  // namespace

ScatterBlocks quad_groups_of_vertices(const QuadMesh& mesh) {
  const std::int64_t groups = (mesh.quad_count() + kQuadGroup - 1) / kQuadGroup;
  ScatterBlocks blocks = blocks_of(mesh.vertex_count(), groups, [&](std::uint32_t g) {
    const auto begin = std::size_t{g} * kQuadGroup, end = std::min(begin + kQuadGroup, mesh.quads.size());
    return std::span(mesh.quads[begin].data(), 4 * (end - begin));
  });
  add_doubled(mesh, blocks);
  return blocks;
}

ScatterBlocks vertex_groups_of_quads(const QuadMesh& mesh) {
  const std::int64_t groups = (mesh.vertex_count() + kVertexGroup - 1) / kVertexGroup;
  return blocks_of(mesh.quad_count(), groups, [&](std::uint32_t g) {
    const auto begin = std::size_t{g} * kVertexGroup, end = std::min(begin + kVertexGroup, mesh.positions.size());
    return std::span(mesh.incident)
        .subspan(mesh.first_incident[begin], mesh.first_incident[end] - mesh.first_incident[begin]);
  });
}

std::unique_ptr<ScatterMemory::Floats> ScatterMemory::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      auto memory = std::move(free_.back());
      free_.pop_back();
      return memory;
    }
  }
  return std::make_unique<Floats>(floats_);
}

void ScatterMemory::give_back(std::unique_ptr<Floats> memory) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(memory));
}

}  // namespace dubsar
