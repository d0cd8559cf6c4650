#include "core/contact/band.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {

bool between(const SurfaceModel& model, const FillPatch& patch) {
  if (patch.reverse_partition == PartitionTable::kNone) return false;
  const auto is_tablet = [&](PartitionId id) { return model.partitions[id].kind == PartitionKind::kTablet; };
  return is_tablet(patch.partition) != is_tablet(patch.reverse_partition);
}

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
      const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const float u = static_cast<float>(i) / static_cast<float>(steps),
                      v = static_cast<float>(j) / static_cast<float>(steps), w = 1.0f - u - v;
          const glm::vec3 n = w * normal(t[0]) + u * normal(t[1]) + v * normal(t[2]);
          const float length = glm::length(n);
          if (length > 0.0f) points.push_back({w * a + u * b + v * c, n / length});
        }
    }
  }
  return points;
}

Result<ContactBand> ContactBand::make(const BitVolume& inside, std::vector<PatchPoint> samples, float reach,
                                      Progress& progress) {
  const Dims d = inside.dims();
  ContactBand band{std::move(samples), {}, BrickMap<std::uint32_t>(d, kNone), reach};
  // Fronts of rising distance: a point takes the nearest sample that its neighbours know.
  constexpr float kBucket = 0.25f;
  struct Visit {
    std::int32_t x, y, z;
    std::uint32_t sample;
  };
  std::vector<std::vector<Visit>> buckets(static_cast<std::size_t>(reach / kBucket) + 2);
  BrickMap<std::uint32_t> nearest(d, kNone);
  const auto distance = [&](std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t s) {
    return glm::distance(glm::vec3(x, y, z), band.samples[s].position);
  };
  const auto offer = [&](std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t s) {
    if (x < 1 || y < 1 || z < 1 || x >= d.x - 1 || y >= d.y - 1 || z >= d.z - 1) return;
    const std::uint32_t known = nearest.get(x, y, z);
    if (known == s) return;
    const float far = distance(x, y, z, s);
    if (far > reach || (known != kNone && distance(x, y, z, known) <= far)) return;
    nearest.at(x, y, z) = s;
    buckets[static_cast<std::size_t>(far / kBucket)].push_back({x, y, z, s});
  };
  for (std::uint32_t s = 0; s < band.samples.size(); ++s) {
    const glm::vec3 p = glm::round(band.samples[s].position);
    offer(static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), static_cast<std::int32_t>(p.z), s);
  }
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    if (progress.cancelled()) return cancelled_error();
    for (std::size_t i = 0; i < buckets[b].size(); ++i) {
      const Visit v = buckets[b][i];
      if (nearest.get(v.x, v.y, v.z) != v.sample) continue;
      offer(v.x, v.y, v.z - 1, v.sample);
      offer(v.x, v.y - 1, v.z, v.sample);
      offer(v.x - 1, v.y, v.z, v.sample);
      offer(v.x + 1, v.y, v.z, v.sample);
      offer(v.x, v.y + 1, v.z, v.sample);
      offer(v.x, v.y, v.z + 1, v.sample);
    }
  }
  // Bricks in order, so that the nodes do not depend on how the fronts ran.
  const Dims bricks = nearest.bricks();
  for (std::int32_t bz = 0; bz < bricks.z; ++bz)
    for (std::int32_t by = 0; by < bricks.y; ++by)
      for (std::int32_t bx = 0; bx < bricks.x; ++bx) {
        if (!nearest.has_brick(bx, by, bz)) continue;
        for (std::int32_t k = 0; k < 512; ++k) {
          const std::int32_t x = 8 * bx + k % 8, y = 8 * by + k / 8 % 8, z = 8 * bz + k / 64;
          const std::uint32_t s = nearest.get(x, y, z);
          if (s == kNone || !inside.get(x, y, z)) continue;
          const glm::vec3 off = glm::vec3(x, y, z) - band.samples[s].position;
          band.node_at.at(x, y, z) = static_cast<std::uint32_t>(band.nodes.size());
          band.nodes.push_back({x, y, z, s, glm::dot(off, band.samples[s].normal), glm::length(off)});
        }
      }
  return band;
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
