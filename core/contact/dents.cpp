#include "core/contact/dents.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"

namespace dubsar {
namespace {

constexpr int kNormalRounds = 20;  ///< of averages, so that the normals in a wedge are those around it
constexpr int kSpanRounds = 60;    ///< a sheet spans what is some 12 steps wide
constexpr float kDent = 1.2f;      ///< steps below it
constexpr std::size_t kNearest = 64;
constexpr float kDentSignificance = 2.5f;
constexpr float kMostDentStrength = 2.5f;  ///< of one vertex: the fringe of a pore is no film, however dark

template <class Work>
void each_vertex_of(std::size_t count, const Work& work) {
  parallel_for(static_cast<std::int64_t>(count), 1024, [&](std::int64_t i) { work(static_cast<std::size_t>(i)); });
}

std::vector<glm::vec3> wide_normals(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                    const std::vector<glm::vec3>& dual_positions) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const auto position = [&](std::uint32_t v) { return v < dual ? dual_positions[v] : mesh.added[v - dual]; };
  std::vector<glm::vec3> normals(mesh.added.size(), glm::vec3(0.0f)), next(normals.size());
  for (const Triangle& t : mesh.triangles) {
    const glm::vec3 a = position(t[0]), n = glm::cross(position(t[1]) - a, position(t[2]) - a);
    for (const std::uint32_t v : t)
      if (v >= dual) normals[v - dual] += n;
  }
  for (int round = 0; round < kNormalRounds; ++round) {
    each_vertex_of(next.size(), [&](std::size_t i) {
      next[i] = normals[i];
      for (const std::uint32_t w : rings.added[i]) next[i] += normals[w];
      next[i] /= static_cast<float>(rings.added[i].size() + 1);
    });
    normals.swap(next);
  }
  for (glm::vec3& n : normals) n = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0.0f);
  return normals;
}

/// How far each vertex lies below a sheet that only rises: wherever its neighbours are higher on average, it goes up to
/// them.
std::vector<float> depths(const InterfaceMesh& mesh, const InterfaceRings& rings,
                          const std::vector<glm::vec3>& dual_positions) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const std::vector<glm::vec3> up = wide_normals(mesh, rings, dual_positions);
  std::vector<glm::vec3> sheet = mesh.added, next = mesh.added;
  for (int round = 0; round < kSpanRounds; ++round) {
    each_vertex_of(sheet.size(), [&](std::size_t i) {
      next[i] = sheet[i];
      if (rings.all[i].empty()) return;
      glm::vec3 mean(0.0f);
      for (const std::uint32_t w : rings.all[i]) mean += w < dual ? dual_positions[w] : sheet[w - dual];
      mean /= static_cast<float>(rings.all[i].size());
      next[i] += std::max(glm::dot(mean - sheet[i], up[i]), 0.0f) * up[i];
    });
    sheet.swap(next);
  }
  std::vector<float> depth(sheet.size());
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = glm::dot(sheet[i] - mesh.added[i], up[i]);
  return depth;
}

}  // namespace

std::vector<bool> doubtful_dents(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                 const std::vector<glm::vec3>& dual_positions, const std::vector<bool>& film) {
  const std::vector<float> depth = depths(mesh, rings, dual_positions);
  const auto in_dent = [&](std::size_t i) { return film[i] && depth[i] > kDent; };
  std::vector<std::uint8_t> by_chance(depth.size(), 0);
  each_vertex_of(depth.size(), [&](std::size_t i) {
    if (!in_dent(i)) return;
    std::vector<std::uint32_t> nearest{static_cast<std::uint32_t>(i)};
    float sum = 0.0f;
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      sum += std::min(mesh.strength[nearest[k]], kMostDentStrength);
      for (const std::uint32_t w : rings.added[nearest[k]])
        if (nearest.size() < kNearest && in_dent(w) && std::find(nearest.begin(), nearest.end(), w) == nearest.end())
          nearest.push_back(w);
    }
    const auto count = static_cast<float>(nearest.size());
    by_chance[i] = sum / count < kClayStrength + kDentSignificance * kStrengthDeviation / std::sqrt(count);
  });
  std::vector<bool> doubtful(depth.size(), false);
  for (std::size_t i = 0; i < doubtful.size(); ++i) {
    if (by_chance[i] == 0) continue;
    doubtful[i] = true;
    for (const std::uint32_t w : rings.added[i]) doubtful[w] = true;
  }
  return doubtful;
}

}  // namespace dubsar
