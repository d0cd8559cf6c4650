#include "core/contact/dips.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kEdge = BrickMap<float>::kEdge;
/// Beyond the reach of the point spread: at two steps the dip of a film is still deep, at three it is over.
constexpr float kArm = 3.0f;
constexpr float kDisk = 3.2f, kDiskDeviation = 1.8f;
constexpr float kLeastDipCosine = 0.45f;  ///< flanks of wedges stand up to 60 degrees from the contact
constexpr float kNoDip = -1e30f;

struct Direction {
  glm::vec3 unit;
  glm::ivec3 arm;
  std::vector<glm::ivec3> disk;
  std::vector<float> weight;
};

std::vector<Direction> directions() {
  std::vector<Direction> all;
  for (int k = 0; k < 13; ++k) {  // half of the 26 neighbours
    const glm::ivec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    Direction d;
    d.unit = glm::normalize(glm::vec3(step));
    d.arm = step * static_cast<int>(std::lround(kArm / glm::length(glm::vec3(step))));
    float sum = 0.0f;
    for (int z = -3; z <= 3; ++z)
      for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) {
          const glm::vec3 q(x, y, z);
          if (glm::length(q) > kDisk || std::abs(glm::dot(q, d.unit)) > 0.45f) continue;
          d.disk.emplace_back(x, y, z);
          d.weight.push_back(std::exp(-0.5f * glm::dot(q, q) / (kDiskDeviation * kDiskDeviation)));
          sum += d.weight.back();
        }
    for (float& w : d.weight) w /= sum;
    all.push_back(std::move(d));
  }
  return all;
}

float mean(const BandDensity& density, const Direction& d, const glm::ivec3& p) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < d.disk.size(); ++i) {
    const glm::ivec3 q = p + d.disk[i];
    sum += d.weight[i] * density.get(q.x, q.y, q.z);
  }
  return sum;
}

bool in_clay(const BitVolume& inside, const glm::ivec3& p) {
  const Dims d = inside.dims();
  return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < d.x && p.y < d.y && p.z < d.z && inside.get(p.x, p.y, p.z);
}

float median(std::vector<float> values) {
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Result<BandDensity> BandDensity::read(const ContactBand& band, SlabSource& source, Progress& progress) {
  const Dims d = source.dims();
  DUBSAR_CHECK(d == band.node_at.dims());
  const Dims bricks = band.node_at.bricks();
  const auto wanted = [&](std::int64_t bx, std::int64_t by, std::int64_t bz) {
    for (std::int64_t k = 0; k < 27; ++k) {
      const std::int64_t x = bx + k % 3 - 1, y = by + k / 3 % 3 - 1, z = bz + k / 9 - 1;
      if (x >= 0 && y >= 0 && z >= 0 && x < bricks.x && y < bricks.y && z < bricks.z && band.node_at.has_brick(x, y, z))
        return true;
    }
    return false;
  };
  BrickMap<float> raw(d, 0.0f);
  std::vector<float> slab;
  progress.begin("contact density", bricks.z, "slab");
  for (std::int64_t bz = 0; bz < bricks.z; ++bz) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t z0 = bz * kEdge, z1 = std::min(z0 + kEdge, d.z);
    bool loaded = false;
    for (std::int64_t by = 0; by < bricks.y; ++by)
      for (std::int64_t bx = 0; bx < bricks.x; ++bx) {
        if (!wanted(bx, by, bz)) continue;
        if (!loaded) {
          slab.resize(static_cast<std::size_t>((z1 - z0) * d.slice()));
          DUBSAR_TRY(source.read(z0, z1, slab));
          loaded = true;
        }
        for (std::int64_t z = z0; z < z1; ++z)
          for (std::int64_t y = by * kEdge; y < std::min((by + 1) * kEdge, d.y); ++y)
            for (std::int64_t x = bx * kEdge; x < std::min((bx + 1) * kEdge, d.x); ++x)
              raw.at(x, y, z) = slab[static_cast<std::size_t>((z - z0) * d.slice() + y * d.x + x)];
      }
    progress.advance(1);
  }
  BrickMap<float> smooth(d, 0.0f);
  std::vector<std::array<std::int64_t, 3>> places;
  for (std::int64_t bz = 0; bz < bricks.z; ++bz)
    for (std::int64_t by = 0; by < bricks.y; ++by)
      for (std::int64_t bx = 0; bx < bricks.x; ++bx)
        if (raw.has_brick(bx, by, bz)) {
          places.push_back({bx, by, bz});
          smooth.at(bx * kEdge, by * kEdge, bz * kEdge) = 0.0f;  // all bricks are there before the threads write
        }
  parallel_for(static_cast<std::int64_t>(places.size()), 8, [&](std::int64_t i) {
    const auto [bx, by, bz] = places[static_cast<std::size_t>(i)];
    for (std::int64_t z = bz * kEdge; z < std::min((bz + 1) * kEdge, d.z); ++z)
      for (std::int64_t y = by * kEdge; y < std::min((by + 1) * kEdge, d.y); ++y)
        for (std::int64_t x = bx * kEdge; x < std::min((bx + 1) * kEdge, d.x); ++x) {
          float sum = 0.0f;
          for (std::int64_t k = 0; k < 27; ++k) {
            const std::int64_t dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
            const auto weight = static_cast<float>(1 << (3 - std::abs(dx) - std::abs(dy) - std::abs(dz)));
            sum += weight * raw.get(x + dx, y + dy, z + dz);
          }
          smooth.at(x, y, z) = sum / 64.0f;
        }
  });
  progress.end();
  return BandDensity(std::move(smooth));
}

Result<Dips> find_dips(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                       Progress& progress) {
  static const std::vector<Direction> kDirections = directions();
  Dips dips;
  dips.strength.assign(band.nodes.size(), kNoDip);
  dips.density.assign(band.nodes.size(), 0.0f);
  parallel_chunks(static_cast<std::int64_t>(band.nodes.size()), 4096, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (std::int64_t i = begin; i < end; ++i) {
      const auto node = static_cast<std::uint32_t>(i);
      const glm::ivec3 p = band.point(node);
      float best = kNoDip, least = density.get(p.x, p.y, p.z);
      for (const Direction& d : kDirections) {
        if (std::abs(glm::dot(d.unit, band.normal(node))) < kLeastDipCosine) continue;
        if (!in_clay(inside, p + d.arm) || !in_clay(inside, p - d.arm)) continue;
        const float middle = mean(density, d, p);
        const float dip = 0.5f * (mean(density, d, p + d.arm) + mean(density, d, p - d.arm)) - middle;
        if (dip > best) {
          best = dip;
          least = middle;
        }
      }
      dips.strength[node] = best;
      dips.density[node] = least;
    }
  });
  if (progress.cancelled()) return cancelled_error();
  // What clay shows far from the contact, in a robust measure: pores and grains are few.
  std::vector<float> quiet;
  for (std::size_t i = 0; i < band.nodes.size(); ++i)
    if (band.nodes[i].distance > 0.8f * band.reach && dips.strength[i] > kNoDip) quiet.push_back(dips.strength[i]);
  const float level = median(quiet);
  for (float& v : quiet) v = std::abs(v - level);
  dips.deviation = std::max(1.4826f * median(std::move(quiet)), 1e-30f);
  for (float& v : dips.strength) v = v > kNoDip ? (v - level) / dips.deviation : 0.0f;
  return dips;
}

}  // namespace dubsar
