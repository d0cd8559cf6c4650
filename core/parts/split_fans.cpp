#include "core/parts/split_fans.h"

#include <algorithm>
#include <atomic>
#include <span>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/mesh/fans.h"

namespace dubsar {
namespace {

constexpr std::int64_t kVertexGrain = 1 << 14;

/// A triangle's corner at a border vertex.
struct Corner {
  std::uint32_t vertex;
  std::uint32_t place;  ///< 3 * triangle + 0, 1 or 2
};

/// Corners by vertex, in the order of the triangles.
struct CornersAround {
  LargeArray<std::uint32_t> places;
  std::vector<std::uint32_t> first;  ///< of each vertex in `places`, and the end

  /// Every thread looks through all corners for those of its own range of vertices, so that the order is that of one.
  CornersAround(const std::vector<std::vector<Corner>>& lists, std::size_t vertices) {
    constexpr std::int64_t kLeast = 1 << 16, kMostRanges = 8;
    const auto count = static_cast<std::int64_t>(vertices);
    const std::int64_t ranges =
        std::clamp<std::int64_t>(count / kLeast, 1, std::min<std::int64_t>(thread_count(), kMostRanges));
    const std::int64_t length = (count + ranges - 1) / ranges;
    const auto each_of = [&](std::int64_t range, const auto& visit) {
      const auto low = static_cast<std::uint32_t>(range * length),
                 size = static_cast<std::uint32_t>(std::min(length, count - range * length));
      for (const std::vector<Corner>& list : lists)
        for (const Corner& corner : list)
          if (corner.vertex - low < size) visit(corner);
    };
    resize_large(first, vertices + 1);
    parallel_for(ranges, 1,
                 [&](std::int64_t range) { each_of(range, [&](const Corner& corner) { ++first[corner.vertex]; }); });
    std::uint32_t total = 0;
    for (std::uint32_t& f : first) {
      const std::uint32_t here = f;
      f = total;
      total += here;
    }
    places = LargeArray<std::uint32_t>(total);
    // Each start moves on to the next one's, and so all are one vertex ahead in the end.
    parallel_for(ranges, 1, [&](std::int64_t range) {
      each_of(range, [&](const Corner& corner) { places.data()[first[corner.vertex]++] = corner.place; });
    });
    for (std::size_t v = vertices; v > 0; --v) first[v] = first[v - 1];
    first[0] = 0;
  }
  std::span<std::uint32_t> of(std::uint32_t vertex) {
    return {places.data() + first[vertex], places.data() + first[vertex + 1]};
  }
};

/// What becomes of the vertices of a range.
struct Division {
  struct Change {
    std::uint32_t place;
    std::uint32_t copy;  ///< of this range
  };
  std::vector<std::uint32_t> copies;  ///< the vertices that they stand for
  std::vector<Change> changes;
};

/// Divides one vertex at a time.
class Divider {
 public:
  Divider(const TriangleSoup& soup, Division& division) : soup_(soup), division_(division) {}

  void divide(std::uint32_t vertex, std::span<std::uint32_t> places) {
    const auto group_of = [&](std::uint32_t place) { return soup_.group[place / 3]; };
    if (!std::ranges::is_sorted(places, {}, group_of)) std::ranges::stable_sort(places, {}, group_of);
    bool original_taken = false;
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
      fans_.clear();
      for (end = begin; end < places.size() && group_of(places[end]) == group_of(places[begin]); ++end) {
        const Triangle& t = soup_.triangles[places[end] / 3];
        const std::size_t c = places[end] % 3;
        fans_.add(t[(c + 1) % 3], t[(c + 2) % 3]);
      }
      // The first fan of a vertex keeps it, all others get copies.
      const std::uint32_t count = fans_.find(), kept = original_taken ? 0 : 1;
      original_taken = true;
      const auto first_new = static_cast<std::uint32_t>(division_.copies.size());
      division_.copies.insert(division_.copies.end(), count - kept, vertex);
      if (count == kept) continue;
      for (std::size_t i = begin; i < end; ++i)
        if (const std::uint32_t fan = fans_.of_corner()[i - begin]; fan >= kept)
          division_.changes.push_back({places[i], first_new + fan - kept});
    }
  }

 private:
  const TriangleSoup& soup_;
  Division& division_;
  Fans fans_;
};

/// The corners at border vertices: a list for each range of triangles.
std::vector<std::vector<Corner>> border_corners(const TriangleSoup& soup, const std::vector<std::uint8_t>& border) {
  return lists_of_triangles<Corner>(soup, [&](std::size_t t, std::vector<Corner>& found) {
    for (std::uint32_t c = 0; c < 3; ++c)
      if (const std::uint32_t v = soup.triangles[t][c]; v < border.size() && border[v] != 0)
        found.push_back({v, 3 * static_cast<std::uint32_t>(t) + c});
  });
}

}  // namespace

Result<std::vector<std::uint32_t>> split_fans(TriangleSoup& soup, const std::vector<std::uint8_t>& border,
                                              std::uint32_t first_copy, const Progress* progress) {
  const auto cancelled = [&] { return progress != nullptr && progress->cancelled(); };
  CornersAround around(border_corners(soup, border), first_copy);
  if (cancelled()) return cancelled_error();
  const auto vertices = static_cast<std::int64_t>(first_copy);
  std::vector<Division> divisions(static_cast<std::size_t>((vertices + kVertexGrain - 1) / kVertexGrain));
  parallel_chunks(vertices, kVertexGrain, [&](std::int64_t begin, std::int64_t end) {
    if (cancelled()) return;
    Divider divider(soup, divisions[static_cast<std::size_t>(begin / kVertexGrain)]);
    for (auto v = static_cast<std::uint32_t>(begin); v < static_cast<std::uint64_t>(end); ++v)
      if (const auto places = around.of(v); !places.empty()) divider.divide(v, places);
  });
  if (cancelled()) return cancelled_error();
  std::vector<std::uint32_t> copies;
  for (const Division& division : divisions) {
    const std::uint32_t first_new = first_copy + static_cast<std::uint32_t>(copies.size());
    copies.insert(copies.end(), division.copies.begin(), division.copies.end());
    for (const Division::Change& change : division.changes)
      soup.triangles[change.place / 3][change.place % 3] = first_new + change.copy;
  }
  return copies;
}

}  // namespace dubsar
