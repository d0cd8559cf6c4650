// How deep a wedge is below the surface that the scribe wrote on.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <utility>

#include "core/mesh/quadratic_sheet.h"
#include "core/mesh/surface_measure.h"

namespace dubsar {
namespace {

constexpr std::size_t kLeastVertices = 30;
constexpr int kRounds = 40;
constexpr double kWindowMm = 0.35;      // within which a way down is looked for
constexpr double kLeastScaleMm = 0.01;  // below it the surface counts as smooth

struct Sample {
  double u, v, height, area;
  glm::dvec3 at_mm;
};

SheetTerms terms_of(const Sample& sample, double radius) { return sheet_terms(sample.u / radius, sample.v / radius); }

SheetTerms fit(const std::vector<Sample>& samples, const std::vector<double>& weights, double radius) {
  SheetEquations equations;
  for (std::size_t i = 0; i < samples.size(); ++i)
    equations.add(terms_of(samples[i], radius), samples[i].height, weights[i]);
  equations.regularize();
  return equations.solved().value_or(SheetTerms{});
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Neighbourhood {
  std::vector<Sample> samples;
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, out{0, 0, 1};
};

/// Vertices of the place's own sheet within the radius: of its partition, on faces that look its way.
Neighbourhood around(const TriMesh& mesh, const SurfacePlace& place, double radius) {
  struct Face {
    std::size_t triangle;
    glm::dvec3 normal;  // twice its area long
  };
  const PartitionId id = mesh.partition_of(place.triangle);
  const auto at = [&](std::uint32_t v) { return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])); };
  std::vector<Face> faces;
  glm::dvec3 sum(0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const glm::dvec3 a = at(triangle[0]), off = a - place.at_mm;
    if (!(glm::dot(off, off) < radius * radius) || mesh.partition_of(t) != id) continue;
    faces.push_back({t, glm::cross(at(triangle[1]) - a, at(triangle[2]) - a)});
    sum += faces.back().normal;
  }
  Neighbourhood found;
  if (faces.empty() || !(glm::length(sum) > 0)) return found;
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
            {glm::dot(off, found.right), glm::dot(off, found.up), glm::dot(off, found.out), 0.0, p});
      }
      found.samples[entry->second].area += glm::dot(face.normal, found.out) / 6.0;
    }
  }
  return found;
}

}  // namespace

Result<ImpressionDepth> impression_depth(const TriMesh& mesh, const SurfacePlace& place, double radius_mm) {
  if (!(radius_mm > 0) || !std::isfinite(radius_mm))
    return fail(ErrorKind::kUsage, "depth: a radius of {} mm found, expected more than 0", radius_mm);
  const Neighbourhood hood = around(mesh, place, radius_mm);
  const std::vector<Sample>& samples = hood.samples;
  if (samples.size() < kLeastVertices)
    return fail(ErrorKind::kUsage, "depth: {} vertices lie within {} mm, expected at least {}", samples.size(),
                radius_mm, kLeastVertices);
  std::vector<double> weights(samples.size()), below(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) weights[i] = samples[i].area;
  SheetTerms level = fit(samples, weights, radius_mm);
  double scale = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> above;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      below[i] = sheet_height(level, terms_of(samples[i], radius_mm)) - samples[i].height;
      if (below[i] < 0) above.push_back(-below[i]);
    }
    // What is above has no impressions in it: it says how rough the surface is.
    scale = std::max(kLeastScaleMm, above.empty() ? 0.0 : 1.4826 * median(std::move(above)));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double x = below[i] / scale;
      weights[i] = samples[i].area * (x <= 0 ? 1.0 : x >= 1 ? 0.0 : (1 - x * x) * (1 - x * x));
    }
    const SheetTerms next = fit(samples, weights, radius_mm);
    double moved = 0.0;
    for (std::size_t k = 0; k < kSheetTerms; ++k) moved = std::max(moved, std::abs(next[k] - level[k]));
    level = next;
    if (moved < 1e-6) break;
  }
  double all = 0.0, on_level = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double u = samples[i].u / radius_mm, v = samples[i].v / radius_mm;
    const double slope =
        std::hypot(level[1] + 2 * level[3] * u + level[4] * v, level[2] + level[4] * u + 2 * level[5] * v);
    below[i] = (sheet_height(level, sheet_terms(u, v)) - samples[i].height) / std::hypot(1.0, slope / radius_mm);
    all += samples[i].area;
    if (std::abs(below[i]) < scale) on_level += samples[i].area;
  }
  std::size_t bottom = 0;
  const auto far2 = [&](const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(a - b, a - b); };
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (far2(samples[i].at_mm, place.at_mm) < far2(samples[bottom].at_mm, place.at_mm)) bottom = i;
  for (bool down = true; std::exchange(down, false);) {
    const glm::dvec3 from = samples[bottom].at_mm;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (below[i] > below[bottom] && far2(samples[i].at_mm, from) < kWindowMm * kWindowMm) {
        bottom = i;
        down = true;
      }
  }
  const Sample& deepest = samples[bottom];
  const double u = deepest.u / radius_mm, v = deepest.v / radius_mm;
  const glm::dvec3 outward =
      glm::normalize(hood.out - hood.right * ((level[1] + 2 * level[3] * u + level[4] * v) / radius_mm) -
                     hood.up * ((level[2] + level[4] * u + 2 * level[5] * v) / radius_mm));
  ImpressionDepth out;
  out.depth_mm = std::max(0.0, below[bottom]);
  out.bottom_mm = deepest.at_mm;
  out.outward = outward;
  out.rim_mm = deepest.at_mm + out.depth_mm * outward;
  out.level_share = all > 0 ? on_level / all : 0.0;
  return out;
}

}  // namespace dubsar
