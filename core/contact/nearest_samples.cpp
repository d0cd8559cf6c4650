#include "core/contact/nearest_samples.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/contact/kernels/nearest_places.h"

namespace dubsar {
namespace {

glm::ivec3 coarse_place(const PatchPoint& sample) { return glm::ivec3(glm::round(0.5f * sample.position)); }

/// Grid points of a cube, each of them seen or not.
class SeenPoints {
 public:
  SeenPoints(const glm::ivec3& first, int side)
      : first_(first), side_(side), words_(static_cast<std::size_t>((side * side * side + 63) / 64)) {}
  /// Was it not seen before? It is from now on.
  bool is_new(const glm::ivec3& p) {
    const glm::ivec3 at = p - first_;
    const auto bit = static_cast<std::size_t>((at.z * side_ + at.y) * side_ + at.x);
    const std::uint64_t mask = std::uint64_t{1} << bit % 64;
    const bool seen = (words_[bit / 64] & mask) != 0;
    words_[bit / 64] |= mask;
    return !seen;
  }

 private:
  glm::ivec3 first_;
  int side_;
  std::vector<std::uint64_t> words_;
};

}  // namespace

Result<NearestSamples> NearestSamples::find(const std::vector<PatchPoint>& samples, const Dims& dims, float reach,
                                            Progress& progress) {
  NearestSamples found(samples, dims, reach);
  if (!found.run_fronts(progress)) return cancelled_error();
  return found;
}

NearestSamples::NearestSamples(const std::vector<PatchPoint>& samples, const Dims& dims, float reach)
    : samples_(samples),
      dims_(dims),
      reach_(reach),
      known_({dims.x / 2 + 1, dims.y / 2 + 1, dims.z / 2 + 1}, kNone),
      cell_at_(dims, kNone) {
  fill_cells();
}

void NearestSamples::fill_cells() {
  std::vector<std::uint32_t> last, before(samples_.size(), kNone);  // of a cell, those that it has in turn
  for (std::uint32_t s = 0; s < samples_.size(); ++s) {
    const glm::ivec3 p = point_of(s);
    if (!in_grid(p)) continue;
    std::uint32_t& cell = cell_at_.at(p.x, p.y, p.z);
    if (cell == kNone) {
      cell = static_cast<std::uint32_t>(last.size());
      last.push_back(kNone);
    }
    std::uint32_t same = last[cell];  // triangles beside each other have the same samples on their edge
    while (same != kNone && samples_[same].position != samples_[s].position) same = before[same];
    if (same != kNone) continue;
    before[s] = last[cell];
    last[cell] = s;
  }
  first_.reserve(last.size() + 1);
  for (const std::uint32_t of_cell : last) {
    first_.push_back(static_cast<std::uint32_t>(listed_.size()));
    for (std::uint32_t s = of_cell; s != kNone; s = before[s]) listed_.push_back(s);
  }
  first_.push_back(static_cast<std::uint32_t>(listed_.size()));
}

std::vector<glm::ivec3> NearestSamples::bricks() const {
  const Dims coarse = known_.bricks();
  const auto count = [](std::int64_t points) { return (points + kEdge - 1) / kEdge; };
  std::vector<glm::ivec3> found;
  for (std::int64_t z = 0; z < count(dims_.z); ++z)
    for (std::int64_t y = 0; y < count(dims_.y); ++y)
      for (std::int64_t x = 0; x < count(dims_.x); ++x)
        if (x / 2 < coarse.x && y / 2 < coarse.y && z / 2 < coarse.z && known_.has_brick(x / 2, y / 2, z / 2))
          found.emplace_back(x, y, z);
  return found;
}

bool NearestSamples::run_fronts(Progress& progress) {
  struct Front {
    glm::ivec3 at;
    std::uint32_t sample;
  };
  constexpr float kBucket = 0.5f;
  const float reach = reach_ + 2.0f;  // whatever lies between known points is in reach of them
  std::vector<std::vector<Front>> buckets(static_cast<std::size_t>(reach / kBucket) + 2);
  const Dims d = known_.dims();
  const auto distance = [&](const glm::ivec3& p, std::uint32_t s) {
    return glm::distance(2.0f * glm::vec3(p), samples_[s].position);
  };
  const auto offer = [&](const glm::ivec3& p, std::uint32_t s) {
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= d.x || p.y >= d.y || p.z >= d.z) return;
    const std::uint32_t before = known_.get(p.x, p.y, p.z);
    if (before == s) return;
    const float far = distance(p, s);
    if (far > reach || (before != kNone && distance(p, before) <= far)) return;
    known_.at(p.x, p.y, p.z) = s;
    buckets[static_cast<std::size_t>(far / kBucket)].push_back({p, s});
  };
  for (std::uint32_t s = 0; s < samples_.size(); ++s) offer(coarse_place(samples_[s]), s);
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    if (progress.cancelled()) return false;
    for (std::size_t i = 0; i < buckets[b].size(); ++i) {
      const Front front = buckets[b][i];
      if (known_.get(front.at.x, front.at.y, front.at.z) == front.sample)
        each_beside(front.at, [&](const glm::ivec3& q) { offer(q, front.sample); });
    }
    buckets[b] = {};
  }
  return true;
}

void NearestSamples::add(std::uint32_t s, Nearby& near) const {
  const glm::vec3& p = samples_[s].position;
  near.x.push_back(p.x);
  near.y.push_back(p.y);
  near.z.push_back(p.z);
  near.sample.push_back(s);
}

NearestSamples::Nearby NearestSamples::nearby(const glm::ivec3& corner) const {
  const int around = static_cast<int>(std::ceil(reach_)) + 4;  // as far as run_fronts() goes, and a cell beside that
  SeenPoints middles(corner - around, static_cast<int>(kEdge) + 1 + 2 * around), seen = middles;
  Nearby near;
  const glm::ivec3 first = corner / 2, last = (corner + static_cast<int>(kEdge)) / 2;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const std::uint32_t s = known_.get(x, y, z);
        if (s == kNone) continue;
        const glm::ivec3 p = point_of(s);
        if (!middles.is_new(p)) continue;
        if (!in_grid(p)) add(s, near);
        for (int k = 0; k < 125; ++k) {
          const glm::ivec3 q = p + glm::ivec3(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2);
          if (!seen.is_new(q)) continue;
          const std::uint32_t cell = cell_at_.get(q.x, q.y, q.z);
          if (cell == kNone) continue;
          for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) add(listed_[i], near);
        }
      }
  return near;
}

void NearestSamples::add_nodes(const glm::ivec3& brick, const BitVolume& inside,
                               std::vector<ContactBand::Node>& nodes) const {
  static_assert(kEdge == kNearestEdge);
  constexpr int kPoints = static_cast<int>(kEdge);
  const glm::ivec3 corner = brick * kPoints;
  const Nearby near = nearby(corner);
  if (near.sample.empty()) return;
  std::array<std::int32_t, kEdge * kEdge * kEdge> nearest;
  nearest_places({near.x, near.y, near.z}, corner, nearest);
  const glm::ivec3 from = glm::max(corner, 1),
                   to = glm::min(corner + kPoints, glm::ivec3(dims_.x, dims_.y, dims_.z) - 1);
  for (std::int32_t z = from.z; z < to.z; ++z)
    for (std::int32_t y = from.y; y < to.y; ++y)
      for (std::int32_t x = from.x; x < to.x; ++x) {
        if (!inside.get(x, y, z)) continue;
        const glm::ivec3 at = glm::ivec3(x, y, z) - corner;
        const std::int32_t k = nearest[static_cast<std::size_t>((at.z * kPoints + at.y) * kPoints + at.x)];
        const std::uint32_t s = near.sample[static_cast<std::size_t>(k)];
        const glm::vec3 off = glm::vec3(x, y, z) - samples_[s].position;
        const float distance = glm::length(off);
        if (distance <= reach_) nodes.push_back({x, y, z, s, glm::dot(off, samples_[s].normal), distance});
      }
}

}  // namespace dubsar
