#include "core/exa/patches/patch_disk.h"

#include <algorithm>
#include <cstdlib>
#include <unordered_map>

namespace dubsar {
namespace {
constexpr std::uint64_t kWalkedPerTriangle = 16;
constexpr int kSweeps = 32;  // more change the bits by less than 2 %

/// The mean of `count` numbers from their sum, rounded down, without a division: sums are below 2^48 once they are made
/// positive, and the inverse is less than count / 2^64 too large, so the product never reaches the next number.
class Mean {
 public:
  explicit Mean(std::size_t count)
      : count_(static_cast<std::int64_t>(count)),
        inverse_(count > 1 && count < 1024 ? ~std::uint64_t{0} / count + 1 : 0),
        below_(count << kBelow) {}
  std::int64_t of(std::int64_t sum) const {
    const std::uint64_t above = static_cast<std::uint64_t>(sum) + below_;
    if (inverse_ == 0 || above >> 48 != 0) return divided(sum, count_);
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(Wide{above} * inverse_ >> 64)) -
           (std::int64_t{1} << kBelow);
  }

 private:
  static constexpr int kBelow = 36;  ///< sums of numbers from -2^36 on are made positive
  std::int64_t count_;
  std::uint64_t inverse_, below_;
};

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

/// The edges that only one triangle has, as one loop, the lowest id first; empty when they are not one loop.
std::vector<std::uint32_t> rim_of(const FillPatch& patch,
                                  const std::unordered_map<std::uint64_t, std::uint32_t>& triangle_of) {
  std::unordered_map<std::uint32_t, std::uint32_t> next;
  std::uint32_t start = ~std::uint32_t{0};
  for (const Triangle& t : patch.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = t[c], to = t[(c + 1) % 3];
      if (triangle_of.contains(edge_key(to, from))) continue;
      if (!next.emplace(from, to).second) return {};
      start = std::min(start, from);
    }
  std::vector<std::uint32_t> rim;
  for (std::uint32_t at = start; rim.size() < next.size();) {
    rim.push_back(at);
    const auto found = next.find(at);
    if (found == next.end()) return {};
    at = found->second;
    if (at == start) break;
  }
  return rim.size() == next.size() ? rim : std::vector<std::uint32_t>();
}
}  // namespace

bool walk_disk(std::uint32_t rim, std::uint64_t most,
               const std::function<std::optional<DiskChoice>(const DiskEdge&)>& choose,
               std::vector<Triangle>& triangles) {
  if (rim < 3) return false;
  std::vector<DiskNode> border(rim);
  std::vector<std::uint32_t> queue(rim);
  std::vector<std::uint8_t> at(rim, 0);
  for (std::uint32_t i = 0; i < rim; ++i) {
    border[i] = {i, i + 1 == rim ? 0 : i + 1, i == 0 ? rim - 1 : i - 1, true};
    queue[i] = i;
  }
  std::uint64_t walked = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t i = queue[head];
    if (!border[i].alive) continue;
    const std::uint32_t j = border[i].next;
    if (border[j].next == i) {  // both sides of one edge
      border[i].alive = border[j].alive = false;
      continue;
    }
    const std::optional<DiskChoice> choice = choose({border, i, at});
    if (!choice || triangles.size() >= most) return false;
    std::uint32_t k = 0;
    switch (choice->step) {
      case DiskStep::kNew:
        k = static_cast<std::uint32_t>(border.size());
        border.push_back({static_cast<std::uint32_t>(at.size()), j, i, true});
        at.push_back(0);
        border[i].next = border[j].before = k;
        queue.insert(queue.end(), {i, k});
        break;
      case DiskStep::kNext:
        k = border[j].next;
        border[j].alive = false;
        border[i].next = k;
        border[k].before = i;
        queue.push_back(i);
        break;
      case DiskStep::kBefore:
        k = border[i].before;
        border[i].alive = false;
        border[k].next = j;
        border[j].before = k;
        queue.push_back(k);
        break;
      case DiskStep::kOther: {
        k = choice->distance > 0 ? j : i;
        for (std::int64_t step = 0; step < std::abs(std::int64_t{choice->distance}); ++step) {
          k = choice->distance > 0 ? border[k].next : border[k].before;
          if (++walked > kWalkedPerTriangle * most || k == (choice->distance > 0 ? i : j)) return false;
        }
        if (k == i || k == j || k == border[j].next || k == border[i].before) return false;
        // k goes on before edge i; a copy of it closes the part between.
        const auto copy = static_cast<std::uint32_t>(border.size());
        border.push_back({border[k].vertex, j, border[k].before, true});
        border[border[k].before].next = copy;
        border[j].before = copy;
        border[i].next = k;
        border[k].before = i;
        queue.insert(queue.end(), {i, copy});
        break;
      }
    }
    // A node that died still says where its edge began; its successor may be another by now.
    const Triangle t{border[i].vertex, border[j].vertex, border[k].vertex};
    for (const std::uint32_t v : t) at[v] = static_cast<std::uint8_t>(std::min(at[v] + 1, 7));
    triangles.push_back(t);
  }
  return true;
}

std::optional<DiskPatch> disk_of(const FillPatch& patch, std::uint32_t vertex_count) {
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_of;
  for (std::uint32_t t = 0; t < patch.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (!triangle_of.emplace(edge_key(patch.triangles[t][c], patch.triangles[t][(c + 1) % 3]), t).second)
        return std::nullopt;
  DiskPatch disk;
  disk.rim = rim_of(patch, triangle_of);
  const auto rim = static_cast<std::uint32_t>(disk.rim.size());
  if (rim < 3 || *std::max_element(disk.rim.begin(), disk.rim.end()) >= vertex_count) return std::nullopt;
  std::vector<std::uint32_t> ids = disk.rim;                // by number in the walk
  std::unordered_map<std::uint32_t, std::uint32_t> number;  // and back
  for (std::uint32_t i = 0; i < rim; ++i) number.emplace(ids[i], i);
  std::vector<bool> used(patch.triangles.size(), false);
  const auto choose = [&](const DiskEdge& edge) -> std::optional<DiskChoice> {
    const DiskNode& here = edge.border[edge.node];
    const std::uint32_t to = edge.border[here.next].vertex;
    const auto found = triangle_of.find(edge_key(ids[here.vertex], ids[to]));
    if (found == triangle_of.end() || used[found->second]) return std::nullopt;
    used[found->second] = true;
    const Triangle& t = patch.triangles[found->second];
    const std::uint32_t third = t[0] != ids[here.vertex] && t[0] != ids[to]   ? t[0]
                                : t[1] != ids[here.vertex] && t[1] != ids[to] ? t[1]
                                                                              : t[2];
    DiskChoice choice;
    const auto known = number.find(third);
    if (known == number.end()) {
      if (third < vertex_count) return std::nullopt;
      number.emplace(third, static_cast<std::uint32_t>(ids.size()));
      ids.push_back(third);
      disk.order.push_back(third - vertex_count);
    } else if (edge.border[edge.border[here.next].next].vertex == known->second) {
      choice.step = DiskStep::kNext;
    } else if (edge.border[here.before].vertex == known->second) {
      choice.step = DiskStep::kBefore;
    } else {
      choice.step = DiskStep::kOther;
      std::uint32_t forth = here.next, back = edge.node;
      for (std::int32_t step = 1; choice.distance == 0; ++step) {
        forth = edge.border[forth].next;
        back = edge.border[back].before;
        if (edge.border[forth].vertex == known->second)
          choice.distance = step;
        else if (edge.border[back].vertex == known->second)
          choice.distance = -step;
        else if (forth == edge.node)
          return std::nullopt;
      }
    }
    disk.choices.push_back(choice);
    return choice;
  };
  const std::uint64_t most = patch.triangles.size();
  if (!walk_disk(rim, most, choose, disk.triangles) || disk.triangles.size() != patch.triangles.size() ||
      disk.order.size() != patch.extra_positions.size())
    return std::nullopt;
  return disk;
}

DiskNeighbours::DiskNeighbours(std::uint32_t rim, std::size_t vertices, std::span<const Triangle> triangles)
    : first(vertices + 1, 0) {
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t)
      if (v >= rim) ++first[v - rim + 1];
  for (std::size_t i = 0; i < vertices; ++i) first[i + 1] += first[i];
  ids.resize(first[vertices]);
  std::vector<std::uint32_t> at(first.begin(), first.end());
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (t[c] >= rim) ids[at[t[c] - rim]++] = t[(c + 1) % 3];
}

std::vector<std::array<std::int64_t, 3>> relaxed_disk(std::span<const std::array<std::int64_t, 3>> rim,
                                                      std::span<const Triangle> triangles, std::size_t vertices) {
  const auto first = static_cast<std::uint32_t>(rim.size());
  std::vector<std::array<std::int64_t, 3>> p(rim.begin(), rim.end());
  std::array<std::int64_t, 3> centre{0, 0, 0};
  for (const auto& at : rim)
    for (std::size_t a = 0; a < 3; ++a) centre[a] += at[a];
  for (std::int64_t& c : centre) c = divided(c, static_cast<std::int64_t>(first));
  for (const Triangle& t : triangles) {  // a new vertex is the third corner of its first triangle
    if (t[2] < p.size()) continue;
    p.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) p.back()[a] = divided(3 * p[t[0]][a] + 3 * p[t[1]][a] + 2 * centre[a], 8);
  }
  const DiskNeighbours neighbours(first, vertices, triangles);
  std::vector<Mean> means;
  means.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) means.emplace_back(neighbours.of(i).size());
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < vertices; ++i) {
      std::array<std::int64_t, 3> sum{0, 0, 0};
      for (const std::uint32_t w : neighbours.of(i))
        for (std::size_t a = 0; a < 3; ++a) sum[a] += p[w][a];
      for (std::size_t a = 0; a < 3; ++a) {
        std::int64_t& here = p[first + i][a];
        here += 3 * (means[i].of(sum[a]) - here) >> 1;  // rounded down
      }
    }
  p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(first));
  return p;
}

}  // namespace dubsar
