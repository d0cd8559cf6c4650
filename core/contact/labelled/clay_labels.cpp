#include "core/contact/labelled/clay_labels.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/numbers/disjoint_sets.h"

namespace dubsar {
namespace {

/// Clay beyond the band, as runs along x.
class ClayRuns {
 public:
  ClayRuns(const BitVolume& inside, const BitVolume& in_band) : dims_(inside.dims()) {
    first_.push_back(0);
    for (std::int64_t z = 0; z < dims_.z; ++z)
      for (std::int64_t y = 0; y < dims_.y; ++y) {
        add_row(inside.row(y, z), in_band.row(y, z), inside.words_per_row());
        first_.push_back(static_cast<std::uint32_t>(runs_.size()));
      }
    pieces_.reset(runs_.size());
    for (std::int64_t z = 0; z < dims_.z; ++z)
      for (std::int64_t y = 0; y < dims_.y; ++y) {
        if (y > 0) join_rows(row(y - 1, z), row(y, z));
        if (z > 0) join_rows(row(y, z - 1), row(y, z));
      }
  }

  struct Run {
    std::int32_t begin, end;
  };
  std::size_t row(std::int64_t y, std::int64_t z) const { return static_cast<std::size_t>(z * dims_.y + y); }
  std::size_t size() const { return runs_.size(); }
  std::uint32_t piece(std::uint32_t run) { return pieces_.root(run); }
  /// The run that holds a point of clay beyond the band.
  std::uint32_t at(const glm::ivec3& p) const {
    const std::size_t r = row(p.y, p.z);
    const auto found = std::upper_bound(runs_.begin() + first_[r], runs_.begin() + first_[r + 1], p.x,
                                        [](std::int32_t x, const Run& run) { return x < run.begin; });
    return static_cast<std::uint32_t>(found - runs_.begin() - 1);
  }
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::int64_t z = 0; z < dims_.z; ++z)
      for (std::int64_t y = 0; y < dims_.y; ++y)
        for (std::uint32_t i = first_[row(y, z)]; i < first_[row(y, z) + 1]; ++i) visit(i, runs_[i], y, z);
  }

 private:
  void add_row(const std::uint64_t* inside, const std::uint64_t* in_band, std::int64_t words) {
    std::uint64_t before = 0;  // the last point of the word before
    for (std::int64_t w = 0; w < words; ++w) {
      const std::uint64_t clay = inside[w] & ~in_band[w];
      for (std::uint64_t turns = clay ^ (clay << 1 | before); turns != 0; turns &= turns - 1) {
        const auto x = static_cast<std::int32_t>(64 * w + std::countr_zero(turns));
        if (clay >> (x & 63) & 1u)
          runs_.push_back({x, static_cast<std::int32_t>(dims_.x)});
        else
          runs_.back().end = x;
      }
      before = clay >> 63;
    }
  }
  void join_rows(std::size_t a, std::size_t b) {
    std::uint32_t i = first_[a], j = first_[b];
    while (i < first_[a + 1] && j < first_[b + 1]) {
      if (runs_[i].begin < runs_[j].end && runs_[j].begin < runs_[i].end) pieces_.join(i, j);
      if (runs_[i].end < runs_[j].end)
        ++i;
      else
        ++j;
    }
  }

  Dims dims_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> first_;  ///< of each row, and behind the last
  DisjointSets pieces_;
};

constexpr std::uint32_t kLeastIsland = 64;  ///< nodes; fewer in the midst of the other clay are a speck of the cut

/// Nodes of one side that hang together with no clay beyond the band of the same label, few, beside clay of the other.
std::vector<std::uint32_t> find_islands(const BitVolume& inside, const ContactBand& band,
                                        const std::vector<ClaySide>& side, const EnvelopeBits& labels) {
  DisjointSets pieces(side.size());
  std::vector<bool> anchored(side.size(), false), beside(side.size(), false);
  const Dims d = inside.dims();
  const auto count = static_cast<std::uint32_t>(side.size());
  for (std::uint32_t n = 0; n < count; ++n)
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m != ContactBand::kNone) {
        if (side[m] == side[n]) pieces.join(n, m);
        beside[n] = beside[n] || side[m] != side[n];
        return;
      }
      if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= d.x || q.y >= d.y || q.z >= d.z || !inside.get(q.x, q.y, q.z)) return;
      const bool envelope = labels.word(q.x >> 6, q.y, q.z) >> (q.x & 63) & 1u;
      const bool same = envelope == (side[n] == ClaySide::kEnvelope);
      anchored[n] = anchored[n] || same;
      beside[n] = beside[n] || !same;
    });
  std::vector<std::uint32_t> size(count, 0);
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t root = pieces.root(n);
    ++size[root];
    if (anchored[n]) anchored[root] = true;
    if (beside[n]) beside[root] = true;
  }
  std::vector<std::uint32_t> islands;
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t root = pieces.root(n);
    if (size[root] < kLeastIsland && !anchored[root] && beside[root]) islands.push_back(n);
  }
  return islands;
}

}  // namespace

EnvelopeBits label_clay(const BitVolume& inside, const ContactBand& band, const std::vector<ClaySide>& side,
                        BitVolume* unasked) {
  BitVolume in_band(inside.dims());
  EnvelopeBits labels(inside.dims());
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n) {
    const glm::ivec3 p = band.point(n);
    in_band.set(p.x, p.y, p.z, true);
    if (side[n] == ClaySide::kEnvelope) labels.set(p.x, p.y, p.z, true);
  }
  ClayRuns runs(inside, in_band);
  std::vector<std::array<std::int64_t, 2>> votes(runs.size(), {0, 0});
  const Dims d = inside.dims();
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= d.x || q.y >= d.y || q.z >= d.z) return;
      if (inside.get(q.x, q.y, q.z) && !in_band.get(q.x, q.y, q.z))
        ++votes[runs.piece(runs.at(q))][static_cast<std::size_t>(side[n])];
    });
  runs.each([&](std::uint32_t i, const ClayRuns::Run& run, std::int64_t y, std::int64_t z) {
    const auto& [tablet, envelope] = votes[runs.piece(i)];
    if (envelope > tablet) labels.set_run(run.begin, run.end, y, z);
    if (unasked != nullptr && envelope + tablet == 0)
      for (std::int32_t x = run.begin; x < run.end; ++x) unasked->set(x, y, z, true);
  });
  for (const std::uint32_t n : find_islands(inside, band, side, labels)) {
    const glm::ivec3 p = band.point(n);
    labels.set(p.x, p.y, p.z, side[n] == ClaySide::kTablet);
  }
  labels.compact(inside);
  return labels;
}

}  // namespace dubsar
