#include "core/contact/band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

bool between(const SurfaceModel& model, const FillPatch& patch) {
  if (patch.reverse_partition == PartitionTable::kNone) return false;
  const auto is_tablet = [&](PartitionId id) { return model.partitions[id].kind == PartitionKind::kTablet; };
  return is_tablet(patch.partition) != is_tablet(patch.reverse_partition);
}

/// The nearest sample of points: found by fronts of rising distance for every other point along each axis, between
/// those by looking at what they know, and then among the samples around that one: fronts leave out most of those that
/// are closer together than the points from which they run.
class NearestSamples {
 public:
  static Result<NearestSamples> find(const std::vector<PatchPoint>& samples, const Dims& dims, float reach,
                                     Progress& progress) {
    NearestSamples found(samples, dims, reach);
    if (!found.run_fronts(progress)) return cancelled_error();
    return found;
  }

  /// Bricks of the whole grid that may have points of the band, in order.
  std::vector<glm::ivec3> bricks() const {
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

  /// visit(node) for the points of a brick that are inside and in reach of their nearest sample: of that, or for
  /// `counting` of any in reach.
  template <class Visit>
  void each_point(const glm::ivec3& brick, const BitVolume& inside, bool counting, const Visit& visit) const {
    const glm::ivec3 from = glm::max(brick * static_cast<int>(kEdge), 1),
                     to = glm::min((brick + 1) * static_cast<int>(kEdge), glm::ivec3(dims_.x, dims_.y, dims_.z) - 1);
    for (std::int32_t z = from.z; z < to.z; ++z)
      for (std::int32_t y = from.y; y < to.y; ++y) {
        std::uint32_t beside = ContactBand::kNone;  // that of the point before
        for (std::int32_t x = from.x; x < to.x; ++x) {
          if (!inside.get(x, y, z)) continue;
          const std::uint32_t s = nearest_of({x, y, z}, beside, counting);
          if (s == ContactBand::kNone) continue;
          if (!counting) beside = s;
          const glm::vec3 off = glm::vec3(x, y, z) - samples_[s].position;
          const float distance = glm::length(off);
          if (distance > reach_) continue;
          visit({x, y, z, s, glm::dot(off, samples_[s].normal), distance});
        }
      }
  }

 private:
  static constexpr std::int64_t kEdge = BrickMap<std::uint32_t>::kEdge;
  struct Visit {
    glm::ivec3 at;
    std::uint32_t sample;
  };
  using Buckets = std::vector<std::vector<Visit>>;

  NearestSamples(const std::vector<PatchPoint>& samples, const Dims& dims, float reach)
      : samples_(samples),
        dims_(dims),
        reach_(reach),
        known_({dims.x / 2 + 1, dims.y / 2 + 1, dims.z / 2 + 1}, ContactBand::kNone),
        first_at_(dims, ContactBand::kNone),
        next_(samples.size(), ContactBand::kNone) {
    for (std::uint32_t s = 0; s < samples.size(); ++s) {
      const glm::ivec3 p = point_of(s);
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= dims.x || p.y >= dims.y || p.z >= dims.z) continue;
      std::uint32_t& first = first_at_.at(p.x, p.y, p.z);
      std::uint32_t same = first;  // triangles beside each other have the same samples on their edge
      while (same != ContactBand::kNone && samples[same].position != samples[s].position) same = next_[same];
      if (same != ContactBand::kNone) continue;
      next_[s] = first;
      first = s;
    }
  }

  glm::ivec3 point_of(std::uint32_t s) const { return glm::ivec3(glm::round(samples_[s].position)); }
  glm::ivec3 coarse_place(std::uint32_t s) const { return glm::ivec3(glm::round(0.5f * samples_[s].position)); }
  bool in_coarse(const glm::ivec3& p) const {
    const Dims& d = known_.dims();
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < d.x && p.y < d.y && p.z < d.z;
  }

  float distance(const glm::ivec3& coarse, std::uint32_t s) const {
    return glm::distance(2.0f * glm::vec3(coarse), samples_[s].position);
  }

  bool run_fronts(Progress& progress) {
    constexpr float kBucket = 0.5f;
    const float reach = reach_ + 2.0f;  // whatever lies between known points is in reach of them
    Buckets buckets(static_cast<std::size_t>(reach / kBucket) + 2);
    const auto offer = [&](const glm::ivec3& p, std::uint32_t s) {
      if (!in_coarse(p)) return;
      const std::uint32_t before = known_.get(p.x, p.y, p.z);
      if (before == s) return;
      const float far = distance(p, s);
      if (far > reach || (before != ContactBand::kNone && distance(p, before) <= far)) return;
      known_.at(p.x, p.y, p.z) = s;
      buckets[static_cast<std::size_t>(far / kBucket)].push_back({p, s});
    };
    for (std::uint32_t s = 0; s < samples_.size(); ++s) offer(coarse_place(s), s);
    for (std::size_t b = 0; b < buckets.size(); ++b) {
      if (progress.cancelled()) return false;
      for (std::size_t i = 0; i < buckets[b].size(); ++i) {
        const Visit v = buckets[b][i];
        if (known_.get(v.at.x, v.at.y, v.at.z) == v.sample)
          each_beside(v.at, [&](const glm::ivec3& q) { offer(q, v.sample); });
      }
    }
    return true;
  }

  std::uint32_t nearest_of(const glm::ivec3& p, std::uint32_t guess, bool any_in_reach) const {
    const glm::ivec3 low = p / 2, high = (p + 1) / 2;
    std::uint32_t nearest = ContactBand::kNone, last = ContactBand::kNone;
    float least = INFINITY;
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::uint32_t s = known_.get(x, y, z);
          if (s == ContactBand::kNone || s == last) continue;
          last = s;
          const glm::vec3 off = glm::vec3(p) - samples_[s].position;
          const float square = glm::dot(off, off);
          if (square >= least) continue;
          least = square;
          nearest = s;
        }
    // Points are counted without a guess: none may bring one into reach.
    if (guess != ContactBand::kNone && nearest != ContactBand::kNone && least < reach_ * reach_) {
      const glm::vec3 off = glm::vec3(p) - samples_[guess].position;
      if (const float square = glm::dot(off, off); square < least) {
        least = square;
        nearest = guess;
      }
    }
    constexpr float kFar = 3.0f;  ///< no sample beside it is nearer by as much
    const bool may_be = nearest != ContactBand::kNone && least < (reach_ + kFar) * (reach_ + kFar);
    if (may_be && !(any_in_reach && least < reach_ * reach_)) look_around(p, nearest, least);
    return nearest;
  }

  /// Goes on to the nearest of the samples around `nearest`, at the square of a distance `least`.
  void look_around(const glm::ivec3& p, std::uint32_t& nearest, float& least) const {
    constexpr int kMostSteps = 4;
    for (int step = 0; step < kMostSteps; ++step) {
      const std::uint32_t before = nearest;
      const glm::ivec3 middle = point_of(before);
      // Beside the foot of the point on the patch, by no more than what is known lies, and half a diagonal of a cell.
      const glm::vec3 normal = samples_[before].normal, off = glm::vec3(p) - samples_[before].position;
      const float height = glm::dot(off, normal), aside = std::sqrt(std::max(least - height * height, 0.0f)) + 0.87f;
      for (int n = 0; n < 27; ++n) {
        const int k = (n + 13) % 27;  // its own place first
        const glm::ivec3 q = middle + glm::ivec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        const glm::vec3 way(q - p);
        const float up = glm::dot(way, normal);
        if (glm::dot(way, way) - up * up > aside * aside) continue;
        for (std::uint32_t s = first_at_.get(q.x, q.y, q.z); s != ContactBand::kNone; s = next_[s]) {
          const glm::vec3 to = glm::vec3(p) - samples_[s].position;
          const float square = glm::dot(to, to);
          if (square >= least) continue;
          least = square;
          nearest = s;
        }
      }
      if (nearest == before || point_of(nearest) == middle) break;
    }
  }

  const std::vector<PatchPoint>& samples_;
  Dims dims_;
  float reach_;
  BrickMap<std::uint32_t> known_;
  BrickMap<std::uint32_t> first_at_;  ///< of the samples nearest to each point, those at one place once
  std::vector<std::uint32_t> next_;   ///< at the same point
};

}  // namespace

std::vector<PatchPoint> sample_patches(const SurfaceModel& model, float spacing) {
  std::vector<PatchPoint> points;
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  std::vector<glm::vec3> normals(dual, glm::vec3(0.0f)), added;
  for (const FillPatch& patch : model.patches) {
    if (!between(model, patch)) continue;
    const float sense = model.partitions[patch.partition].kind == PartitionKind::kTablet ? 1.0f : -1.0f;
    added.assign(patch.extra_positions.size(), glm::vec3(0.0f));
    const auto position = [&](std::uint32_t v) {
      return v < dual ? model.mesh.positions[v] : patch.extra_positions[v - dual];
    };
    const auto normal = [&](std::uint32_t v) -> glm::vec3& { return v < dual ? normals[v] : added[v - dual]; };
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t) normal(v) = glm::vec3(0.0f);
    for (const Triangle& t : patch.triangles) {
      const glm::vec3 a = position(t[0]), n = sense * glm::cross(position(t[1]) - a, position(t[2]) - a);
      for (const std::uint32_t v : t) normal(v) += n;
    }
    for (const Triangle& t : patch.triangles) {
      const glm::vec3 a = position(t[0]), b = position(t[1]), c = position(t[2]);
      const std::array<bool, 3> rim{t[0] < dual, t[1] < dual, t[2] < dual};
      const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const float u = static_cast<float>(i) / static_cast<float>(steps),
                      v = static_cast<float>(j) / static_cast<float>(steps), w = 1.0f - u - v;
          const glm::vec3 n = w * normal(t[0]) + u * normal(t[1]) + v * normal(t[2]);
          const float length = glm::length(n);
          const float of_rim = (rim[0] ? w : 0.0f) + (rim[1] ? u : 0.0f) + (rim[2] ? v : 0.0f);
          if (length > 0.0f) points.push_back({w * a + u * b + v * c, n / length, of_rim > 0.5f});
        }
    }
  }
  return points;
}

glm::vec3 middle_of(const std::vector<PatchPoint>& samples) {
  glm::vec3 least(INFINITY), most(-INFINITY);
  for (const PatchPoint& sample : samples) {
    least = glm::min(least, sample.position);
    most = glm::max(most, sample.position);
  }
  return samples.empty() ? glm::vec3(0.0f) : 0.5f * (least + most);
}

Result<ContactBand> ContactBand::make(const BitVolume& inside, std::vector<PatchPoint> samples, float reach,
                                      Progress& progress) {
  ContactBand band{std::move(samples), {}, BrickMap<std::uint32_t>(inside.dims(), kNone), reach, reach};
  DUBSAR_ASSIGN(const NearestSamples nearest, NearestSamples::find(band.samples, inside.dims(), reach, progress));
  const std::vector<glm::ivec3> bricks = nearest.bricks();
  std::vector<std::int64_t> first(bricks.size());
  const auto each_brick = [&](bool counting, const auto& work) {
    parallel_for(static_cast<std::int64_t>(bricks.size()), 16, [&](std::int64_t b) {
      if (progress.cancelled()) return;
      const auto at = static_cast<std::size_t>(b);
      nearest.each_point(bricks[at], inside, counting, [&](const Node& node) { work(at, node); });
    });
  };
  each_brick(true, [&](std::size_t b, const Node&) { ++first[b]; });
  for (std::size_t b = 0; b < bricks.size(); ++b)
    if (first[b] > 0) band.node_at.add_brick(bricks[b].x, bricks[b].y, bricks[b].z);
  band.nodes.resize(static_cast<std::size_t>(exclusive_scan(first)));
  each_brick(false, [&](std::size_t b, const Node& node) {
    const std::int64_t n = first[b]++;
    band.node_at.at(node.x, node.y, node.z) = static_cast<std::uint32_t>(n);
    band.nodes[static_cast<std::size_t>(n)] = node;
  });
  if (progress.cancelled()) return cancelled_error();
  return band;
}

void ContactBand::trim_envelope(float reach) {
  envelope_reach = reach;
  std::erase_if(nodes, [&](const Node& node) { return node.distance > reach_at(node.height); });
  node_at = BrickMap<std::uint32_t>(node_at.dims(), kNone);
  for (std::uint32_t n = 0; n < nodes.size(); ++n) node_at.at(nodes[n].x, nodes[n].y, nodes[n].z) = n;
}

void grow(const ContactBand& band, int steps, std::vector<bool>& marked) {
  std::vector<std::uint32_t> front, next;
  for (std::uint32_t n = 0; n < marked.size(); ++n)
    if (marked[n]) front.push_back(n);
  for (int step = 0; step < steps; ++step) {
    next.clear();
    for (const std::uint32_t n : front)
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        const std::uint32_t m = band.at(q);
        if (m == ContactBand::kNone || marked[m]) return;
        marked[m] = true;
        next.push_back(m);
      });
    front.swap(next);
  }
}

}  // namespace dubsar
