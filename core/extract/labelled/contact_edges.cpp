#include "core/extract/labelled/contact_edges.h"

#include <algorithm>
#include <tuple>

#include "core/base/result.h"
#include "core/base/system/parallel.h"
#include "core/extract/row_kernels.h"

namespace dubsar {

ContactEdges::ContactEdges(const PointLabels& labels) : dims_(labels.inside().dims()) {
  const std::int64_t rows = dims_.y * dims_.z, grain = rows_per_chunk(dims_.x);
  const std::int64_t words = labels.inside().words_per_row();
  std::vector<std::vector<GridEdge>> chunks(static_cast<std::size_t>((rows + grain - 1) / grain));
  starts_.assign(static_cast<std::size_t>(rows) + 1, 0);
  parallel_chunks(rows, grain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<GridEdge>& found = chunks[static_cast<std::size_t>(begin / grain)];
    for (std::int64_t r = begin; r < end; ++r) {
      const std::int64_t y = r % dims_.y, z = r / dims_.y;
      const std::size_t before = found.size();
      for (int axis = 0; axis < 3; ++axis)
        for (std::int64_t w = 0; w < words; ++w) {
          const std::uint64_t tablet = labels.tablet_word(w, y, z), envelope = labels.envelope_word(w, y, z);
          const auto beside = [&](const auto& word_of) {
            if (axis == 1) return word_of(w, y + 1, z);
            if (axis == 2) return word_of(w, y, z + 1);
            return word_of(w, y, z) >> 1 | word_of(w + 1, y, z) << 63;
          };
          const auto tablet_of = [&](auto... at) { return labels.tablet_word(at...); };
          const auto envelope_of = [&](auto... at) { return labels.envelope_word(at...); };
          std::uint64_t differ = 0;
          if (tablet != 0) differ |= tablet & beside(envelope_of);
          if (envelope != 0) differ |= envelope & beside(tablet_of);
          for (; differ != 0; differ &= differ - 1)
            found.push_back({static_cast<std::int32_t>(64 * w + __builtin_ctzll(differ)), static_cast<std::int32_t>(y),
                             static_cast<std::int32_t>(z), axis});
        }
      starts_[static_cast<std::size_t>(r)] = static_cast<std::uint32_t>(found.size() - before);
    }
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) {
    const std::uint32_t count = start;
    start = sum;
    sum += count;
  }
  edges_.reserve(sum);
  for (const auto& chunk : chunks) edges_.insert(edges_.end(), chunk.begin(), chunk.end());
}

std::uint32_t ContactEdges::number(std::int64_t axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
  const auto row = static_cast<std::size_t>(z * dims_.y + y);
  const auto begin = edges_.begin() + starts_[row], end = edges_.begin() + starts_[row + 1];
  const auto found = std::lower_bound(begin, end, std::tuple(axis, x), [](const GridEdge& e, const auto& wanted) {
    return std::tuple<std::int64_t, std::int64_t>(e.axis, e.x) < wanted;
  });
  DUBSAR_CHECK(found != end && found->axis == axis && found->x == x);
  return static_cast<std::uint32_t>(found - edges_.begin());
}

}  // namespace dubsar
