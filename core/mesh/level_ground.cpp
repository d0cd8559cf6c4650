#include "core/mesh/level_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "core/base/numbers/median.h"

namespace dubsar {
namespace {

constexpr int kRounds = 40;
constexpr double kSettledMm = 1e-6;
constexpr double kLeastRoughnessMm = 0.01;  // below it the surface counts as smooth
constexpr double kDegree = std::numbers::pi / 180.0;
// Chosen of several on the exact surfaces of phantoms: the envelope alone is 2.5 to 6 % of a wedge too high there,
// these leave 0.5 to 2.5 %.
constexpr double kLeastAngle = 5 * kDegree, kMostAngle = 15 * kDegree, kDeviations = 3.0;
// What lies above the ground is the clay that was pushed up sooner than ground that was pressed in: lips of a twentieth
// of the depth, which count as level, made wedges of 7 to 10 voxels 2 % too deep.
constexpr double kAbove = 0.7;
constexpr double kLeastShare = 0.02;  // with less on it there is no ground

double biweight(double x) { return std::abs(x) >= 1 ? 0.0 : (1 - x * x) * (1 - x * x); }

}  // namespace

Neighbourhood neighbourhood(const TriMesh& mesh, const SurfacePlace& place, double radius_mm) {
  struct Face {
    std::size_t triangle;
    glm::dvec3 normal;  // twice its area long
  };
  const PartitionId id = mesh.partition_of(place.triangle);
  const auto at = [&](std::uint32_t v) { return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])); };
  std::vector<Face> faces;
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const glm::dvec3 a = at(triangle[0]), off = a - place.at_mm;
    if (!(glm::dot(off, off) < radius_mm * radius_mm) || mesh.partition_of(t) != id) continue;
    faces.push_back({t, glm::cross(at(triangle[1]) - a, at(triangle[2]) - a)});
    sum += faces.back().normal;
    area += glm::length(faces.back().normal);
  }
  Neighbourhood found;
  if (faces.empty() || !(glm::length(sum) > 0)) return found;
  found.spacing_mm = std::sqrt(area / static_cast<double>(faces.size()));  // two triangles for each vertex
  found.out = glm::normalize(sum);
  const glm::dvec3 aside = std::abs(found.out.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  found.right = glm::normalize(glm::cross(aside, found.out));
  found.up = glm::cross(found.out, found.right);
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (const Face& face : faces) {
    if (glm::dot(face.normal, found.out) < 0) continue;
    for (const std::uint32_t v : mesh.triangles[face.triangle]) {
      const auto [entry, fresh] = index.try_emplace(v, found.samples.size());
      if (fresh) {
        const glm::dvec3 p = at(v), off = p - place.at_mm;
        found.samples.push_back(
            {glm::dot(off, found.right), glm::dot(off, found.up), glm::dot(off, found.out), 0.0, glm::dvec3(0.0), p});
      }
      GroundSample& sample = found.samples[entry->second];
      sample.area += glm::dot(face.normal, found.out) / 6.0;
      sample.normal += face.normal;
    }
  }
  for (GroundSample& sample : found.samples) {
    const glm::dvec3 n(glm::dot(sample.normal, found.right), glm::dot(sample.normal, found.up),
                       glm::dot(sample.normal, found.out));
    const double size = glm::length(n);
    sample.normal = size > 0 ? n / size : glm::dvec3(0, 0, 1);
  }
  return found;
}

LevelGround::LevelGround(const Neighbourhood& around, double radius_mm) : radius_mm_(radius_mm) {
  envelope(around);
  // Noise turns normals: those of what is about level say how much.
  std::vector<double> angles;
  double all = 0.0, on_it = 0.0;
  for (const GroundSample& sample : around.samples)
    if (std::abs(depth(sample)) < 2 * roughness_mm_) angles.push_back(turned(sample));
  const double most = std::clamp(1.5 * median(std::move(angles)), kLeastAngle, kMostAngle);
  for (const auto& [looser, wider] : {std::array{3.0, 2.0}, {1.7, 1.5}, {1.0, 1.0}})
    level(around, looser * most, wider * kDeviations);
  for (const GroundSample& sample : around.samples) {
    all += sample.area;
    if (std::abs(depth(sample)) < 2 * roughness_mm_ && turned(sample) < most) on_it += sample.area;
  }
  share_ = all > 0 ? on_it / all : 0.0;
}

double LevelGround::height(double u, double v) const {
  return sheet_height(terms_, sheet_terms(u / radius_mm_, v / radius_mm_));
}

glm::dvec2 LevelGround::slope(double u, double v) const {
  const double x = u / radius_mm_, y = v / radius_mm_;
  return glm::dvec2(terms_[1] + 2 * terms_[3] * x + terms_[4] * y, terms_[2] + terms_[4] * x + 2 * terms_[5] * y) /
         radius_mm_;
}

double LevelGround::depth(const GroundSample& sample) const {
  const glm::dvec2 s = slope(sample.u, sample.v);
  return (height(sample.u, sample.v) - sample.height) / std::sqrt(1.0 + glm::dot(s, s));
}

/// Between the sample's normal and the ground's, radians.
double LevelGround::turned(const GroundSample& sample) const {
  const glm::dvec2 s = slope(sample.u, sample.v);
  return std::acos(std::clamp(glm::dot(glm::normalize(glm::dvec3(-s, 1.0)), sample.normal), -1.0, 1.0));
}

/// False, and nothing has changed, where the weights leave no ground.
bool LevelGround::solve(const Neighbourhood& around, const std::vector<double>& weights) {
  SheetEquations equations;
  double all = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const GroundSample& sample = around.samples[i];
    equations.add(sheet_terms(sample.u / radius_mm_, sample.v / radius_mm_), sample.height, weights[i]);
    all += sample.area;
    sum += weights[i];
  }
  equations.regularize();
  const auto next = equations.solved();
  if (!next || sum < kLeastShare * all) return false;
  double moved = 0.0;
  for (std::size_t k = 0; k < kSheetTerms; ++k) moved = std::max(moved, std::abs((*next)[k] - terms_[k]));
  terms_ = *next;
  settled_ = moved < kSettledMm;
  return true;
}

/// What lies below loses its weight, what lies above keeps it: that has no impressions in it, and says how rough the
/// surface is.
void LevelGround::envelope(const Neighbourhood& around) {
  std::vector<double> weights;
  for (const GroundSample& sample : around.samples) weights.push_back(sample.area);
  solve(around, weights);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> below, above;
    for (const GroundSample& sample : around.samples) {
      below.push_back(depth(sample));
      if (below.back() < 0) above.push_back(-below.back());
    }
    roughness_mm_ = std::max(kLeastRoughnessMm, 1.4826 * median(std::move(above)));
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = around.samples[i].area * (below[i] <= 0 ? 1.0 : biweight(below[i] / roughness_mm_));
    if (!solve(around, weights) || settled_) return;
  }
}

void LevelGround::level(const Neighbourhood& around, double most_angle, double most_deviations) {
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> weights;
    double squares = 0.0, sum = 0.0;
    for (const GroundSample& sample : around.samples) {
      const double below = depth(sample);
      const double widest = (below < 0 ? kAbove : 1.0) * most_deviations * roughness_mm_;
      const double weight = sample.area * biweight(below / widest) * biweight(turned(sample) / most_angle);
      weights.push_back(weight);
      squares += weight * below * below;
      sum += weight;
    }
    if (!solve(around, weights)) return;
    roughness_mm_ = std::max(kLeastRoughnessMm, std::sqrt(squares / sum));
    if (settled_) return;
  }
}

}  // namespace dubsar
