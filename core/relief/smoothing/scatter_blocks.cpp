#include "core/relief/smoothing/scatter_blocks.h"

#include <algorithm>
#include <span>

#include "core/base/system/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/smoothing/scatter_blocks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Of `count` ids, at least one.
IdRange find_range(const std::uint32_t* ids, std::size_t count) {
  const hn::ScalableTag<std::uint32_t> d;
  const std::size_t lanes = hn::Lanes(d);
  IdRange range{ids[0], ids[0]};
  std::size_t i = 0;
  if (count >= lanes) {
    auto low = hn::LoadU(d, ids), high = low;
    for (i = lanes; i + lanes <= count; i += lanes) {
      const auto here = hn::LoadU(d, ids + i);
      low = hn::Min(low, here);
      high = hn::Max(high, here);
    }
    range = {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
  }
  for (; i < count; ++i) range.add({ids[i], ids[i]});
  return range;
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(find_range);
constexpr std::int64_t kGroupsAtOnce = 256;
constexpr auto kScatterBlock32 = static_cast<std::uint32_t>(kScatterBlock);

/// Sorts groups into the blocks that they touch. Nearly all touch one, or two that follow one another; of others
/// ids_of(group) is looked at one by one. range_of(group): of these ids.
template <class RangeOf, class IdsOf>
ScatterBlocks blocks_of(std::int64_t targets, std::uint32_t block_size, std::int64_t groups, const RangeOf& range_of,
                        const IdsOf& ids_of) {
  std::vector<IdRange> ranges(static_cast<std::size_t>(groups));
  parallel_for(groups, kGroupsAtOnce,
               [&](std::int64_t g) { ranges[static_cast<std::size_t>(g)] = range_of(static_cast<std::uint32_t>(g)); });
  ScatterBlocks blocks(static_cast<std::size_t>((targets + block_size - 1) / block_size));
  for (std::uint32_t g = 0; g < ranges.size(); ++g) {
    const IdRange& range = ranges[g];
    if (range.low > range.high) continue;
    const std::uint32_t low = range.low / block_size, high = range.high / block_size;
    if (high - low <= 1) {
      for (std::uint32_t b = low; b <= high; ++b) blocks[b].push_back(g);
      continue;
    }
    for (const std::uint32_t id : ids_of(g)) {
      std::vector<std::uint32_t>& block = blocks[id / block_size];
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
  const auto ids_of = [&](std::uint32_t g) {
    const auto begin = std::size_t{g} * kQuadGroup, end = std::min(begin + kQuadGroup, mesh.quads.size());
    return std::span(mesh.quads[begin].data(), 4 * (end - begin));
  };
  const auto range_of = [&](std::uint32_t g) {
    const auto ids = ids_of(g);
    return HWY_DYNAMIC_DISPATCH(find_range)(ids.data(), ids.size());
  };
  ScatterBlocks blocks = blocks_of(mesh.vertex_count(), kScatterBlock32, groups, range_of, ids_of);
  add_doubled(mesh, blocks);
  return blocks;
}

ScatterBlocks vertex_groups_of_quads(const QuadMesh& mesh, std::int64_t block) {
  const std::int64_t groups = (mesh.vertex_count() + kVertexGroup - 1) / kVertexGroup;
  const auto end_of = [&](std::uint32_t g) {
    return static_cast<std::uint32_t>(
        std::min<std::int64_t>((g + std::int64_t{1}) * kVertexGroup, mesh.vertex_count()));
  };
  return blocks_of(
      mesh.quad_count(), static_cast<std::uint32_t>(block), groups,
      [&](std::uint32_t g) { return range_around(mesh, g * kVertexGroup, end_of(g)); },
      [&](std::uint32_t g) {
        const std::uint32_t first = mesh.first_incident[std::size_t{g} * kVertexGroup];
        return std::span(mesh.incident).subspan(first, mesh.first_incident[end_of(g)] - first);
      });
}

IdRange range_around(const QuadMesh& mesh, std::uint32_t begin, std::uint32_t end) {
  IdRange range;
  for (std::uint32_t v = begin; v < end; ++v) {
    const std::uint32_t first = mesh.first_incident[v], next = mesh.first_incident[v + 1];
    if (first != next) range.add({mesh.incident[first], mesh.incident[next - 1]});  // they rise
  }
  return range;
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
#endif
