#include "core/contact/labelled/clay_labels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/numbers/sort_unique.h"
#include "core/base/system/parallel_gather.h"
#include "core/extract/labelled/point_labels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kNodeGrain = 1 << 14;
constexpr std::int64_t kSlab = BrickMap<std::uint32_t>::kEdge;  ///< slices whose nodes follow each other

constexpr std::uint32_t kLeastIsland = 64;  ///< nodes; fewer in the midst of the other clay are a speck of the cut

/// Of 64 points of a row the clay that has clay of the other beside it.
std::uint64_t beside_other(const PointLabels& labels, std::int64_t w, std::int64_t y, std::int64_t z) {
  const auto around = [&](const auto& word_of) {
    const std::uint64_t here = word_of(w, y, z);
    return here << 1 | word_of(w - 1, y, z) >> 63 | here >> 1 | word_of(w + 1, y, z) << 63 | word_of(w, y - 1, z) |
           word_of(w, y + 1, z) | word_of(w, y, z - 1) | word_of(w, y, z + 1);
  };
  const auto tablet = [&](auto... at) { return labels.tablet_word(at...); };
  const auto envelope = [&](auto... at) { return labels.envelope_word(at...); };
  return (tablet(w, y, z) & around(envelope)) | (envelope(w, y, z) & around(tablet));
}

/// Nodes of one label that hang together with no clay beyond the band of the same label, few, beside clay of the other.
std::vector<std::uint32_t> find_islands(const ContactBand& band, const PointLabels& labels) {
  using Nodes = std::vector<std::uint32_t>;
  std::vector<std::uint8_t> anchored(band.nodes.size(), 0);  // known to be of no island
  /// Does a node hang together with few others, which are put into `piece`?
  const auto is_island = [&](std::uint32_t n, Nodes& piece) {
    const PointLabel own = labels.get(band.nodes[n].x, band.nodes[n].y, band.nodes[n].z);
    bool island = true;
    piece.assign(1, n);
    for (std::size_t i = 0; island && i < piece.size(); ++i)
      each_beside(band.point(piece[i]), [&](const glm::ivec3& q) {
        if (!island || labels.get(q.x, q.y, q.z) != own) return;
        const std::uint32_t m = band.at(q);
        island = m != ContactBand::kNone && std::atomic_ref(anchored[m]).load(std::memory_order_relaxed) == 0;
        if (!island || std::ranges::find(piece, m) != piece.end()) return;
        piece.push_back(m);
        island = piece.size() < kLeastIsland;
      });
    if (!island)
      for (const std::uint32_t m : piece) std::atomic_ref(anchored[m]).store(1, std::memory_order_relaxed);
    return island;
  };
  Nodes found = parallel_gather<std::uint32_t>(
      static_cast<std::int64_t>(band.nodes.size()), kNodeGrain, [&](std::int64_t begin, std::int64_t end, Nodes& part) {
        Nodes piece;
        glm::ivec3 row(-1);  // of the node before: its word, y, z
        std::uint64_t other = 0;
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n) {
          const glm::ivec3 p = band.point(n), own(p.x >> 6, p.y, p.z);
          if (own != row) other = beside_other(labels, own.x, own.y, own.z);
          row = own;
          if ((other >> (p.x & 63) & 1u) == 0 || std::atomic_ref(anchored[n]).load(std::memory_order_relaxed) != 0)
            continue;
          if (is_island(n, piece)) part.insert(part.end(), piece.begin(), piece.end());
        }
      });
  sort_unique(found);
  return found;
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
  for (const std::uint32_t n : find_islands(band_, PointLabels(inside_, labels))) {
    const glm::ivec3 p = band_.point(n);
    labels.set(p.x, p.y, p.z, side[n] == ClaySide::kTablet);
  }
  labels.compact(inside_);
  return labels;
}

}  // namespace dubsar
