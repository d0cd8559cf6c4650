#include "core/relief/occlusion/shared_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/result.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// Light from which neighbours differ too much to be one: some three times what 9 rays err by. An edge that throws a
/// shadow differs by more.
constexpr float kAlike = 0.2f;
constexpr int kRounds = 2;  ///< of averages: some 19 vertices lie so near

/// Of a neighbour, 0..1.
float likeness(const glm::vec3& normal, const glm::vec3& other, float difference) {
  const float facing = glm::dot(normal, other);
  if (!(facing > 0.0f)) return 0.0f;  // nor where it is not a number
  const float squared = facing * facing, far = difference / kAlike, apart = 1.0f + 0.5f * far * far;
  return squared * squared * squared * squared / (apart * apart);
}

}  // namespace

SkyRays sky_rays_of_part(int count, int parts, int part) {
  DUBSAR_CHECK(count >= 1 && count <= 65536 && parts >= 1 && part >= 0 && part < parts);
  constexpr double kGoldenAngle = 2.39996322972865332;  // pi (3 - sqrt 5)
  constexpr double kPartAngle = 4.74299561921826;       // 2 pi / 1.3247..., as even for two dimensions
  const int own = (count + parts - 1) / parts;
  const double shift = (part + 0.5) / parts;
  SkyRays sky;
  for (int i = 0; i < own; ++i) {
    const double z = 1.0 - (i + shift) / own, r = std::sqrt(1.0 - z * z),
                 azimuth = i * kGoldenAngle + part * kPartAngle;
    sky.directions.emplace_back(r * std::cos(azimuth), r * std::sin(azimuth), z);
    const double weight = r * std::sqrt(z);
    sky.weights.push_back(static_cast<float>(weight));
    sky.weight_sum += weight;
  }
  return sky;
}

int sky_part_at(const glm::vec3& position, int parts) {
  const glm::vec3 voxel = glm::floor(glm::clamp(position, glm::vec3(-1e6f), glm::vec3(1e6f)));
  const auto n = static_cast<float>(parts);
  const float sum = voxel.x + 7.0f * voxel.y + 8.0f * voxel.z;  // exact below 2^24
  return std::clamp(static_cast<int>(sum - n * std::floor(sum / n)), 0, parts - 1);
}

void share_light(std::span<const glm::vec3> normals, std::span<const Triangle> triangles, std::vector<float>& light) {
  std::vector<float> next(light.size());
  // Of a closed surface each side of a triangle runs the other way in its neighbour: every neighbour comes once.
  const auto average = [&](std::uint32_t begin, std::uint32_t end) {
    struct Sum {
      float light = 0.0f, weight = 0.0f;
    };
    std::vector<Sum> sums(end - begin);
    for (const Triangle& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = t[i], w = t[(i + 1) % 3];
        if (v - begin >= end - begin) continue;
        const float weight = likeness(normals[v], normals[w], light[w] - light[v]);
        sums[v - begin].light += weight * light[w];
        sums[v - begin].weight += weight;
      }
    for (std::uint32_t v = begin; v < end; ++v)
      next[v] = (light[v] + sums[v - begin].light) / (1.0f + sums[v - begin].weight);
  };
  const std::int64_t count = static_cast<std::int64_t>(light.size()), ranges = thread_count();
  const auto border = [&](std::int64_t range) { return static_cast<std::uint32_t>(count * range / ranges); };
  for (int round = 0; round < kRounds; ++round) {
    parallel_for(ranges, 1, [&](std::int64_t range) { average(border(range), border(range + 1)); });
    light.swap(next);
  }
}

}  // namespace dubsar
