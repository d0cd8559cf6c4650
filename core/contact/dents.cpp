#include "core/contact/dents.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "core/contact/ring_average.h"

namespace dubsar {
namespace {

constexpr int kNormalRounds = 20;  ///< of averages, so that the normals in a wedge are those around it
constexpr int kSpanRounds = 60;    ///< a sheet spans what is some 12 steps wide
constexpr float kDent = 1.2f;      ///< steps below it
constexpr std::size_t kNearest = 64;
constexpr double kLeastDentLikelihood = 3.1;  ///< log_likelihood_of_film() of a dent that is there
constexpr float kMostDentStrength = 2.5f;     ///< of one vertex: the fringe of a pore is no film, however dark

}  // namespace

// The sheet only rises: wherever its neighbours are higher on average, a vertex goes up to them.
std::vector<float> dent_depths(const InterfaceMesh& mesh, const InterfaceRings& rings,
                               const std::vector<glm::vec3>& dual_positions) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const std::vector<glm::vec3> up = unit_normals(mesh, rings, dual_positions, kNormalRounds);
  // By ids as in triangles; of four numbers, which are loaded and added at once.
  std::vector<glm::vec4> sheet(dual + mesh.added.size());
  for (std::size_t v = 0; v < sheet.size(); ++v)
    sheet[v] = glm::vec4(v < dual ? dual_positions[v] : mesh.added[v - dual], 0.0f);
  std::vector<glm::vec4> next = sheet;
  for (int round = 0; round < kSpanRounds; ++round) {
    each_vertex(up.size(), [&](std::size_t i) {
      const glm::vec4 own = sheet[dual + i];
      next[dual + i] = own;
      if (rings.all[i].empty()) return;
      glm::vec4 mean(0.0f);
      const float weights = rings.all.each(i, [&](std::uint32_t w, float weight) { mean += weight * sheet[w]; });
      mean /= weights;
      next[dual + i] += glm::vec4(std::max(glm::dot(glm::vec3(mean - own), up[i]), 0.0f) * up[i], 0.0f);
    });
    sheet.swap(next);
  }
  std::vector<float> depth(up.size());
  each_vertex(depth.size(),
              [&](std::size_t i) { depth[i] = glm::dot(glm::vec3(sheet[dual + i]) - mesh.added[i], up[i]); });
  return depth;
}

std::vector<bool> doubtful_dents(const InterfaceMesh& mesh, const InterfaceRings& rings,
                                 const std::vector<glm::vec3>& dual_positions, const std::vector<bool>& film,
                                 const PlainClay& plain, ContactRules rules) {
  const std::vector<float> depth = dent_depths(mesh, rings, dual_positions);
  const auto in_dent = [&](std::size_t i) { return film[i] && depth[i] > kDent; };
  std::vector<std::uint8_t> by_chance(depth.size(), 0);
  each_vertex(depth.size(), [&](std::size_t i) {
    if (!in_dent(i) || !rules.has(ContactRule::kDents)) return;
    std::vector<std::uint32_t> nearest;
    std::array<std::uint32_t, 256> listed{};  // 1 + who of those with such an id was listed last: seldom two
    const auto list = [&](std::uint32_t w) {
      const std::uint32_t last = std::exchange(listed[w % listed.size()], w + 1);
      if (last == w + 1) return;
      if (last == 0 || std::find(nearest.begin(), nearest.end(), w) == nearest.end()) nearest.push_back(w);
    };
    list(static_cast<std::uint32_t>(i));
    double sum = 0.0;
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      sum += static_cast<double>(std::min(mesh.strength[nearest[k]], kMostDentStrength));
      for (const std::uint32_t w : rings.added[nearest[k]])
        if (nearest.size() < kNearest && in_dent(w)) list(w);
    }
    by_chance[i] = log_likelihood_of_film(sum, nearest.size(), plain) < kLeastDentLikelihood;
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
