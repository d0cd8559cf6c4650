#include "core/contact/interface_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/contact/dents.h"
#include "core/contact/film_refine.h"
#include "core/contact/interface_rings.h"
#include "core/contact/ring_average.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

/// Averages over neighbours: some five rings. A cut seeks what is dark, so that clay without a film has a mean of 1.1
/// deviations along it, and 1.75 in one place of a hundred; a film of a fifth of a voxel has 1.8.
constexpr int kEvidenceRounds = 25;
/// Rings beside the surface where the dip may be that of its air. They count where there is nothing else.
constexpr int kRim = 3;
constexpr float kRimWeight = 0.02f, kRimMargin = 0.4f;  ///< at most, above plain clay
/// log_likelihood_of_film() from which on a region is believed that was chosen because it is dark: of 1,287 that chance
/// made (docs/evidence.md) all but one have at most 72. In a patch as a whole nothing was chosen, and the likeliest
/// has 9.
constexpr double kLeastOfRegion = 80.0, kLeastOfPatch = 16.0;
constexpr float kWithinMargin = 0.1f;  ///< of a film in such a patch, above plain clay
constexpr float kLeastStep = 0.5f;     ///< of the difference of the clays
constexpr int kFilmRounds = 1;
constexpr int kMembraneRounds = 200;

constexpr std::uint8_t kFilm = evidence_byte(Evidence::kFilm), kInferred = evidence_byte(Evidence::kInferred);

/// Is a vertex within kRim rings of the surface?
std::vector<bool> rim_of(const InterfaceRings& rings) {
  std::vector<bool> rim(rings.all.size());
  for (std::size_t i = 0; i < rim.size(); ++i) rim[i] = rings.at_air(i);
  for (int ring = 1; ring < kRim; ++ring) {
    const std::vector<bool> inner = rim;
    for (std::size_t i = 0; i < rim.size(); ++i)
      for (const std::uint32_t w : rings.added[i])
        if (inner[w]) rim[i] = true;
  }
  return rim;
}

std::vector<float> mean_strength(const InterfaceMesh& mesh, const InterfaceRings& rings, const PlainClay& plain,
                                 const std::vector<bool>& rim) {
  std::vector<std::array<float, 2>> weighed(mesh.strength.size());  // sum, weight
  for (std::size_t i = 0; i < weighed.size(); ++i) {
    const float weight = rim[i] ? kRimWeight : 1.0f;
    weighed[i] = {weight * (rim[i] ? std::min(mesh.strength[i], plain.strength + kRimMargin) : mesh.strength[i]),
                  weight};
  }
  average_rings(rings, kEvidenceRounds, weighed);
  std::vector<float> mean(weighed.size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = weighed[i][0] / std::max(weighed[i][1], 1e-6f);
  return mean;
}

/// How much of the difference of the two clays there is across the contact, averaged along it.
std::vector<float> mean_steps(const InterfaceMesh& mesh, const InterfaceRings& rings,
                              const std::vector<glm::vec3>& dual_positions, const BandDensity& density,
                              const ClayContrast& clays) {
  const std::vector<glm::vec3> normals = area_normals(mesh, rings, dual_positions);
  const float low = std::min(clays.tablet, clays.envelope) - 2.0f * clays.deviation,
              high = std::max(clays.tablet, clays.envelope) + 2.0f * clays.deviation;
  std::vector<float> steps(mesh.added.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const float length = glm::length(normals[i]);
    if (!(length > 0.0f)) continue;
    const auto beside = [&](float away) {
      const glm::ivec3 p(glm::round(mesh.added[i] + away / length * normals[i]));
      return std::clamp(density.get(p.x, p.y, p.z), low, high);
    };
    steps[i] = 0.5f * (beside(2.5f) + beside(4.0f) - beside(-2.5f) - beside(-4.0f)) / clays.step();
  }
  average_rings(rings, kEvidenceRounds, steps);
  return steps;
}

/// The vertices of those pieces of `belongs` that have `least` and more of log_likelihood_of_film(). The rim has no
/// say.
std::vector<bool> likely_films(const InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<bool>& rim,
                               const PlainClay& plain, const std::vector<bool>& belongs, double least) {
  std::vector<bool> film(belongs.size(), false);
  each_piece(rings, belongs, [&](const std::vector<std::uint32_t>& piece) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::uint32_t v : piece)
      if (!rim[v]) {
        sum += static_cast<double>(mesh.strength[v]);
        ++count;
      }
    if (log_likelihood_of_film(sum, count, plain) < least) return;
    for (const std::uint32_t v : piece) film[v] = true;
  });
  return film;
}

/// Films by one round, what is inferred until it is a membrane between them and the surface.
void relax(InterfaceMesh& mesh, const InterfaceRings& rings, const std::vector<glm::vec3>& dual_positions,
           const std::vector<std::uint8_t>& evidence, float most) {
  const std::vector<glm::vec3> start = mesh.added;
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const auto relax_those = [&](std::uint8_t which, int rounds, float share) {
    std::vector<std::uint32_t> those;
    for (std::uint32_t i = 0; i < evidence.size(); ++i)
      if (evidence[i] == which && !rings.all[i].empty()) those.push_back(i);
    std::vector<glm::vec3> next(those.size());
    for (int round = 0; round < rounds; ++round) {
      each_vertex(those.size(), [&](std::size_t k) {
        const std::uint32_t i = those[k];
        glm::vec3 mean(0.0f);
        const float weights = rings.all.each(i, [&](std::uint32_t w, float weight) {
          mean += weight * (w < dual ? dual_positions[w] : mesh.added[w - dual]);
        });
        mean /= weights;
        const glm::vec3 step = mesh.added[i] + share * (mean - mesh.added[i]) - start[i];
        const float length = glm::length(step);
        next[k] = start[i] + (length > most ? most / length : 1.0f) * step;
      });
      each_vertex(those.size(), [&](std::size_t k) { mesh.added[those[k]] = next[k]; });
    }
  };
  relax_those(kFilm, kFilmRounds, 0.5f);
  relax_those(kInferred, kMembraneRounds, 1.0f);
}

}  // namespace

std::vector<std::uint8_t> shape_interface(InterfaceMesh& mesh, const std::vector<glm::vec3>& dual_positions,
                                          const BandDensity& density, const ShapeOptions& options) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const InterfaceRings rings(mesh, dual);
  const std::vector<bool> rim =
      options.rules.has(ContactRule::kRim) ? rim_of(rings) : std::vector<bool>(rings.all.size());
  const std::vector<float> strength = mean_strength(mesh, rings, options.plain, rim);
  std::vector<std::uint8_t> evidence(strength.size());
  const auto likely = [&](const std::vector<bool>& belongs, double least) {
    return likely_films(mesh, rings, rim, options.plain, belongs, least);
  };
  const auto above = [&](std::size_t i, float margin) { return strength[i] >= options.plain.strength + margin; };
  std::vector<bool> film(strength.size()), patch(strength.size(), true);
  for (std::size_t i = 0; i < film.size(); ++i) film[i] = above(i, 0.5f * kFaintFilm);
  if (options.rules.has(ContactRule::kLikelihood)) {
    film = likely(film, kLeastOfRegion);
    patch = likely(patch, kLeastOfPatch);
    for (std::size_t i = 0; i < film.size(); ++i) film[i] = film[i] || (patch[i] && above(i, kWithinMargin));
  }
  for (std::size_t i = 0; i < film.size(); ++i) evidence[i] = film[i] ? kFilm : kInferred;
  std::vector<bool> clay_step(evidence.size(), false);  // not a film: where one clay ends and the other begins
  if (options.clays) {
    const std::vector<float> steps = mean_steps(mesh, rings, dual_positions, density, *options.clays);
    for (std::size_t i = 0; i < clay_step.size(); ++i) {
      const bool dip = strength[i] * options.dip_deviation > kLeastStep * std::abs(options.clays->step());
      if (dip || steps[i] < kLeastStep) continue;
      clay_step[i] = true;
      evidence[i] = kFilm;
    }
  }

  relax(mesh, rings, dual_positions, evidence, options.most);
  std::vector<bool> moves(evidence.size());
  for (std::size_t i = 0; i < moves.size(); ++i)  // air hides the step of the clays beside it
    moves[i] = evidence[i] == kFilm && !(clay_step[i] && rings.at_air(i));
  follow_dips(mesh, rings, dual_positions, {moves, clay_step}, density,
              {.blur_variance = options.blur_variance, .clays = options.clays, .rules = options.rules});
  for (std::size_t i = 0; i < film.size(); ++i) film[i] = evidence[i] == kFilm && !clay_step[i];
  const std::vector<bool> doubtful = doubtful_dents(mesh, rings, dual_positions, film, options.plain, options.rules);
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (doubtful[i]) evidence[i] = kInferred;
  return evidence;
}

}  // namespace dubsar
