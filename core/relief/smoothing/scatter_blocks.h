#pragma once
// Sums over x-quads at vertices, or over vertices at x-quads, without a search: each block of targets takes the groups
// of sources that touch it, in rising order, and adds what they give to its own targets in memory that stays near.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

inline constexpr std::int64_t kScatterBlock = 1 << 16;  ///< targets: few groups of sources touch two blocks
inline constexpr std::uint32_t kQuadGroup = 64, kVertexGroup = 2048;

/// Of block b, targets [b, b + 1) * kScatterBlock: the groups of sources of which at least one touches it, rising.
using ScatterBlocks = std::vector<std::vector<std::uint32_t>>;

/// Groups of kQuadGroup x-quads for blocks of vertices. Threads, deterministic.
ScatterBlocks quad_groups_of_vertices(const QuadMesh& mesh);
/// Groups of kVertexGroup vertices for blocks of `block` x-quads. Threads, deterministic.
ScatterBlocks vertex_groups_of_quads(const QuadMesh& mesh, std::int64_t block);

/// The lowest and highest id; lowest > highest: none.
struct IdRange {
  std::uint32_t low = ~std::uint32_t{0}, high = 0;
  void add(const IdRange& other) noexcept {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};
/// Of the x-quads around vertices [begin, end).
IdRange range_around(const QuadMesh& mesh, std::uint32_t begin, std::uint32_t end);

/// Memory for the sums of one block, handed from one thread to the next: fresh pages are slower than the sums.
class ScatterMemory {
 public:
  using Floats = std::vector<float>;
  explicit ScatterMemory(std::size_t floats) : floats_(floats) {}
  std::unique_ptr<Floats> take();
  void give_back(std::unique_ptr<Floats> memory);

 private:
  std::size_t floats_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Floats>> free_;
};

/// Calls work(rows, first, size, groups) for each block of vertices on all threads: `rows` of `floats` for each vertex
/// of [first, first + size) and one more, all 0.
template <class Work>
void scatter_to_vertices(const QuadMesh& mesh, std::size_t floats, const Work& work) {
  const ScatterBlocks blocks = quad_groups_of_vertices(mesh);
  ScatterMemory memory(floats * static_cast<std::size_t>(kScatterBlock + 1));
  parallel_for(static_cast<std::int64_t>(blocks.size()), 1, [&](std::int64_t b) {
    auto rows = memory.take();
    std::fill(rows->begin(), rows->end(), 0.0f);
    const std::int64_t first = b * kScatterBlock;
    work(rows->data(), first, std::min(kScatterBlock, mesh.vertex_count() - first),
         blocks[static_cast<std::size_t>(b)]);
    memory.give_back(std::move(rows));
  });
}

}  // namespace dubsar
