#include "tests/bench/settled_tablet.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

/// The connected surface that each vertex lies on, by its first vertex, and how many vertices each has.
struct Surfaces {
  std::vector<std::uint32_t> of;
  std::vector<std::size_t> size;
};

Surfaces surfaces_of(const TriMesh& mesh) {
  DisjointSets sets(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  Surfaces surfaces{std::vector<std::uint32_t>(mesh.positions.size()), std::vector<std::size_t>(mesh.positions.size())};
  for (std::uint32_t v = 0; v < surfaces.of.size(); ++v) ++surfaces.size[surfaces.of[v] = sets.root(v)];
  return surfaces;
}

std::vector<glm::dvec3> outward(const TriMesh& mesh, std::span<const glm::vec3> positions) {
  std::vector<glm::dvec3> normals(positions.size());
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a(positions[t[0]]),
        n = glm::cross(glm::dvec3(positions[t[1]]) - a, glm::dvec3(positions[t[2]]) - a);
    for (const std::uint32_t v : t) normals[v] += n;
  }
  for (glm::dvec3& n : normals)
    if (const double length = glm::length(n); length > 0.0) n /= length;
  return normals;
}

/// Normal equations of the shift, summed in a fixed order.
struct Sums {
  glm::dmat3 normal{0.0};
  glm::dvec3 right{0.0};
  double squares = 0.0, count = 0.0;
};

}  // namespace

SettledTablet settle_tablet(const phantom::Phantom& truth, const TriMesh& tablet,
                            std::span<const glm::vec3> positions) {
  constexpr double kSlit = 1.5, kNearTruth = 1.5, kFar = 3.0;
  const Surfaces surfaces = surfaces_of(tablet);
  const std::vector<glm::dvec3> normals = outward(tablet, positions);
  SettledTablet settled;
  const auto measured = [&](std::uint32_t v) {
    return tablet.evidence.empty() || tablet.evidence[v] == evidence_byte(Evidence::kMeasured);
  };
  std::vector<std::uint32_t> judged;
  std::vector<double> apart(positions.size());  // by surface: mean distance to any true one; 0 where it is contact
  std::vector<bool> contact(positions.size());
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const std::uint32_t surface = surfaces.of[v];
    const glm::dvec3 p(positions[v]);
    if (!measured(v))
      contact[surface] = true;
    else if (surfaces.size[surface] * 20 < positions.size())
      apart[surface] += std::abs(truth.signed_distance(p)) / static_cast<double>(surfaces.size[surface]);
    else if (truth.gap_width(p) >= kSlit)
      judged.push_back(v);
  }
  for (std::uint32_t v = 0; v < positions.size(); ++v)
    if (!contact[surfaces.of[v]] && apart[surfaces.of[v]] > kNearTruth)
      settled.noise_pores += 1.0 / static_cast<double>(positions.size());
  for (int round = 0; round < 4; ++round) {
    const Sums sums = parallel_reduce<Sums>(
        static_cast<std::int64_t>(judged.size()), 4096, {},
        [&](std::int64_t begin, std::int64_t end) {
          Sums part;
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const double off = truth.tablet_distance(glm::dvec3(positions[judged[i]]) + settled.shift);
            part.squares += off * off;
            part.count += 1.0;
            if (std::abs(off) > kFar) continue;  // what is that far off says nothing of the shift
            const glm::dvec3& n = normals[judged[i]];
            part.normal += glm::outerProduct(n, n);
            part.right += n * off;
          }
          return part;
        },
        [](Sums a, const Sums& b) {
          a.normal += b.normal;
          a.right += b.right;
          a.squares += b.squares;
          a.count += b.count;
          return a;
        });
    settled.rms = std::sqrt(sums.squares / std::max(1.0, sums.count));
    if (round < 3 && glm::determinant(sums.normal) > 1e-6) settled.shift -= glm::inverse(sums.normal) * sums.right;
  }
  return settled;
}

}  // namespace dubsar
