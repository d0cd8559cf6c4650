#include "core/mesh/folds.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace dubsar {
namespace {

using Corner = std::tuple<float, float, float>;

struct Placed {
  PartitionId part;
  std::array<Corner, 3> corners;  ///< sorted
  bool turned;                    ///< against the order of the sorted corners
  std::size_t triangle;

  auto key() const { return std::tie(part, corners); }
  bool operator<(const Placed& other) const {
    return std::tie(part, corners, turned, triangle) <
           std::tie(other.part, other.corners, other.turned, other.triangle);
  }
};

Placed placed(const TriMesh& mesh, std::size_t t) {
  Placed out{mesh.partition_of(t), {}, false, t};
  for (std::size_t c = 0; c < 3; ++c) {
    const glm::vec3& p = mesh.positions[mesh.triangles[t][c]];
    out.corners[c] = {p.x, p.y, p.z};
  }
  const auto order = [&](std::size_t a, std::size_t b) {
    if (out.corners[b] < out.corners[a]) {
      std::swap(out.corners[a], out.corners[b]);
      out.turned = !out.turned;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return out;
}

template <class T>
void keep(std::vector<T>& items, const std::vector<bool>& gone) {
  if (items.empty()) return;
  std::size_t to = 0;
  for (std::size_t from = 0; from < items.size(); ++from)
    if (!gone[from]) items[to++] = items[from];
  items.resize(to);
}

}  // namespace

std::int64_t remove_folds(TriMesh& mesh) {
  std::vector<Placed> all;
  all.reserve(mesh.triangles.size());
  std::vector<bool> gone(mesh.triangles.size());
  std::int64_t removed = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Placed here = placed(mesh, t);
    gone[t] = here.corners[0] == here.corners[1] || here.corners[1] == here.corners[2];
    if (gone[t])
      ++removed;
    else
      all.push_back(here);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].key() == all[begin].key()) ++end;
    std::size_t turned = begin;  // those that are not come first
    while (turned < end && !all[turned].turned) ++turned;
    for (std::size_t k = 0; k < std::min(turned - begin, end - turned); ++k) {
      gone[all[begin + k].triangle] = gone[all[turned + k].triangle] = true;
      removed += 2;
    }
  }
  if (removed == 0) return 0;
  keep(mesh.triangle_partition, gone);
  keep(mesh.triangle_inferred, gone);
  keep(mesh.triangles, gone);
  return removed;
}

}  // namespace dubsar
