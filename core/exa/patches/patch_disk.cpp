#include "core/exa/patches/patch_disk.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

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
}  // namespace

bool walk_disk(std::span<const std::uint32_t> rims, std::uint64_t most,
               const std::function<std::optional<DiskChoice>(const DiskEdge&)>& choose,
               std::vector<Triangle>& triangles) {
  std::vector<DiskNode> border;
  const auto add_loop = [&](std::uint32_t count) {
    const auto first = static_cast<std::uint32_t>(border.size());
    for (std::uint32_t i = 0; i < count; ++i)
      border.push_back({first + i, first + (i + 1) % count, first + (i + count - 1) % count, true});
  };
  if (rims.empty()) return false;
  for (const std::uint32_t count : rims) {
    if (count == 2) return false;
    add_loop(count);
  }
  for (auto piece = std::count(rims.begin(), rims.end(), 0u); piece > 0; --piece) {
    const auto first = static_cast<std::uint32_t>(border.size());
    triangles.push_back({first, first + 1, first + 2});
    add_loop(3);
    std::swap(border[first].vertex, border[first + 2].vertex);  // the other side of its edges
  }
  std::vector<std::uint32_t> queue(border.size());
  std::iota(queue.begin(), queue.end(), 0u);
  std::vector<std::uint8_t> at(border.size(), 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) at[v] = 1;
  std::uint64_t walked = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t i = queue[head];
    if (!border[i].alive) continue;
    const std::uint32_t j = border[i].next;
    if (j == i) continue;       // a vertex that no triangle has met
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
        k = choice->distance == 0 ? choice->node : choice->distance > 0 ? j : i;
        if (k >= border.size() || !border[k].alive) return false;
        for (std::int64_t step = 0; step < std::abs(std::int64_t{choice->distance}); ++step) {
          k = choice->distance > 0 ? border[k].next : border[k].before;
          if (++walked > kWalkedPerTriangle * most || k == (choice->distance > 0 ? i : j)) return false;
        }
        if (k == i || k == j || k == border[j].next || k == border[i].before) return false;
        if (border[k].next == k) {  // as a new vertex
          border[k].next = j;
          border[k].before = i;
          border[i].next = border[j].before = k;
          queue.insert(queue.end(), {i, k});
          break;
        }
        // k goes on before edge i; a copy of it closes the part between, or joins the border that k lies on.
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

std::vector<std::array<std::int64_t, 3>> spread_disk(std::span<const std::array<std::int64_t, 3>> rim,
                                                     std::span<const Triangle> triangles, std::size_t vertices) {
  std::vector<std::array<std::int64_t, 3>> p(rim.begin(), rim.end());
  p.resize(rim.size() + vertices, rim.empty() ? std::array<std::int64_t, 3>{0, 0, 0} : rim[0]);
  auto next = static_cast<std::uint32_t>(rim.size());
  for (const Triangle& t : triangles) {  // a new vertex is the third corner of its first triangle
    if (t[0] == next) next += 3;         // or one of the first of a closed piece
    if (t[2] < next) continue;
    ++next;
    for (std::size_t a = 0; a < 3; ++a) p[t[2]][a] = divided(p[t[0]][a] + p[t[1]][a], 2);
  }
  p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(rim.size()));
  return p;
}

}  // namespace dubsar
