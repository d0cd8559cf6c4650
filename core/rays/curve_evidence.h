#pragma once
// How even clay and air are in a sum of images, and which sum makes them most even.

#include <span>
#include <vector>

#include "core/rays/curve_search.h"
#include "core/rays/sure_materials.h"

namespace dubsar {

using TermVector = std::array<double, RayCurve::kTerms>;
using TermMatrix = std::array<TermVector, RayCurve::kTerms>;

/// Sums over pixels of one kind, each seen in two planes close to each other. Products are those of one plane with the
/// other: their noise has nothing in common, what scatter and hardening do has.
struct Moments {
  TermMatrix products{};
  TermVector sums{};
  double count = 0.0;

  void add(const TermVector& v, const TermVector& w) {
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
      sums[i] += 0.5 * (v[i] + w[i]);
      for (std::size_t j = i; j < RayCurve::kTerms; ++j) products[i][j] += 0.5 * (v[i] * w[j] + v[j] * w[i]);
    }
    count += 1.0;
  }
  void add(const Moments& other) {
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
      sums[i] += other.sums[i];
      for (std::size_t j = i; j < RayCurve::kTerms; ++j) products[i][j] += other.products[i][j];
    }
    count += other.count;
  }
  double product(std::size_t i, std::size_t j) const { return products[std::min(i, j)][std::max(i, j)] / count; }
  double mean(const TermVector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) sum += c[i] * sums[i];
    return sum / count;
  }
  /// Without noise on average, and so by chance less than 0.
  double variance(const TermVector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i)
      for (std::size_t j = 0; j < RayCurve::kTerms; ++j) sum += c[i] * c[j] * product(i, j);
    const double m = mean(c);
    return sum - m * m;
  }
  double deviation(const TermVector& c) const { return std::sqrt(std::max(0.0, variance(c))); }
};

struct EvenEvidence {
  Moments clay, air;
  void add(const EvenEvidence& other) {
    clay.add(other.clay);
    air.add(other.air);
  }
};

/// Of each pair of planes, lanes 2 k and 2 k + 1: pixels that are sure in both.
std::vector<EvenEvidence> gather(const std::vector<LaneImage>& images, const SureMaterials& sure,
                                 const PlaneStrides& at, std::span<const std::int64_t> planes);

EvenEvidence sum_of(std::span<const EvenEvidence> pairs);

/// Of the sum of images with weights c.
Evenness evenness(const EvenEvidence& evidence, const TermVector& c);

/// c >= 0 that brings the images nearest to 1 in clay and 0 in air.
TermVector fit(const EvenEvidence& evidence);

/// Of `pairs` in the order of their planes.
Elsewhere look_elsewhere(std::span<const EvenEvidence> pairs);

}  // namespace dubsar
