#include "core/contact/interface_shape.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr int kEvidenceRounds = 8;  ///< of averaging over neighbours: about three rings
constexpr int kFilmRounds = 3;
constexpr int kMembraneRounds = 200;

/// Neighbours of each added vertex, each once.
std::vector<std::vector<std::uint32_t>> neighbours_of(const InterfaceMesh& mesh, std::uint32_t dual) {
  std::vector<std::vector<std::uint32_t>> around(mesh.added.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= dual)
        for (const std::uint32_t w : t)
          if (w != v) around[v - dual].push_back(w);
  for (auto& list : around) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return around;
}

}  // namespace

std::vector<std::uint8_t> shape_interface(InterfaceMesh& mesh, const std::vector<glm::vec3>& dual_positions,
                                          float film_strength, float most) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const auto around = neighbours_of(mesh, dual);
  std::vector<float> strength = mesh.strength, next(strength.size());
  for (int round = 0; round < kEvidenceRounds; ++round) {
    for (std::size_t i = 0; i < around.size(); ++i) {
      float sum = strength[i], count = 1.0f;
      for (const std::uint32_t w : around[i])
        if (w >= dual) {
          sum += strength[w - dual];
          count += 1.0f;
        }
      next[i] = sum / count;
    }
    strength.swap(next);
  }
  std::vector<std::uint8_t> evidence(around.size());
  for (std::size_t i = 0; i < around.size(); ++i)
    evidence[i] = evidence_byte(strength[i] >= film_strength ? Evidence::kFilm : Evidence::kInferred);

  const std::vector<glm::vec3> start = mesh.added;
  std::vector<glm::vec3> moved = mesh.added;
  const auto position = [&](std::uint32_t v) { return v < dual ? dual_positions[v] : mesh.added[v - dual]; };
  const auto relax = [&](Evidence which, float share) {
    for (std::size_t i = 0; i < around.size(); ++i) {
      moved[i] = mesh.added[i];
      if (evidence[i] != evidence_byte(which) || around[i].empty()) continue;
      glm::vec3 mean(0.0f);
      for (const std::uint32_t w : around[i]) mean += position(w);
      mean /= static_cast<float>(around[i].size());
      const glm::vec3 step = mesh.added[i] + share * (mean - mesh.added[i]) - start[i];
      const float length = glm::length(step);
      moved[i] = start[i] + (length > most ? most / length : 1.0f) * step;
    }
    mesh.added.swap(moved);
  };
  for (int round = 0; round < kFilmRounds; ++round) relax(Evidence::kFilm, 0.5f);
  for (int round = 0; round < kMembraneRounds; ++round) relax(Evidence::kInferred, 1.0f);
  return evidence;
}

}  // namespace dubsar
