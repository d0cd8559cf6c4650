#include "core/contact/labelled/clay_labels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <unordered_map>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kNodeGrain = 1 << 14;
constexpr std::int64_t kSlab = BrickMap<std::uint32_t>::kEdge;  ///< slices whose nodes follow each other

constexpr std::uint32_t kLeastIsland = 64;  ///< nodes; fewer in the midst of the other clay are a speck of the cut

/// Nodes of one side that hang together with no clay beyond the band of the same label, few, beside clay of the other.
std::vector<std::uint32_t> find_islands(const BitVolume& inside, const ContactBand& band,
                                        const std::vector<ClaySide>& side, const EnvelopeBits& labels) {
  constexpr std::uint8_t kAnchored = 1, kBeside = 2;
  const Dims d = inside.dims();
  const auto count = static_cast<std::int64_t>(side.size());
  ConcurrentSets pieces(side.size());
  std::vector<std::uint8_t> of_node(side.size(), 0), of_piece(side.size(), 0);
  parallel_for(count, kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m != ContactBand::kNone) {
        if (side[m] != side[n])
          of_node[n] |= kBeside;
        else if (n < m)
          pieces.join(n, m);
        return;
      }
      if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= d.x || q.y >= d.y || q.z >= d.z || !inside.get(q.x, q.y, q.z)) return;
      const bool envelope = labels.word(q.x >> 6, q.y, q.z) >> (q.x & 63) & 1u;
      of_node[n] |= envelope == (side[n] == ClaySide::kEnvelope) ? kAnchored : kBeside;
    });
  });
  parallel_for(count, kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    std::atomic_ref piece(of_piece[pieces.root(n)]);
    if ((of_node[n] & ~piece.load(std::memory_order_relaxed)) != 0)
      piece.fetch_or(of_node[n], std::memory_order_relaxed);
  });
  using Nodes = std::vector<std::uint32_t>;
  Nodes loose =
      parallel_gather<std::uint32_t>(count, kNodeGrain, [&](std::int64_t begin, std::int64_t end, Nodes& found) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
          if (of_piece[pieces.root(n)] == kBeside) found.push_back(n);
      });
  std::unordered_map<std::uint32_t, std::uint32_t> size;
  for (const std::uint32_t n : loose) ++size[pieces.root(n)];
  std::erase_if(loose, [&](std::uint32_t n) { return size[pieces.root(n)] >= kLeastIsland; });
  return loose;
}

/// Runs of clay along x in one row, without those of the band.
void add_runs(const std::uint64_t* inside, const std::uint64_t* in_band, const Dims& dims,
              std::vector<ClayBeyond::Run>& runs) {
  const std::int64_t words = (dims.x + 63) / 64;
  std::uint64_t before = 0;  // the last point of the word before
  for (std::int64_t w = 0; w < words; ++w) {
    const std::uint64_t clay = inside[w] & ~in_band[w];
    for (std::uint64_t turns = clay ^ (clay << 1 | before); turns != 0; turns &= turns - 1) {
      const auto x = static_cast<std::int32_t>(64 * w + std::countr_zero(turns));
      if (clay >> (x & 63) & 1u)
        runs.push_back({x, static_cast<std::int32_t>(dims.x), 0});
      else
        runs.back().end = x;
    }
    before = clay >> 63;
  }
}

}  // namespace

ClayBeyond::ClayBeyond(const BitVolume& inside, const ContactBand& band) : inside_(inside), band_(band) {
  find_runs();
  find_pieces();
  touched_.assign(runs_.size(), false);
  const Dims d = inside.dims();
  using Found = std::vector<Beside>;
  const auto nodes = static_cast<std::int64_t>(band.nodes.size());
  beside_ = parallel_gather<Beside>(nodes, kNodeGrain, [&](std::int64_t begin, std::int64_t end, Found& found) {
    for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= d.x || q.y >= d.y || q.z >= d.z) return;
        if (!inside.get(q.x, q.y, q.z) || band.at(q) != ContactBand::kNone) return;
        found.push_back({n, runs_[run_at(q)].piece});
      });
  });
  for (const Beside& beside : beside_) touched_[beside.piece] = true;
}

void ClayBeyond::find_runs() {
  const Dims d = inside_.dims();
  const auto slabs = static_cast<std::size_t>((d.z + kSlab - 1) / kSlab);
  std::vector<std::vector<Run>> found(slabs);
  first_.assign(static_cast<std::size_t>(d.y * d.z) + 1, 0);  // of each row behind itself: how many there are
  parallel_for(static_cast<std::int64_t>(slabs), 1, [&](std::int64_t s) {
    std::vector<Run>& runs = found[static_cast<std::size_t>(s)];
    const std::int64_t from = kSlab * s, end = std::min(from + kSlab, d.z);
    BitVolume in_band({d.x, d.y, end - from});
    const auto before = [](const ContactBand::Node& node, std::int64_t z) { return node.z < z; };
    for (auto node = std::lower_bound(band_.nodes.begin(), band_.nodes.end(), from, before);
         node != band_.nodes.end() && node->z < end; ++node)
      in_band.set(node->x, node->y, node->z - from, true);
    for (std::int64_t z = from; z < end; ++z)
      for (std::int64_t y = 0; y < d.y; ++y) {
        const std::size_t already = runs.size();
        add_runs(inside_.row(y, z), in_band.row(y, z - from), d, runs);
        first_[row(y, z) + 1] = static_cast<std::uint32_t>(runs.size() - already);
      }
  });
  for (const std::vector<Run>& runs : found) runs_.insert(runs_.end(), runs.begin(), runs.end());
  for (std::size_t r = 1; r < first_.size(); ++r) first_[r] += first_[r - 1];
}

void ClayBeyond::find_pieces() {
  DisjointSets pieces(runs_.size());
  const auto join_rows = [&](std::size_t a, std::size_t b) {
    std::uint32_t i = first_[a], j = first_[b];
    while (i < first_[a + 1] && j < first_[b + 1]) {
      if (runs_[i].begin < runs_[j].end && runs_[j].begin < runs_[i].end) pieces.join(i, j);
      if (runs_[i].end < runs_[j].end)
        ++i;
      else
        ++j;
    }
  };
  const Dims d = inside_.dims();
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y) {
      if (y > 0) join_rows(row(y - 1, z), row(y, z));
      if (z > 0) join_rows(row(y, z - 1), row(y, z));
    }
  for (std::uint32_t i = 0; i < runs_.size(); ++i) runs_[i].piece = pieces.root(i);
}

std::uint32_t ClayBeyond::run_at(const glm::ivec3& p) const {
  const std::size_t r = row(p.y, p.z);
  const auto found = std::upper_bound(runs_.begin() + first_[r], runs_.begin() + first_[r + 1], p.x,
                                      [](std::int32_t x, const Run& run) { return x < run.begin; });
  return static_cast<std::uint32_t>(found - runs_.begin() - 1);
}

bool ClayBeyond::touches(const glm::ivec3& p) const {
  return band_.at(p) != ContactBand::kNone || touched_[runs_[run_at(p)].piece];
}

EnvelopeBits ClayBeyond::labels(const std::vector<ClaySide>& side) const {
  EnvelopeBits labels(inside_.dims());
  for (std::uint32_t n = 0; n < band_.nodes.size(); ++n)
    if (side[n] == ClaySide::kEnvelope) labels.set(band_.nodes[n].x, band_.nodes[n].y, band_.nodes[n].z, true);
  std::vector<std::int32_t> envelope(runs_.size(), 0);  // nodes beside each piece, less those of the tablet
  for (const auto& [node, piece] : beside_) envelope[piece] += side[node] == ClaySide::kEnvelope ? 1 : -1;
  const Dims d = inside_.dims();
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::uint32_t i = first_[row(y, z)]; i < first_[row(y, z) + 1]; ++i)
        if (envelope[runs_[i].piece] > 0) labels.set_run(runs_[i].begin, runs_[i].end, y, z);
  for (const std::uint32_t n : find_islands(inside_, band_, side, labels)) {
    const glm::ivec3 p = band_.point(n);
    labels.set(p.x, p.y, p.z, side[n] == ClaySide::kTablet);
  }
  labels.compact(inside_);
  return labels;
}

}  // namespace dubsar
